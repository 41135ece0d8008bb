//! Estimated errors of a natural frequency, one for each approximation of a model. `docs/auto.md` derives them.

use std::f64::consts::TAU;

use gearset::{Geometry, LoadCase, PerBody, Scene, estimated_inertias, estimated_mesh_stiffness};
use lumped::{LumpedModel, ModeGroup, Parameter, sensitivities};

use super::choice::ErrorPart;
use super::energy::{KINDS, ModeEnergy};
use crate::error::ExperimentError;

/// Factor on estimates of inertia that is left out: they are first-order bounds (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// Grid convergence index of the mean mesh stiffness at 14 flank elements of eight nodes, with its safety factor of 3
/// and the formal order 2 (`docs/fe_contact.md`).
const STIFFNESS_INDEX: (f64, f64) = (0.008, 14.0);

/// Half-widths of contact that the grid of a pair reaches to either side.
const GRID_HALF_WIDTHS: f64 = 1.5;

/// What the estimate of a mesh stiffness, E b/13 (0.75 ε + 0.25), may be off: ln 1.35, where ISO 6336-1 and computed
/// stiffnesses differ by up to a third (`docs/fe_contact.md`).
const STIFFNESS_DOUBT: f64 = 0.3;

/// What the mass or inertia of an annulus with half of each tooth height filled may be off: teeth are about a third of
/// such a body, and their filling is good to a tenth.
const INERTIA_DOUBT: f64 = 0.03;

/// Largest effect of corner contacts that press along their own normals (`docs/fe_dynamics_effects.md`).
const CORNERS: f64 = 0.006;

/// Sizes of a set that estimates need.
#[derive(Debug, Clone)]
pub(super) struct SetSize {
    planets: f64,
    /// Least of mass and I/r², kg: carrier, ring, sun, one planet; infinite where it is not known.
    inertia: [f64; KINDS],
    /// Meshes of one body: carrier (none), ring, sun, planet.
    meshes: [f64; KINDS],
    /// Mass of the loaded teeth of one mesh, ε m_t, kg: carrier (none), ring, sun, planet.
    teeth: [f64; KINDS],
    /// Least estimate of a mesh stiffness, N/m.
    mesh: f64,
    /// Estimates of the mesh stiffnesses, N/m: sun–planet, ring–planet.
    by_mesh: [f64; 2],
    /// E b, N/m.
    modulus_width: f64,
    bearing: f64,
    /// Mass of the carrier that moves with a pin seat, kg; 0 if it is rigid.
    seat: f64,
    /// Mean force of a mesh over the sun's base radius, N/m.
    turning: f64,
    /// Estimates of masses (kg) and polar inertias (kg m²).
    masses: PerBody,
    inertias: PerBody,
}

impl SetSize {
    pub(super) fn new(scene: &Scene, case: &LoadCase) -> Result<Self, ExperimentError> {
        let missing = |_| ExperimentError::Incomplete("tooth geometry");
        let geometry = Geometry::from_scene(scene).map_err(missing)?;
        let of = |name| move || ExperimentError::Incomplete(name);
        let (sun, ring) = (
            geometry.sun.as_ref().ok_or_else(of("sun"))?,
            geometry.ring.as_ref().ok_or_else(of("ring"))?,
        );
        let sun_mesh = geometry.sun_planet.as_ref().ok_or_else(of("sun–planet mesh"))?;
        let ring_mesh = geometry.ring_planet.as_ref().ok_or_else(of("ring–planet mesh"))?;
        let planets = scene.planets.count() as f64;
        let (masses, inertias) = estimated_inertias(scene);
        let least = |mass: Option<f64>, inertia: Option<f64>, radius: f64| {
            let list = [mass, inertia.map(|i| i / (radius * radius))];
            list.into_iter().flatten().fold(f64::INFINITY, f64::min)
        };
        let per_area = scene.material.density_kg_per_m3 * geometry.face_width;
        // Half a pitch wide at the middle of its height.
        let tooth = |gear: &gearset::Gear| {
            let height = (gear.tip_radius - gear.root_radius).abs();
            let middle = 0.5 * (gear.tip_radius + gear.root_radius);
            per_area * 0.5 * middle * gear.pitch_angle() * height
        };
        let largest = sun_mesh.contact_ratio.max(ring_mesh.contact_ratio);
        let stiffness = |mesh| estimated_mesh_stiffness(scene, mesh).ok_or_else(of("face width"));
        let by_mesh = [stiffness(sun_mesh)?, stiffness(ring_mesh)?];
        let carrier = scene.geometry.as_ref().and_then(|g| g.carrier).filter(|c| !c.is_rigid);
        Ok(Self {
            planets,
            inertia: [
                least(masses.carrier, inertias.carrier, geometry.center_distance),
                least(masses.ring, inertias.ring, ring.base_radius),
                least(masses.sun, inertias.sun, sun.base_radius),
                least(masses.planet, inertias.planet, geometry.planet.base_radius),
            ],
            meshes: [0.0, planets, planets, 2.0],
            teeth: [
                0.0,
                ring_mesh.contact_ratio * tooth(ring),
                sun_mesh.contact_ratio * tooth(sun),
                largest * tooth(&geometry.planet),
            ],
            mesh: by_mesh[0].min(by_mesh[1]),
            by_mesh,
            modulus_width: scene.material.young_modulus_pa * geometry.face_width,
            bearing: scene.supports.planet_bearing,
            // A disc of twice the seat's diameter.
            seat: carrier.map_or(0.0, |c| {
                per_area * std::f64::consts::PI * (2.0 * c.pin_seat_radius).powi(2)
            }),
            turning: case.sun_load_nm() / sun.base_radius.powi(2) / planets,
            masses,
            inertias,
        })
    }

