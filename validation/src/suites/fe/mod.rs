//! FE/contact: every check needs the bodies, which are made once.

mod bodies;
mod calculix;
mod controls;
mod convergence;
mod fed;
mod fidelity;
mod fig12;
mod hertz;
mod iso6336;
mod kinematics;
mod modal;
mod reduced;
mod resolved;
mod sets;
mod stepping;
mod stiffness;
mod sweeps;
mod torque;
mod truth;

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, PairCycle, SetCycle, StaticSet, pair_cycle};
use gearset::{LoadCase, MeshKind, Scene};

use crate::Profile;
use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

/// What the suites share.
pub(crate) struct Lab<'r> {
    pub(crate) reference: &'r Reference,
    pub(crate) profile: Profile,
    /// Four planets; the gears are those of three planets too.
    pub(crate) four: Scene,
    pub(crate) three: Scene,
    pub(crate) bodies: Bodies,
    /// Normal force of one mesh of three planets under 1130 N·m, N.
    pub(crate) force: f64,
}

pub(crate) const MESHES: [MeshKind; 2] = [MeshKind::SunPlanet, MeshKind::RingPlanet];

impl Lab<'_> {
    /// One mesh alone over its cycle.
    pub(crate) fn pair(
        &self,
        bodies: &Bodies,
        kind: MeshKind,
        positions: usize,
    ) -> Result<PairCycle, ValidationError> {
        Ok(pair_cycle(bodies, kind, self.force, positions, &ActiveSet)?)
    }

    /// A set over its cycle; clockwise for negative torques.
    pub(crate) fn set(
        &self,
        scene: &Scene,
        bodies: &Bodies,
        torque_nm: f64,
        positions: usize,
        imperfections: Imperfections,
    ) -> Result<SetCycle, ValidationError> {
        let load = LoadCase::standing(torque_nm);
        let set = StaticSet::new(scene, bodies, load.sense(), imperfections)?;
        Ok(set.cycle(load.sun_load_nm(), positions, &ActiveSet)?)
    }

    /// A number that must not exceed the tolerance of its id.
    pub(crate) fn at_most(
        &self,
        id: &str,
        title: &str,
        unit: &str,
        actual: f64,
    ) -> Result<Check, ValidationError> {
        self.number(id, title, ReferenceKind::Analytic, "by construction", unit, 0.0, actual)
    }

    /// A number against a number, judged by the tolerance of its id.
    #[allow(clippy::too_many_arguments)] // the fields of a subject, at one call site each
    pub(crate) fn number(
        &self,
        id: &str,
        title: &str,
        kind: ReferenceKind,
        source: &str,
        unit: &str,
        expected: f64,
        actual: f64,
    ) -> Result<Check, ValidationError> {
        let tolerance = self.reference.tolerance(id, expected)?;
        Ok(Check::number(Subject { id, title, kind, source, unit }, expected, actual, tolerance))
    }
}

type Suite = fn(&Lab<'_>) -> Result<Vec<Check>, ValidationError>;

/// Runs the FE/contact suites concerned.
pub(crate) fn checks(
    reference: &Reference,
    profile: Profile,
    concerns: &dyn Fn(&str) -> bool,
) -> Result<Vec<Check>, ValidationError> {
    let suites: [(&[&str], Suite); 25] = [
        (&["fe.hertz."], hertz::checks),
        (&["fe.convergence."], convergence::checks),
        (&["fe.resolved."], resolved::checks),
        (&["fe.calculix."], calculix::checks),
        (&["fe.bodies."], bodies::checks),
        (&["fe.stiffness."], stiffness::checks),
        (&["fe.iso_6336."], iso6336::checks),
        (&["fe.sets."], sets::checks),
        (&["fe.kinematics.turned."], kinematics::turned::checks),
        (&["fe.kinematics.work."], kinematics::work::checks),
        (&["fe.kinematics.bearings."], kinematics::bearings::checks),
        (&["fe.kinematics.potential."], kinematics::potential::checks),
        (&["fe.kinematics.exact."], kinematics::exact::checks),
        (&["fe.kinematics.peaks."], kinematics::peaks::checks),
        (&["fe.fig12."], fig12::checks),
        (&["fe.control."], controls::checks),
        (&["table2.fe_contact.", "table3.fe_contact.", "fe.modal."], modal::checks),
        (&["fe.stepping."], stepping::checks),
        (&["fe.fidelity."], fidelity::checks),
        (&["fe.fed."], fed::checks),
        (sweeps::IDS, sweeps::checks),
        (sweeps::IDS, reduced::checks),
        (&["sweep.control."], sweeps::controls),
        (&["truth."], truth::checks),
        (&["torque."], torque::checks),
    ];
    if !suites.iter().any(|(prefixes, _)| prefixes.iter().any(|p| concerns(p))) {
        return Ok(Vec::new());
    }
    let four = scene(PublishedScene::Oh58FourPlanets)?;
    let bodies = Bodies::new(&four)?;
    let sun = bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
    let force = 1130.0 / 3.0 / sun.base_radius;
    let three = scene(PublishedScene::Oh58ThreePlanets)?;
    let lab = Lab { reference, profile, four, three, bodies, force };
    let mut checks = Vec::new();
    for (prefixes, suite) in suites {
        if prefixes.iter().any(|p| concerns(p)) {
            checks.extend(suite(&lab)?);
        }
    }
    Ok(checks)
}
