//! What is known of a scene without finite elements: geometry, excitation rules, the lumped model.

use std::f64::consts::PI;

use gearset::{Axis, Body, Facing, Geometry, MeshKind, MeshMember, Phasing, ThicknessInput};
use lumped::{LumpedModel, ModeType, NaturalModes};
use scene::{LoadCase, Scene, SceneKind, excitation_of_scene};

use super::row::Row;
use crate::error::ValidationError;

/// Frequencies of one type that differ by less than this part are one.
const EQUAL: f64 = 1e-9;

/// Harmonics of which rules are in the data set.
const HARMONICS: u32 = 10;

/// Rows of a scene as this program computes them, of class C until another route agrees.
///
/// # Errors
/// If the lumped model of a scene with numbers in `[lumped]` cannot be solved.
pub fn closed_forms(id: &str, scene: &Scene) -> Result<Vec<Row>, ValidationError> {
    let mut rows =
        Rows { scene: id, source: scene.source.as_deref().unwrap_or_default(), rows: Vec::new() };
    rows.geometry(scene);
    rows.rules(scene);
    if scene.lumped.is_some() {
        rows.lumped(scene)?;
    }
    Ok(rows.rows)
}

struct Rows<'s> {
    scene: &'s str,
    source: &'s str,
    rows: Vec<Row>,
}

