//! How far a set may be wound up by its load before kinematics linear about the unloaded, and about the mean loaded
//! configuration are wrong.
//!
//! F is the force of a mesh, k_b the stiffness of a planet bearing, w the windup ([`Theory::windup`]).
//!
//! 1. A windup common to all meshes is a shift of time. What is linear about the unloaded configuration counts
//!    positions without it: amplitudes stay, harmonics come late ([`SHIFTED`]).
//! 2. It leaves the ends of the path where they were, and gaps of corners near them are off by up to ½ G'' (w p_b)².
//!    Harmonics are off by the order of that over δ.
//! 3. It presses along lines that do not turn, α_s − ψ and α_r + ψ, and has no stiffness Σ F ∂²δ of forces that turn
//!    with their lines: frequencies are off to first order in the load.
//!
//! About the mean loaded configuration all three are left for the motion within a mesh cycle only.

use std::f64::consts::{PI, TAU};

use dynamics::generalized_symmetric;
use fe_contact::statics::Bodies;
use gearset::{Axis, Body, Geometry, MeshKind, MeshMember};
use lumped::{LumpedModel, ModeGroup, NaturalModes, SpringId, strain_energy};
use nalgebra::DMatrix;
use rayon::prelude::*;
use scene::{Fidelity, LoadCase, MeshKinematics, Scene};

use super::map::{Drawn, Map, MapError, MapOf, Point, StabilityMap, logarithms};
use super::windup::{Left, WoundUp, of_slopes};

pub(super) const MAP: Map = Map {
    name: "linear-kinematics",
    about: "Errors of kinematics linear about the unloaded and the loaded configuration, over the windup",
    meaning: "bearings give way under the load by far more than teeth: beyond this windup, kinematics linear about the \
         unloaded set, or about the loaded one, are more than 1 % off in harmonics at rest and natural frequencies",
    of: MapOf::Planets(map),
};

/// An error that counts.
const WANTED: f64 = 0.01;

/// Torque, and stiffness of the planet bearings, over those of the scene; the last load of either list is that of
/// [`LARGEST`].
const TORQUES: [f64; 6] = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0];
const BEARINGS: [f64; 7] = [100.0, 30.0, 10.0, 3.0, 1.0, 0.5, 0.25];

/// The largest deflection that is tried, of the largest that the program accepts.
const LARGEST: f64 = 0.99;

/// How the windup is made larger.
#[derive(Debug, Clone, Copy)]
enum By {
    Torque,
    SofterBearings,
}

/// A set under one load, with theory.
struct Load {
    factor: f64,
    found: WoundUp,
    /// w.
    windup: Option<f64>,
    /// ½ G'' (w p_b)² with the w that was found, m.
    corner: f64,
    /// Largest error of a frequency of bearings and supports about the unloaded configuration.
    frequency: Option<f64>,
}

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let case = LoadCase::of_scene(scene).map_err(|_| MapError::NoOperation)?;
    let mut scene = scene.clone();
    scene.dynamics.fidelity = Fidelity::QuasiStatic;
    scene.dynamics.kinematics = MeshKinematics::AboutMean;
    let bodies = Bodies::new(&scene)?;
    let axis = "log₁₀ of the windup over the base pitch";
    let mut map = StabilityMap::of(&MAP, scene.title.clone(), axis);
    for by in [By::Torque, By::SofterBearings] {
        let one = |factor: f64| at(&scene, &bodies, &case, by, factor);
        let factors = factors(&scene, &case, by)?;
        let loads: Vec<Load> = factors.into_par_iter().map(one).collect::<Result<_, _>>()?;
        write(&mut map, by, &loads);
    }
    let quantity = "part of harmonics that the coarser tables for the slopes of flanks change";
    map.measure("the scene's own load", quantity, of_slopes(&scene, &bodies, &case)?);
    Ok(map)
}

/// The scene and its load with torque or planet bearings times a factor.
fn changed(scene: &Scene, case: &LoadCase, by: By, factor: f64) -> (Scene, LoadCase) {
    let mut scene = scene.clone();
    match by {
        By::Torque => (scene, case.with_sun_torque(factor * case.sun_torque_nm)),
        By::SofterBearings => {
            scene.supports.planet_bearing_n_per_m *= factor;
            (scene, *case)
        }
    }
}

