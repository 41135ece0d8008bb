//! Estimated errors of a natural frequency, one for each approximation of a model. `docs/auto.md` derives them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use gearset::{
    CellLayout, Geometry, LoadCase, Scene, estimated_inertias, estimated_mesh_stiffness,
};

use super::choice::ErrorPart;
use super::energy::{KINDS, ModeEnergy};
use crate::error::ExperimentError;

/// Factor on estimates of inertia that is left out: they are first-order bounds (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// What a change of a frequency by its static displacements may be off: of OH-58 with three and four planets it is within
/// 2.3 % of the change by a hundred modes of each body, for every mode below the first of a body
/// (`experiments/tests/elastic_inertia.rs`); twice that.
const CHANGE_DOUBT: f64 = 0.05;

/// Grid convergence index of the mean mesh stiffness at this many flank elements of eight nodes, and observed order: from
/// 620.6, 618.3 and 617.3 N/µm at 7, 14 and 28 elements (`docs/fe_contact.md`) by `dynamics::grid_convergence_index`.
const STIFFNESS_INDEX: (f64, f64, f64) = (0.0036, 14.0, 1.2);

/// Half-widths of contact that the grid of a pair reaches to either side.
const GRID_HALF_WIDTHS: f64 = 1.5;

/// Part of the rim's mass per pitch that moves with a loaded tooth: over three pitches a tenth of the tooth's deflection
/// (a neighbouring tooth moves by 4 to 7 %), which falls to nothing at the race.
const RIM_SHARE: f64 = 0.15;

/// ∂ln k/∂ln a of a mesh: the half-planes of both flanks yield by 2 · 2 (1 − ν²)/(π E b) · ln a under unit force, the whole
/// mesh by about 13/(E b).
const HALF_WIDTH_INFLUENCE: f64 = 0.18;

/// Independent parameters that are anywhere within ±a: standard uncertainty a/√3 each, root of the sum of squares, and
/// twice that (JCGM 100:2008, 4.3.7, 5.1.2 and 6.2).
pub(super) const EXPANDED: f64 = 1.154_700_538_379_251_6;

