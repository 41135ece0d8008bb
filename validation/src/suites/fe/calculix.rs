//! One mesh at equal approach against CalculiX, from results kept with their provenance.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::at_approach;
use gearset::MeshKind;

use crate::reference::CalculixCase;
use crate::suites::{Checks, Lab};

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let kept = &lab.reference.calculix;
    let mut checks = judged(lab, &kept.case)?;
    // The control compares every recorded row at the mesh and phase of the next.
    let mut shifted = kept.case.clone();
    let places: Vec<_> = kept.case.iter().map(|c| (c.scene.clone(), c.phase)).collect();
    let next = places.iter().cycle().skip(1);
    for (case, (scene, phase)) in shifted.iter_mut().zip(next) {
        (case.scene, case.phase) = (scene.clone(), *phase);
    }
    let spoilt = judged(lab, &shifted)?;
    checks.push(lab.reference.control("fe.calculix.control.rows_shifted", &spoilt)?);
    Ok(checks)
}

fn judged(lab: &Lab<'_>, cases: &[CalculixCase]) -> Checks {
    let source =
        format!("{}; remade by benches/calculix_pair.py --write", lab.reference.calculix.source);
    let mut checks = Vec::new();
    for case in cases {
        let kind = match case.scene.contains("ring_planet") {
            true => MeshKind::RingPlanet,
            false => MeshKind::SunPlanet,
        };
        let approach = case.approach_um * 1e-6;
        let own = at_approach(&lab.bodies, kind, case.phase, approach, &ActiveSet)?;
        let name = &case.id;
        let id = format!("fe.calculix.{name}.force");
        let (mesh, phase, um) = (kind.name(), case.phase, case.approach_um);
        let title = format!("{mesh} mesh, phase {phase}, {um} µm approach: force ({})", case.what);
        checks.push(lab.about(&id, &title)?.source(&source).number(case.force_n, own.force));
        for pair in &case.pair {
            // Rows of corner contacts record no peak pressure.
            let Some(expected) = pair.peak_pressure_mpa else { continue };
            let found = own.pairs.iter().find(|p| p.index == pair.index);
            let actual = found.and_then(|p| p.peak_pressure).map_or(f64::NAN, |p| 1e-6 * p);
            let index = pair.index;
            let id = format!("fe.calculix.{name}.pressure.{index}");
            let title = format!(
                "{mesh} mesh, phase {phase}, {um} µm approach: peak pressure of pair {index}"
            );
            checks.push(lab.about(&id, &title)?.source(&source).number(expected, actual));
        }
    }
    Ok(checks)
}