/// Factors up to the largest deflection that the program accepts.
fn factors(scene: &Scene, case: &LoadCase, by: By) -> Result<Vec<f64>, MapError> {
    let deflection = |by: By, factor: f64| {
        let (scene, case) = changed(scene, case, by, factor);
        let size = scene.size_of_sun_torque(case.sun_torque_nm);
        size.ok_or(MapError::Incomplete("path of the torque through its meshes"))
    };
    let own = deflection(by, 1.0)?;
    let most = LARGEST * own.most_deflection();
    let (list, last) = match by {
        By::Torque => (TORQUES.as_slice(), most / own.deflection),
        By::SofterBearings => {
            // deflection = A + B/factor
            let b = deflection(by, 0.5)?.deflection - own.deflection;
            (BEARINGS.as_slice(), b / (most - (own.deflection - b)))
        }
    };
    let is_within = |factor: &f64| match by {
        By::Torque => *factor < last,
        By::SofterBearings => *factor > last,
    };
    Ok(list.iter().copied().filter(is_within).chain([last]).collect())
}

fn at(
    scene: &Scene,
    bodies: &Bodies,
    case: &LoadCase,
    by: By,
    factor: f64,
) -> Result<Load, MapError> {
    let (scene, case) = changed(scene, case, by, factor);
    let found = WoundUp::of(&scene, bodies, &case)?;
    let theory = Theory::new(&scene, &bodies.geometry, &case);
    let along = found.windup * bodies.geometry.base_pitch;
    let corner = 0.5 * largest_curvature(&bodies.geometry) * along * along;
    let windup = theory.as_ref().and_then(Theory::windup);
    let frequency = match &theory {
        Some(theory) => theory.frequency_error(&scene)?,
        None => None,
    };
    Ok(Load { factor, found, windup, corner, frequency })
}

/// G'' of the corner whose gap grows fastest, 1/m.
fn largest_curvature(geometry: &Geometry) -> f64 {
    let meshes = [geometry.sun_planet.as_ref(), geometry.ring_planet.as_ref()];
    let corners = [MeshMember::Driver, MeshMember::Driven];
    let each = meshes.into_iter().flatten();
    each.flat_map(|mesh| corners.map(|corner| mesh.corner_gap_curvature(corner)))
        .fold(0.0, f64::max)
}

/// The formulas of a set under a load.
struct Theory<'g> {
    geometry: &'g Geometry,
    /// F, N.
    force: f64,
    /// ψ, rad.
    turned: f64,
    /// δ_s and δ_r, m; `None` without lumped stiffnesses.
    approach: Option<[f64; 2]>,
}

impl<'g> Theory<'g> {
    /// `None` of a set without sun or ring, or with a carrier or a ring that turns under the load.
    fn new(scene: &Scene, geometry: &'g Geometry, case: &LoadCase) -> Option<Self> {
        let [sun, ring] = [geometry.sun_planet.as_ref()?, geometry.ring_planet.as_ref()?];
        if scene.supports.carrier.motion.rotates() || scene.supports.ring.motion.rotates() {
            return None;
        }
        let radius = geometry.sun.as_ref()?.base_radius;
        let force = case.sun_load_nm() / radius / scene.planets.count() as f64;
        let along = force * (sun.pressure_angle.cos() + ring.pressure_angle.cos());
        let turned = along / scene.supports.planet_bearing_n_per_m / geometry.center_distance;
        let stiffness = scene.lumped.as_ref().map(|l| l.mesh_n_per_m);
        let approach = stiffness.map(|k| [force / k.sun_planet, force / k.ring_planet]);
        Some(Self { geometry, force, turned, approach })
    }

    /// `[eq:windup]` w = Z_r ψ/2π + (δ_s/2 + δ_r)/p_b, ψ = η/a, η = F (cos α_s + cos α_r)/k_b, δ = F/k of either
    /// mesh: a planet gives way by η along the circle of the centres, its lines of centres turn by ψ, and the path is
    /// w base pitches p_b farther on than in the unloaded set.
    ///
    /// Source: derived here.
    /// Checked by: `tests/all/stability_command.rs::kinematics_about_the_unloaded_set_are_off_as_theory_says`.
    fn windup(&self) -> Option<f64> {
        let [sun, ring] = self.approach?;
        let teeth = f64::from(self.geometry.ring.as_ref()?.teeth);
        Some(teeth * self.turned / TAU + (0.5 * sun + ring) / self.geometry.base_pitch)
    }