/// Sizes of a set that estimates need.
#[derive(Debug, Clone)]
pub(super) struct SetSize {
    planets: f64,
    /// Least of mass and I/r², kg: carrier, ring, sun, one planet; infinite where it is not known.
    inertia: [f64; KINDS],
    /// Meshes of one body: carrier (none), ring, sun, planet.
    meshes: [f64; KINDS],
    /// Mass that moves with the loaded teeth of one mesh, ε m_t, kg: carrier (none), ring, sun, planet.
    teeth: [f64; KINDS],
    /// Least estimate of a mesh stiffness, N/m.
    mesh: f64,
    /// E b, N/m.
    modulus_width: f64,
    bearing: f64,
    /// Mass of the carrier that moves with a pin seat, kg; 0 if it is rigid.
    seat: f64,
    /// First mode of each body with its race held, Hz: carrier, ring, sun, planet; infinite where it is rigid.
    first_modes_hz: [f64; KINDS],
    /// How contact cells are laid out.
    cells: CellLayout,
    /// Mean force of a mesh over the sun's base radius, N/m.
    turning: f64,
    /// Mean force of a mesh, N.
    mesh_force: f64,
    /// Base pitch of the planet, m.
    base_pitch: f64,
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
        // A tooth is half a pitch wide at the middle of its height, the rim below it reaches to the race.
        let tooth = |gear: &gearset::Gear| {
            let height = (gear.tip_radius - gear.root_radius).abs();
            let middle = 0.5 * (gear.tip_radius + gear.root_radius);
            let rim = (gear.root_radius - gear.body_radius.unwrap_or(gear.root_radius)).abs();
            let area = 0.5 * middle * height + RIM_SHARE * gear.root_radius * rim;
            per_area * gear.pitch_angle() * area
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
            modulus_width: scene.material.young_modulus_pa * geometry.face_width,
            bearing: scene.supports.planet_bearing,
            // A disc of twice the seat's diameter.
            seat: carrier.map_or(0.0, |c| per_area * PI * (2.0 * c.pin_seat_radius).powi(2)),
            first_modes_hz: {
                let [held, free] = [sun, &geometry.planet].map(|gear| {
                    torsional_hz(scene, gear.body_radius.unwrap_or(0.0), gear.tip_radius)
                });
                [
                    carrier.map_or(f64::INFINITY, |c| {
                        torsional_hz(scene, c.bore_radius, c.outer_radius)
                    }),
                    torsional_hz(scene, ring.body_radius.unwrap_or(0.0), ring.tip_radius),
                    held,
                    free,
                ]
            },
            cells: scene.fe_contact.cell_layout,
            turning: case.sun_load_nm() / sun.base_radius.powi(2) / planets,
            base_pitch: sun_mesh.base_pitch,
            mesh_force: case.sun_load_nm() / sun.base_radius / planets,
        })
    }

    /// Inertia of the elastic displacement left out, of first order. A mass ε m_t, teeth and a part of the
    /// rim below them, moves against its body by half of what a mesh yields; the strain energy of the meshes bounds that (Cauchy–Schwarz), as that of the planet
    /// bearings bounds what a pin seat yields:
    ///
    /// ```text
    /// δf/f ≤ ½ ω Σ_b ε m_t D_b √(n_b τ_b e/(M_b k)) + m_c ω D_c √(N τ_c e_p k_p/M_c)/(E b),
    /// D_b = 1/(1 − (f/f_b)²)
    /// ```
    ///
    /// f_b is the first mode of the body with its race held; above one of them it is infinite, because such modes are then
    /// missing below the one asked for.
    pub(super) fn body_inertia(&self, mode: &ModeEnergy) -> f64 {
        let omega = TAU * mode.frequency_hz;
        if mode.frequency_hz >= self.first_mode_hz() {
            return f64::INFINITY;
        }
        let grown = |b: usize| 1.0 / (1.0 - (mode.frequency_hz / self.first_modes_hz[b]).powi(2));
        let teeth: f64 = (1..KINDS)
            .map(|b| {
                let stretch = self.meshes[b] * mode.kinetic[b] * mode.meshes.max(0.0);
                let share = (stretch / (self.inertia[b] * self.mesh)).sqrt();
                0.5 * omega * self.teeth[b] * grown(b) * share
            })
            .sum();
        let seats = self.planets * mode.kinetic[0] * mode.bearings * self.bearing;
        let share = (seats / self.inertia[0]).sqrt();
        let carrier = self.seat * omega * grown(0) * share / self.modulus_width;
        SAFETY * (teeth + carrier)
    }

    /// What teeth move a response by that are bent and released as they pass through mesh, in harmonic l of circular frequency ω, at most (root mean
    /// square, m, where no mode amplifies it). One tooth a cycle is deflected by half of the deflection d of its mesh where it is loaded, and on the mean by a
    /// third of that, as a beam whose deflection grows with the square of the distance; harmonic l has no more than d/(πl) of it, and ω²
    /// times that and the mass presses on the mesh of stiffness k:
    ///
    /// ```text
    /// x_l ≤ ω²/3 Σ_b ε m_t d/(√2 π l k)
    /// ```
    ///
    /// with the teeth of both meshes of a planet. Infinite above the first mode of a body with its race held.
    pub(super) fn of_passing_teeth(&self, l: u32, omega: f64) -> f64 {
        let [_, ring, sun, planet] = self.teeth;
        let quotient = (omega / (TAU * self.first_mode_hz())).powi(2);
        if quotient >= 1.0 {
            return f64::INFINITY;
        }
        let mass = (ring + sun + 2.0 * planet) / 3.0;
        let force = omega * omega * mass * self.deflection() / (1.0 - quotient);
        force / (2f64.sqrt() * PI * f64::from(l) * self.mesh)
    }

    /// The same of a mode of FE/contact from its static displacements: `change` is the relative change of the frequency that
    /// they give to first order.
    pub(super) fn of_change(change: f64) -> f64 {
        change.abs() + Self::left_by_first_order(change)
    }

    /// What is left of a frequency that this change was added to: what first order leaves is taken to be its square.
    pub(super) fn left_by_first_order(change: f64) -> f64 {
        CHANGE_DOUBT * change.abs() + change * change
    }

    /// What modes of the bodies leave if they change the frequency by `seen` and all of the inertia by `change` (relative).
    pub(super) fn left_by_modes(change: f64, seen: f64) -> f64 {
        (change - seen).abs() + Self::left_by_first_order(change)
    }

    /// Lowest of the first modes of the bodies with their races held, by estimate, Hz.
    pub(super) fn first_mode_hz(&self) -> f64 {
        self.first_modes_hz.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Errors of FE/contact: finite elements, δf/f = ½ e GCI (14/n)^p; contact cells, δf/f = ½ e (∂ln k/∂ln a) Δ/(2a),
    /// because the cells that touch hold the half-width a to half the width Δ of a cell; on graded cells, which both edges
    /// of a patch pass in turn, to a quarter.
    pub(super) fn discretisation(
        &self,
        mode: &ModeEnergy,
        flank_elements: u32,
        contact_cells: u32,
    ) -> [ErrorPart; 2] {
        let [elements, cells] = stiffness_errors(self.cells, flank_elements, contact_cells);
        let half = 0.5 * mode.meshes;
        [
            ErrorPart::new("finite elements behind the flanks", half * elements),
            ErrorPart::new("contact cells", half * cells),
        ]
    }

    /// Mean slope of the flanks of a loaded mesh: its deflection over a base pitch.
    pub(super) fn slope(&self) -> f64 {
        self.deflection() / self.base_pitch
    }

    /// Mean deflection of a mesh by estimate, m.
    pub(super) fn deflection(&self) -> f64 {
        self.mesh_force / self.mesh
    }

    /// What forces of meshes that turn with their lines of action do to a frequency, at most:
    /// δf/f = (F/r) Σ_b n_b τ_b/M_b /(2 ω²).
    pub(super) fn of_turning(&self, mode: &ModeEnergy) -> f64 {
        let omega = TAU * mode.frequency_hz;
        let moved: f64 =
            (1..KINDS).map(|b| self.meshes[b] * mode.kinetic[b] / self.inertia[b]).sum();
        0.5 * self.turning * moved / (omega * omega)
    }
}

