//! Negative controls: what must break when the set is spoilt.

use fe_contact::statics::{Imperfections, PitchError, SetCycle};
use gearset::MeshKind;

use super::Lab;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;

const POSITIONS: usize = 28;

/// Largest difference of the sun meshes' forces between the planets, over the largest.
fn spread(cycle: &SetCycle) -> f64 {
    let mut worst = 0.0f64;
    for state in &cycle.states {
        let forces = state.meshes.iter().filter(|m| m.kind == MeshKind::SunPlanet).map(|m| m.force);
        let (least, most) = forces.fold((f64::INFINITY, 0.0f64), |(a, b), f| (a.min(f), b.max(f)));
        worst = worst.max((most - least) / most);
    }
    worst
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let torque = 1130.0;
    let run = |imperfections| lab.set(&lab.three, &lab.bodies, torque, POSITIONS, imperfections);
    let limit = lab.reference.tolerance("fe.sets.sharing.three", 0.0)?.absolute;
    let mut checks = Vec::new();
    let mut breaks = |id: &str, title: &str, is_broken: bool| {
        let subject = Subject {
            id,
            title,
            kind: ReferenceKind::Analytic,
            source: "a check that cannot fail is none",
            unit: "",
        };
        checks.push(Check::equal(subject, "breaks", if is_broken { "breaks" } else { "stands" }));
    };
    let displaced =
        Imperfections { displaced_planets: vec![(1, 0.0, 50e-6)], ..Imperfections::default() };
    let found = spread(&run(displaced)?);
    breaks(
        "fe.control.displaced_planet",
        "one planet displaced by 50 µm along its path breaks fe.sets.sharing.three",
        found > 1e3 * limit,
    );
    // The tooth that stands in planet 1's mesh in this cycle.
    let tooth = 9;
    let mut found = 0.0f64;
    for tooth in [tooth - 1, tooth, tooth + 1] {
        let pitch = Imperfections {
            pitch_errors: vec![PitchError { tooth, amount: 10e-6 }],
            ..Imperfections::default()
        };
        found = found.max(spread(&run(pitch)?));
    }
    breaks(
        "fe.control.pitch_error",
        "one sun tooth 10 µm out of pitch, in mesh with planet 1, breaks fe.sets.sharing.three",
        found > 1e3 * limit,
    );
    // Contact clipped at the ends of the theoretical path: no pair beyond them.
    let kind = MeshKind::SunPlanet;
    let full = lab.pair(&lab.bodies, kind, POSITIONS)?;
    let clipped = clipped_mean_stiffness(lab, kind)?;
    // Half a unit of the printed 350e6 N/m.
    let tolerance = lab.reference.tolerance("fe.stiffness.series", 350.0)?.absolute / 350.0;
    breaks(
        "fe.control.clipped_path",
        "contact clipped to the theoretical path changes the mean stiffness by more than fe.stiffness.series allows",
        (clipped / full.mean_secant_stiffness() - 1.0).abs() > tolerance,
    );
    // Table 1's base diameters taken raw: pitches of the ring and the planet that differ.
    let raw = std::f64::consts::PI * (258.1 / 99.0 - 91.26 / 35.0) * 1e-3;
    let ring = lab.pair(&lab.bodies, MeshKind::RingPlanet, POSITIONS)?;
    breaks(
        "fe.control.raw_base_circles",
        "raw Table 1 base circles: their base-pitch error exceeds 5 % of the ring mesh's deflection, fe.convergence.gci allows 1 %",
        raw.abs() > 0.05 * ring.mean_deflection(),
    );
    Ok(checks)
}

/// Mean secant stiffness of the sun mesh with corner pairs left out.
fn clipped_mean_stiffness(lab: &Lab<'_>, kind: MeshKind) -> Result<f64, ValidationError> {
    use fe_contact::complementarity::ActiveSet;
    use fe_contact::contact::{Location, MeshTable};
    use fe_contact::statics::press;
    let missing = || ValidationError::Incomplete("mesh");
    let mesh = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
    let pair = lab.bodies.pair(kind).ok_or_else(missing)?;
    let mut settings = lab.bodies.cells(lab.force);
    // No window beyond the path.
    settings.window = 0.0;
    let mut sum = 0.0;
    for i in 0..POSITIONS {
        let phase = i as f64 / POSITIONS as f64;
        let table = MeshTable::new(mesh, pair, phase, &settings)?;
        debug_assert!(table.pairs.iter().all(|p| p.location == Location::Path));
        let (deflection, _) = press(&table, mesh, lab.force, &ActiveSet)?;
        sum += lab.force / deflection;
    }
    Ok(sum / POSITIONS as f64)
}
