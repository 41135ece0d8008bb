//! One mesh at equal approach against CalculiX, from results kept with their provenance.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::at_approach;
use gearset::MeshKind;

use super::Lab;
use crate::check::{Check, ReferenceKind};
use crate::error::ValidationError;

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let calculix = &lab.reference.calculix;
    let source = format!("{}; remade by benches/calculix_pair.py --write", calculix.source);
    let other = ReferenceKind::OtherCode;
    let mut checks = Vec::new();
    for case in &calculix.case {
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
        checks.push(lab.number(&id, &title, other, &source, "N", case.force_n, own.force)?);
        for pair in &case.pair {
            let found = own.pairs.iter().find(|p| p.index == pair.index);
            let peaks = pair.peak_pressure_mpa.zip(found.and_then(|p| p.peak_pressure));
            if let Some((expected, actual)) = peaks {
                let index = pair.index;
                let id = format!("fe.calculix.{name}.pressure.{index}");
                let title = format!(
                    "{mesh} mesh, phase {phase}, {um} µm approach: peak pressure of pair {index}"
                );
                let actual = actual * 1e-6;
                checks.push(lab.number(&id, &title, other, &source, "MPa", expected, actual)?);
            }
        }
    }
    Ok(checks)
}
