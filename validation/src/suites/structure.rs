//! Structure theorems as properties over random sets.

use experiments::models::Changed;
use experiments::{ModalModel, frequencies_of};
use gearset::PlanetPositions;
use lumped::{LumpedModel, ModeType, NaturalModes};
use scene::{PerBody, Scene, Torsional};

use crate::error::ValidationError;
use crate::reference::Reference;

use super::Checks;
use super::mode_lists::multiplicities;
use super::tables::{modes_of, planet_1_heavier};

const SETS: usize = 200;

/// `scenes`: one set with all members free, whose parameters are drawn anew.
pub(crate) fn checks(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut random = fastrand::Rng::with_seed(1999);
    let [template] = scenes else {
        return Err(ValidationError::Incomplete("set to draw others from"));
    };
    let (mut spectrum, mut diametrical) = (0, 0);
    for _ in 0..SETS {
        let planets = random.usize(3..=8);
        let set = random_set(template, &mut random, planets);
        spectrum += usize::from(!has_published_structure(model, &set)?);
        let pairs = random.usize(2..=3);
        let set = random_set(template, &mut random, 2 * pairs);
        let turned = turn_pairs(&set, &mut random);
        diametrical += usize::from(!only_pairs_split(model, &set, &turned)?);
    }
    let title = "200 random sets, N = 3 to 8, equally spaced, all members free: violations of 6 rotational, 6 translational pairs, 3 planet frequencies N−3 times";
    let spectrum = reference.about("structure.spectrum", title)?.equal(0.0, spectrum as f64);
    let title = "200 random sets of diametrical pairs: violations of 'rotational and planet frequencies stay, translational pairs split'";
    let about = reference.about("structure.diametrical", title)?;
    Ok(vec![spectrum, about.equal(0.0, diametrical as f64)])
}

/// Mirror images of random sets; mode shapes are needed, which only our own lumped model gives here.
pub(crate) fn mirror(scenes: &[Scene], reference: &Reference) -> Checks {
    let mut random = fastrand::Rng::with_seed(2000);
    let [template] = scenes else {
        return Err(ValidationError::Incomplete("set to draw others from"));
    };
    let mut violations = 0;
    for _ in 0..SETS {
        let pairs = random.usize(2..=3);
        let set = random_set(template, &mut random, 2 * pairs);
        violations += usize::from(!mirrored_set_mirrors_its_modes(&set, &mut random)?);
    }
    let title = "200 random sets and their mirror images: frequencies, types or mirrored mode shapes that differ";
    Ok(vec![reference.about("structure.mirror", title)?.equal(0.0, violations as f64)])
}

/// Control: one planet heavier in every set.
pub(crate) fn controls(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let judged = checks(&Changed::new(model, planet_1_heavier), scenes, reference)?;
    Ok(vec![reference.control("structure.control.planet_heavier", &judged)?])
}

/// Any set with all members free, equally spaced.
fn random_set(template: &Scene, random: &mut fastrand::Rng, planets: usize) -> Scene {
    let mut set = template.variant("drawn at random");
    set.planets = PlanetPositions::equally_spaced(planets);
    // Uniform in the logarithm: sets differ by decades, not by percents.
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let mut bodies = || PerBody {
        carrier: Some(between(0.2, 10.0)),
        ring: Some(between(0.2, 10.0)),
        sun: Some(between(0.2, 10.0)),
        planet: Some(between(0.2, 10.0)),
    };
    let (mass, inertia_over_r2) = (bodies(), bodies());
    if let Some(lumped) = &mut set.lumped {
        (lumped.mass_kg, lumped.inertia_over_r2_kg) = (mass, inertia_over_r2);
        lumped.mesh_n_per_m.sun_planet = between(5e7, 1e9);
        lumped.mesh_n_per_m.ring_planet = between(5e7, 1e9);
        lumped.pressure_angle_rad.sun_planet = between(0.25, 0.6);
        lumped.pressure_angle_rad.ring_planet = between(0.25, 0.6);
    }
    set.supports.carrier.bearing_n_per_m = between(1e7, 1e9);
    set.supports.ring.bearing_n_per_m = between(1e7, 1e9);
    set.supports.sun.bearing_n_per_m = between(1e7, 1e9);
    set.supports.planet_bearing_n_per_m = between(1e7, 1e9);
    set.supports.ring.torsional = Torsional::PerLength(between(1e7, 1e9));
    set
}