    /// Largest relative error of the lumped frequencies of bearings and supports with lines of action that do not turn.
    fn frequency_error(&self, scene: &Scene) -> Result<Option<f64>, MapError> {
        if scene.lumped.is_none() {
            return Ok(None);
        }
        let unturned = LumpedModel::from_scene(scene)?;
        let mut turned = scene.clone();
        if let Some(lumped) = &mut turned.lumped {
            lumped.pressure_angle_rad.sun_planet -= self.turned;
            lumped.pressure_angle_rad.ring_planet += self.turned;
        }
        let turned = LumpedModel::from_scene(&turned)?;
        let stiffness = turned.stiffness() + self.force_stiffness(&turned);
        let exact = generalized_symmetric(&stiffness, &turned.mass)?;
        let modes = NaturalModes::of(&unturned)?;
        let of_meshes = |g: &ModeGroup| {
            let energy = strain_energy(&unturned, g);
            let is_mesh = |id: SpringId| matches!(id, SpringId::SunMesh(_) | SpringId::RingMesh(_));
            energy.iter().filter(|e| is_mesh(e.of)).map(|e| e.share).sum::<f64>() > 0.5
        };
        let each = modes.groups.iter().flat_map(|g| {
            let own = (g.lambda, of_meshes(g));
            std::iter::repeat_n(own, g.multiplicity)
        });
        let mut each: Vec<(f64, bool)> = each.collect();
        each.sort_by(|a, b| a.0.total_cmp(&b.0));
        let pairs = each.into_iter().zip(exact.lambda);
        let supports = pairs.filter(|((own, of_meshes), _)| !of_meshes && *own > 0.0);
        let off = supports.map(|((own, _), exact)| ((own / exact).sqrt() - 1.0).abs());
        Ok(Some(off.fold(0.0, f64::max)))
    }

    /// Σ F ∂²δ on the coordinates of a lumped model, n×n, N/m.
    fn force_stiffness(&self, model: &LumpedModel) -> DMatrix<f64> {
        let n = model.mass.len();
        let mut sum = DMatrix::zeros(n, n);
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            let Some(Ok(still)) = self.geometry.mesh(kind).map(|m| m.displaced(0.0, &[0.0; 6]))
            else {
                continue;
            };
            let hessian = still.hessians().approach;
            for (planet, psi) in model.psi.iter().enumerate() {
                let (sin, cos) = psi.sin_cos();
                let central = match kind {
                    MeshKind::SunPlanet => Body::Sun,
                    MeshKind::RingPlanet => Body::Ring,
                };
                // Translations of central gear and planet in the frame of the mesh; rotations enter linearly.
                let mut onto = DMatrix::zeros(6, n);
                let (of_central, of_planet) = match kind {
                    MeshKind::SunPlanet => (0, 3),
                    MeshKind::RingPlanet => (3, 0),
                };
                let mut set = |row: usize, body: Body, axis: Axis, value: f64| {
                    if let Some(i) = model.coordinates.of(body, axis) {
                        onto[(row, i)] = value;
                    }
                };
                set(of_central, central, Axis::First, cos);
                set(of_central, central, Axis::Second, sin);
                set(of_central + 1, central, Axis::First, -sin);
                set(of_central + 1, central, Axis::Second, cos);
                set(of_planet, Body::Planet(planet), Axis::First, 1.0);
                set(of_planet + 1, Body::Planet(planet), Axis::Second, 1.0);
                let turning = DMatrix::from_fn(6, 6, |i, j| self.force * hessian[i][j]);
                sum += onto.transpose() * turning * &onto;
            }
        }
        sum
    }
}

/// Windup from which on a value stays above 1 %, between two loads in proportion of the logarithms; `None` if it is
/// above at the least windup or not above at the largest.
fn crossing(points: &[Point]) -> Option<f64> {
    let last_within = points.iter().rposition(|p| p.1 <= WANTED)?;
    let (a, b) = (points.get(last_within)?, points.get(last_within + 1)?);
    let part = (WANTED / a.1).ln() / (b.1 / a.1).ln();
    Some(a.0 * (b.0 / a.0).powf(part))
}

/// An error of kinematics that are linear about one configuration.
struct Quantity {
    panel: &'static str,
    name: &'static str,
    measured: fn(&Left, &Load) -> f64,
    /// Of kinematics about the unloaded configuration; `None` without.
    theory: fn(&Load) -> Option<f64>,
}

const AT_REST: &str = "log₁₀ of the error of harmonics at rest";