impl Rows<'_> {
    fn add(&mut self, kind: &str, quantity: &str, subject: &str, value: f64) {
        let row = Row::new(self.scene, kind, quantity, subject, value);
        self.rows.push(Row { source: self.source.to_owned(), ..row });
    }

    fn geometry(&mut self, scene: &Scene) {
        let case = LoadCase::of_scene(scene).ok().filter(|case| case.sun_torque_nm != 0.0);
        if let Some(case) = &case {
            let per_rpm = case.mesh_frequency_per_rpm_hz();
            self.add("geometry", "mesh_frequency_per_rpm", case.driven.name(), per_rpm);
            self.add("geometry", "direction", "", case.direction().sign());
        }
        let planets = scene.planets.psi_rad.iter().enumerate();
        for (n, psi) in planets.filter(|_| scene.kind == SceneKind::Planetary) {
            self.add("geometry", "planet_position", &format!("planet_{n}"), *psi);
        }
        let Ok(geometry) = scene.tooth_geometry() else { return };
        self.add("geometry", "base_pitch", "", geometry.base_pitch);
        let gears = [
            ("sun", geometry.sun.as_ref()),
            ("planet", Some(&geometry.planet)),
            ("ring", geometry.ring.as_ref()),
        ];
        for (name, gear) in gears {
            if let Some(gear) = gear.filter(|_| has_gear(scene, name)) {
                self.add("geometry", "base_radius", name, gear.base_radius);
            }
        }
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            self.mesh(scene, &geometry, kind, case.as_ref());
        }
        if scene.kind == SceneKind::Planetary
            && let Some(phasing) = Phasing::new(&geometry, &scene.planets)
        {
            self.add("geometry", "gamma", "", phasing.gamma());
            let loaded = case.as_ref().map_or(Facing::CounterClockwise, LoadCase::sense);
            let phases = phasing.phases(0.0, loaded);
            let start = phases.sun_planet[0];
            let meshes = [("sun_mesh", phases.sun_planet), ("ring_mesh", phases.ring_planet)];
            for (mesh, phases) in meshes {
                for (n, phase) in phases.into_iter().enumerate() {
                    let phase = within_a_cycle(phase - start);
                    self.add("geometry", "mesh_phase", &format!("{mesh}_{n}"), phase);
                }
            }
        }
    }

    fn mesh(
        &mut self,
        scene: &Scene,
        geometry: &Geometry,
        kind: MeshKind,
        case: Option<&LoadCase>,
    ) {
        let is_there = scene.pair.is_none_or(|pair| pair == kind);
        let Some(mesh) = geometry.mesh(kind).filter(|_| is_there) else { return };
        let name = if kind == MeshKind::SunPlanet { "sun_mesh" } else { "ring_mesh" };
        let has_shifts = scene
            .geometry
            .as_ref()
            .is_some_and(|given| matches!(given.thickness, ThicknessInput::ProfileShift { .. }));
        self.add("geometry", "operating_pressure_angle", name, mesh.pressure_angle);
        self.add("geometry", "contact_ratio", name, mesh.contact_ratio);
        if has_shifts && let Some(backlash) = geometry.backlash(kind) {
            self.add("geometry", "backlash", name, backlash);
        }
        let Some((case, sun)) = case.zip(geometry.sun.as_ref()) else { return };
        // Hertz: p² = F E/(2 (1 − ν²) π b R) with radii of curvature r_b tan α at the pitch point, 1/R = 1/R₁ ± 1/R₂
        let radius = |member| mesh.gear(member).base_radius * mesh.pressure_angle.tan();
        let (driver, driven) = (radius(MeshMember::Driver), radius(MeshMember::Driven));
        let curvature = match kind {
            MeshKind::SunPlanet => 1.0 / driver + 1.0 / driven,
            // The flank of the ring is hollow.
            MeshKind::RingPlanet => (1.0 / driver - 1.0 / driven).abs(),
        };
        let planets = scene.planets.count().max(1) as f64;
        let force = case.sun_load_nm() / (planets * sun.base_radius) / geometry.face_width;
        let material = &scene.material;
        let modulus = material.young_modulus_pa / (2.0 * (1.0 - material.poisson_ratio.powi(2)));
        let pressure = (force * modulus * curvature / PI).sqrt();
        self.add("geometry", "hertz_pressure", name, pressure);
    }

    fn rules(&mut self, scene: &Scene) {
        for strengths in excitation_of_scene(scene, HARMONICS).unwrap_or_default() {
            let kinds = strengths.allowed();
            for (name, is_excited) in [
                ("rotational", kinds.rotational),
                ("translational", kinds.translational),
                ("planet", kinds.planet),
            ] {
                self.add("geometry", "excites", name, f64::from(u8::from(is_excited)));
                self.last().harmonic = Some(strengths.harmonic);
            }
        }
    }

    fn last(&mut self) -> &mut Row {
        let last = self.rows.len() - 1;
        &mut self.rows[last]
    }

    fn lumped(&mut self, scene: &Scene) -> Result<(), ValidationError> {
        let model = LumpedModel::from_scene(scene)?;
        self.modes("lumped", &model, false)?;
        self.modes("torsional", &model.torsional(), true)?;
        let names: Vec<String> =
            model.coordinates.free().iter().map(|(body, axis)| coordinate(*body, *axis)).collect();
        let (mass, stiffness) = (model.mass_matrix(), model.stiffness());
        for (quantity, matrix) in [("mass", mass), ("stiffness", stiffness)] {
            for (row, first) in names.iter().enumerate() {
                for (column, second) in names.iter().enumerate().skip(row) {
                    self.add(
                        "lumped",
                        quantity,
                        &format!("{first} {second}"),
                        matrix[(row, column)],
                    );
                }
            }
        }
        Ok(())
    }

    /// Modes by type, each frequency once.
    fn modes(
        &mut self,
        kind: &str,
        model: &LumpedModel,
        is_torsional: bool,
    ) -> Result<(), ValidationError> {
        let mut modes: Vec<(&str, f64, usize)> = Vec::new();
        for group in NaturalModes::of(model)?.groups {
            // Of rotations alone, modes move all planets alike or against each other.
            let mode_type = match group.mode_type {
                ModeType::Rotational => "rotational",
                _ if is_torsional => "planet",
                other => other.name(),
            };
            let is_same = |(name, hz, _): &&mut (&str, f64, usize)| {
                *name == mode_type && (*hz - group.frequency_hz).abs() <= EQUAL * group.frequency_hz
            };
            match modes.iter_mut().find(is_same) {
                Some((.., times)) => *times += group.multiplicity,
                None => modes.push((mode_type, group.frequency_hz, group.multiplicity)),
            }
        }
        for (k, (mode_type, hz, times)) in modes.iter().enumerate() {
            let before = modes[..k].iter().filter(|(name, ..)| name == mode_type).count();
            for (quantity, value) in [("frequency", *hz), ("multiplicity", *times as f64)] {
                self.add(kind, quantity, mode_type, value);
                self.last().number = Some(before as u32 + 1);
            }
        }
        Ok(())
    }
}

/// `carrier_x`, `planet_0_zeta`, `sun_u`.
fn coordinate(body: Body, axis: Axis) -> String {
    let axis = match (body, axis) {
        (_, Axis::Rotation) => "u",
        (Body::Planet(_), Axis::First) => "zeta",
        (Body::Planet(_), Axis::Second) => "eta",
        (_, Axis::First) => "x",
        (_, Axis::Second) => "y",
    };
    format!("{}_{axis}", body.name())
}

/// Whether a scene has that gear: a pair may be given with the geometry of a whole set.
fn has_gear(scene: &Scene, name: &str) -> bool {
    match scene.pair {
        None => true,
        Some(MeshKind::SunPlanet) => name != "ring",
        Some(MeshKind::RingPlanet) => name != "sun",
    }
}

/// A phase in [0, 1) where what rounding leaves below a whole number is 0.
fn within_a_cycle(phase: f64) -> f64 {
    let phase = phase.rem_euclid(1.0);
    if 1.0 - phase < 1e-12 { 0.0 } else { phase }
}