fn has_published_structure(model: &dyn ModalModel, set: &Scene) -> Result<bool, ValidationError> {
    let modes = modes_of(model, set)?;
    let planets = set.planets.count();
    let planet = if planets > 3 { vec![planets - 3; 3] } else { vec![] };
    Ok(multiplicities(&modes, ModeType::Rotational) == [1; 6]
        && multiplicities(&modes, ModeType::Translational) == [2; 6]
        && multiplicities(&modes, ModeType::Planet) == planet)
}

/// Turns each diametrical pair by a random angle of up to a quarter of the spacing.
fn turn_pairs(set: &Scene, random: &mut fastrand::Rng) -> Scene {
    let mut turned = set.clone();
    let planets = set.planets.count();
    for n in 1..planets / 2 {
        let angle = (random.f64() * 0.4 + 0.1) * std::f64::consts::TAU / planets as f64 * 0.5;
        turned.planets.psi_rad[n] += angle;
        turned.planets.psi_rad[n + planets / 2] += angle;
    }
    turned
}

fn only_pairs_split(
    model: &dyn ModalModel,
    set: &Scene,
    turned: &Scene,
) -> Result<bool, ValidationError> {
    let (equal, turned) = (modes_of(model, set)?, modes_of(model, turned)?);
    let highest = equal.iter().map(|m| m.frequency_hz).fold(0.0, f64::max);
    let same = |mode_type| {
        let (a, b) = (frequencies_of(&equal, mode_type), frequencies_of(&turned, mode_type));
        a.len() == b.len()
            && a.iter().zip(&b).all(|(x, y)| (x * x - y * y).abs() < 1e-10 * highest * highest)
    };
    Ok(same(ModeType::Rotational)
        && same(ModeType::Planet)
        && multiplicities(&turned, ModeType::Planet) == multiplicities(&equal, ModeType::Planet)
        && multiplicities(&turned, ModeType::Translational) == [1; 12])
}

fn model_of(set: &Scene) -> Result<(LumpedModel, NaturalModes), ValidationError> {
    let model = LumpedModel::from_scene(set)?;
    let modes = NaturalModes::of(&model)?;
    Ok((model, modes))
}

/// Mirrors a set in the axis through planet 0 and reverses the senses of rotation: every pressure
/// angle and position changes sign, and so do y, η and u. The mirrored shapes must be modes of the
/// mirrored set with the same frequencies and types.
fn mirrored_set_mirrors_its_modes(
    set: &Scene,
    random: &mut fastrand::Rng,
) -> Result<bool, ValidationError> {
    let set = turn_pairs(set, random);
    let mut mirrored = set.clone();
    mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    if let Some(lumped) = &mut mirrored.lumped {
        lumped.pressure_angle_rad.sun_planet *= -1.0;
        lumped.pressure_angle_rad.ring_planet *= -1.0;
    }
    let (model, modes) = model_of(&set)?;
    let (mirror_model, mirror_modes) = model_of(&mirrored)?;
    if modes.groups.len() != mirror_modes.groups.len() {
        return Ok(false);
    }
    let k = mirror_model.stiffness();
    let largest = modes.lambda.last().copied().unwrap_or(0.0);
    let sign = |i: usize| match model.coordinates.free()[i].1 {
        gearset::Axis::First => 1.0,
        _ => -1.0,
    };
    let n = model.mass.len();
    for (group, mirror_group) in modes.groups.iter().zip(&mirror_modes.groups) {
        let same_type = group.mode_type == mirror_group.mode_type;
        if !same_type || (group.lambda - mirror_group.lambda).abs() > 1e-11 * largest {
            return Ok(false);
        }
        for j in 0..group.multiplicity {
            for row in 0..n {
                let force: f64 =
                    (0..n).map(|i| k[(row, i)] * sign(i) * group.vectors[(i, j)]).sum();
                let inertia =
                    group.lambda * mirror_model.mass[row] * sign(row) * group.vectors[(row, j)];
                let scale = largest * mirror_model.mass[row].sqrt();
                if (force - inertia).abs() > 1e-9 * scale {
                    return Ok(false);
                }
            }
        }
    }
    Ok(true)
}