/// With the shift of time, which kinematics about the loaded configuration do not have.
///
/// `[eq:shift-of-time]` Harmonic l is off by |1 − e^(2πi l w)| = 2 |sin πlw|.
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::kinematics_about_the_unloaded_set_are_off_as_theory_says`.
const SHIFTED: Quantity = Quantity {
    panel: AT_REST,
    name: "largest harmonic of the sun's rotation, with its phase",
    measured: |own, _| own.shifted,
    theory: |l| Some(2.0 * (PI * l.found.strongest as f64 * l.found.windup).sin().abs()),
};

const QUANTITIES: [Quantity; 4] = [
    Quantity {
        panel: AT_REST,
        name: "harmonics, the shift of time taken out",
        measured: |own, _| own.harmonics,
        theory: |_| None,
    },
    Quantity {
        panel: "log₁₀ of the error of natural frequencies of bearings and supports",
        name: "natural frequencies of bearings and supports",
        measured: |own, _| own.frequencies.supports,
        theory: |l| l.frequency,
    },
    Quantity {
        panel: "log₁₀ of the error of natural frequencies of the meshes",
        name: "natural frequencies of the meshes",
        measured: |own, _| own.frequencies.meshes,
        theory: |_| None,
    },
    Quantity {
        panel: "log₁₀ of the error of an approach, over the mean approach",
        name: "approaches of tooth pairs, of the mean approach",
        measured: |own, l| own.approach / l.found.deflection,
        theory: |l| Some(l.corner / l.found.deflection),
    },
];

fn write(map: &mut StabilityMap, by: By, loads: &[Load]) {
    let words = match by {
        By::Torque => "by torque",
        By::SofterBearings => "by soft bearings",
    };
    if let Some(own) = loads.iter().find(|l| l.factor == 1.0) {
        let quantity = "windup under the scene's own load, base pitches";
        map.compare(words, quantity, own.found.windup, own.windup);
    }
    let most = loads.iter().map(|l| l.found.windup).fold(0.0, f64::max);
    map.measure(words, "largest windup that the accepted deflection allows, base pitches", most);
    let about =
        |configuration: &str| format!("{words}, linear about the {configuration} configuration");
    for configuration in ["unloaded", "loaded"] {
        let (of, is_unloaded) = (about(configuration), configuration == "unloaded");
        let shifted = is_unloaded.then_some((SHIFTED, ", shift of time kept"));
        let others = QUANTITIES.into_iter().map(|quantity| (quantity, ""));
        for (Quantity { panel, name, measured, theory }, kept) in shifted.into_iter().chain(others)
        {
            let own = |l: &Load| match is_unloaded {
                true => l.found.about_unloaded,
                false => Some(l.found.about_loaded),
            };
            let over_windup = |of: &dyn Fn(&Load) -> Option<f64>| -> Vec<Point> {
                loads.iter().filter_map(|l| Some((l.found.windup, of(l)?))).collect()
            };
            let measured = over_windup(&|l| Some(measured(&own(l)?, l)));
            let theory = over_windup(&|l| theory(l).filter(|_| is_unloaded));
            let borders = [crossing(&measured), crossing(&theory)];
            // What is not reached between the least and the largest windup is not listed.
            if borders != [None, None] {
                let quantity =
                    format!("windup from which on the error is above 1 %, base pitches: {name}");
                map.compare(&of, quantity, borders[0], borders[1]);
            }
            for (which, found) in [("least", measured.first()), ("largest", measured.last())] {
                let Some((windup, error)) = found else { continue };
                let exact = theory.iter().find(|p| p.0 == *windup).map(|p| p.1);
                let quantity =
                    format!("error at the {which} windup, {windup:.4} base pitches: {name}");
                map.compare(&of, quantity, *error, exact);
            }
            let name = format!("{configuration}{kept}, {words}");
            let above = |points: Vec<Point>| points.into_iter().filter(|p| p.1 > 0.0);
            let is_known = !theory.is_empty();
            map.draw(Drawn::Measured, panel, &name, logarithms(above(measured), 0.0));
            if is_known {
                map.draw(Drawn::Theory, panel, &name, logarithms(above(theory), 0.0));
            }
        }
    }
    if let Some(lost) = loads.iter().find(|l| l.found.about_unloaded.is_none()) {
        let quantity = "windup at which no equilibrium is found, base pitches";
        map.measure(about("unloaded"), quantity, lost.found.windup);
    }
    let rest = loads.iter().map(|l| l.found.rest).fold(0.0, f64::max);
    let quantity = "largest kinematic rest over the transmission error (warned of above 0.01)";
    map.measure(about("loaded"), quantity, rest);
}