/// What finite elements along a flank, of eight nodes, and contact cells are estimated to change the stiffness of any mesh by, δk/k
/// each (`docs/auto.md`).
pub fn stiffness_errors(layout: CellLayout, flank_elements: u32, contact_cells: u32) -> [f64; 2] {
    let cell = 2.0 * GRID_HALF_WIDTHS / f64::from(contact_cells);
    // Both edges of a patch pass from one graded cell to the next in turn.
    let steps = match layout {
        CellLayout::Even => 1.0,
        CellLayout::Graded => 0.5,
    };
    [of_elements(flank_elements), HALF_WIDTH_INFLUENCE * 0.5 * cell * steps]
}

/// The part of elements.
fn of_elements(flank_elements: u32) -> f64 {
    let (index, at, order) = STIFFNESS_INDEX;
    index * (at / f64::from(flank_elements)).powf(order)
}

/// First torsional mode of an annulus that is held at one edge and free at the other, Hz, by Rayleigh's quotient with a
/// quarter of a sine wave between them:
///
/// ```text
/// ω² = (G/ρ) ∫ r³ φ'² dr / ∫ r³ φ² dr,   φ = sin(π/2 (r − r_held)/(r_free − r_held))
/// ```
///
/// It is an upper bound of this mode.
fn torsional_hz(scene: &Scene, held: f64, free: f64) -> f64 {
    const INTERVALS: usize = 64;
    let material = &scene.material;
    let shear = 0.5 * material.young_modulus_pa / (1.0 + material.poisson_ratio);
    let (span, mut bent, mut moved) = (free - held, 0.0, 0.0);
    for i in 0..=INTERVALS {
        let share = i as f64 / INTERVALS as f64;
        // Simpson's weights; the common factor drops out.
        let weight = match i {
            0 | INTERVALS => 1.0,
            _ => 2.0 + 2.0 * (i % 2) as f64,
        };
        let cubed = (held + share * span).powi(3) * weight;
        let (sin, cos) = (FRAC_PI_2 * share).sin_cos();
        bent += cubed * (FRAC_PI_2 / span * cos).powi(2);
        moved += cubed * sin * sin;
    }
    (shear / material.density_kg_per_m3 * bent / moved).sqrt() / TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearset::{SceneKind, template};

    /// A thin annulus is a bar in shear: f = √(G/ρ)/(4 h). That of the carrier of OH-58 was computed with finite
    /// elements as 12.26 kHz with every mode kept (`docs/fe_dynamics.md`: 12.1 kHz).
    #[test]
    fn the_torsional_mode_of_an_annulus_has_its_limit_and_that_of_finite_elements() {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let shear = 0.5 * scene.material.young_modulus_pa / (1.0 + scene.material.poisson_ratio);
        let speed = (shear / scene.material.density_kg_per_m3).sqrt();
        let thin = torsional_hz(&scene, 1.0, 1.0 + 1e-4) / (speed / 4e-4) - 1.0;
        assert!(thin.abs() < 1e-3, "{thin:e}");
        scene.material.young_modulus_pa = 207e9;
        scene.material.density_kg_per_m3 = 7595.0;
        let carrier = torsional_hz(&scene, 0.0684, 0.1168) / 12.1e3 - 1.0;
        assert!(carrier.abs() < 0.05, "{carrier:e}");
        // Held outside, more of the mass is near the held edge: the frequency is higher.
        assert!(torsional_hz(&scene, 0.1168, 0.0684) > torsional_hz(&scene, 0.0684, 0.1168));
    }
}