    /// Inertia of the elastic displacement left out, of first order. Teeth of mass ε m_t move against their body by
    /// half of what a mesh yields; the strain energy of the meshes bounds that (Cauchy–Schwarz), as that of the planet
    /// bearings bounds what a pin seat yields:
    ///
    /// ```text
    /// δf/f ≤ ½ ω Σ_b ε m_t √(n_b τ_b e/(M_b k)) + m_c ω √(N τ_c e_p k_p/M_c)/(E b)
    /// ```
    pub(super) fn body_inertia(&self, mode: &ModeEnergy) -> f64 {
        let omega = TAU * mode.frequency_hz;
        let teeth: f64 = (1..KINDS)
            .map(|b| {
                let stretch = self.meshes[b] * mode.kinetic[b] * mode.meshes.max(0.0);
                0.5 * omega * self.teeth[b] * (stretch / (self.inertia[b] * self.mesh)).sqrt()
            })
            .sum();
        let seats = self.planets * mode.kinetic[0] * mode.bearings * self.bearing;
        let carrier = self.seat * omega * (seats / self.inertia[0]).sqrt() / self.modulus_width;
        SAFETY * (teeth + carrier)
    }

    /// Errors of FE/contact: finite elements, δf/f = ½ e GCI (14/n)², and contact cells, δf/f = ½ e (Δ/a)² with Δ/a the
    /// width of a cell over the half-width of contact.
    pub(super) fn discretisation(
        &self,
        mode: &ModeEnergy,
        flank_elements: u32,
        contact_cells: u32,
    ) -> [ErrorPart; 2] {
        let (index, at) = STIFFNESS_INDEX;
        let elements = index * (at / f64::from(flank_elements)).powi(2);
        let cell = 2.0 * GRID_HALF_WIDTHS / f64::from(contact_cells);
        let half = 0.5 * mode.meshes;
        [
            ErrorPart::new("finite elements behind the flanks", half * elements),
            ErrorPart::new("contact cells", half * cell * cell),
        ]
    }

    /// Errors of the lumped model of a scene beside FE/contact with every degree of freedom.
    pub(super) fn of_lumped(
        &self,
        model: &LumpedModel,
        scene: &Scene,
        group: &ModeGroup,
        mode: &ModeEnergy,
    ) -> Vec<ErrorPart> {
        let Some(given) = &scene.lumped else { return Vec::new() };
        let off = |own: Option<f64>, estimate: Option<f64>, doubt: f64| match (own, estimate) {
            (Some(own), Some(estimate)) => (own / estimate).ln().abs() + doubt,
            _ => doubt,
        };
        let over_r2 = |inertia: Option<f64>, radius: Option<f64>| Some(inertia? / radius?.powi(2));
        let (m, i, i_est) = (&given.mass, &given.inertia_over_r2, &self.inertias);
        let m_est = &self.masses;
        let (mut meshes, mut inertia) = (0.0, 0.0);
        for sensitivity in sensitivities(model, group) {
            let size = sensitivity.logarithmic.abs();
            match &sensitivity.parameter {
                Parameter::StiffnessFamily(name) if name.ends_with("_mesh") => {
                    let [sun, ring] = self.by_mesh;
                    let (own, estimate) = match name.as_str() {
                        "sun_mesh" => (given.mesh.sun_planet, sun),
                        _ => (given.mesh.ring_planet, ring),
                    };
                    meshes += size * off(Some(own), Some(estimate), STIFFNESS_DOUBT);
                }
                Parameter::InertiaFamily(name) => {
                    let r = &given.radius;
                    let (own, estimate) = match name.as_str() {
                        "carrier_mass" => (m.carrier, m_est.carrier),
                        "ring_mass" => (m.ring, m_est.ring),
                        "sun_mass" => (m.sun, m_est.sun),
                        "planet_mass" => (m.planet, m_est.planet),
                        "carrier_inertia" => (i.carrier, over_r2(i_est.carrier, r.carrier)),
                        "ring_inertia" => (i.ring, over_r2(i_est.ring, r.ring)),
                        "sun_inertia" => (i.sun, over_r2(i_est.sun, r.sun)),
                        _ => (i.planet, over_r2(i_est.planet, r.planet)),
                    };
                    inertia += size * off(own, estimate, INERTIA_DOUBT);
                }
                _ => (),
            }
        }
        // δf/f = ½ e_p k_p/(E b): a pin seat yields by about F/(E b).
        let seats = match self.seat > 0.0 {
            true => 0.5 * mode.bearings * self.bearing / self.modulus_width,
            false => 0.0,
        };
        // δf/f = (F/r) Σ_b n_b τ_b/M_b /(2 ω²): a force that turns with its line of action.
        let omega = TAU * mode.frequency_hz;
        let moved: f64 =
            (1..KINDS).map(|b| self.meshes[b] * mode.kinetic[b] / self.inertia[b]).sum();
        vec![
            ErrorPart::new("mesh stiffnesses as given", meshes),
            ErrorPart::new("masses and inertias as given", inertia),
            ErrorPart::new("carrier between pin seats and race", seats),
            ErrorPart::new(
                "mesh forces that turn with their lines of action",
                0.5 * self.turning * moved / (omega * omega),
            ),
            ErrorPart::new("corner contacts beside the line of action", CORNERS),
        ]
    }
}
