//! The cheapest settings for the amplitude of a steady state, the largest over the speeds of a sweep.

use gearset::{AutoResponse, LoadCase, Scene};

use super::amplitude_indicators::Indicators;
use super::amplitude_meshes::{MESHES, of_elements};
use super::amplitude_run::{Motions, Turning, on};
use super::choice::{AutoError, Choice, Correction, ErrorPart, Together};
use super::elastic_response::elastic_response;
use super::error_parts::SetSize;
use super::frequency::BODY_INERTIA;
use super::response::name;
use super::settings::{AutoSettings, phase_parts};
use super::trial::Trial;
use crate::error::ExperimentError;
use crate::sweep::{SteadySettings, Sweep};

/// The amplitude of a steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct AmplitudeRequest {
    /// Which motion: its root mean square in the harmonics that are kept.
    pub response: AutoResponse,
    /// Speeds of the driven member, ascending, rpm: the largest root mean square over them is asked for.
    pub speeds_rpm: Vec<f64>,
    /// How steady states are found, and the highest harmonic.
    pub steady: SteadySettings,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
}

impl std::fmt::Display for AmplitudeRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (name, highest) = (name(self.response), self.steady.harmonics);
        write!(f, "root mean square of harmonics 1 to {highest} of the {name}")?;
        match self.speeds_rpm.as_slice() {
            [speed] => write!(f, " at {speed} rpm"),
            [first, .., last] => write!(f, ", the largest from {first} to {last} rpm"),
            [] => Ok(()),
        }
    }
}

/// A choice, and the sweep that gave it.
#[derive(Debug)]
pub struct ChosenSweep {
    /// Settings, value and estimated error.
    pub choice: Choice,
    /// Steady states at all speeds.
    pub sweep: Sweep,
}

/// Fewest steps of a candidate; others are doubled. Fewer than 60 have fewer than 12 in a period of harmonic 5.
const STEPS: u32 = 60;

/// What 60 steps on each mesh cost over those on the coarsest, and by how much more of this each further 60 steps do.
const OF_MESH: [f64; MESHES.len()] = [1.0, 1.2, 1.8];
const OF_STEPS: f64 = 0.6;

/// Most doublings of the steps.
const DOUBLINGS: u32 = 2;

/// Part of the tolerance that the estimate of the elements alone may be on the first mesh: what resonances make of it, unevenness, steps and
/// inertia need the rest.
const OF_TOLERANCE: f64 = 0.5;

/// Finest mesh that is the first one.
const FINEST_FIRST: usize = 1;

/// Factor from the change in the last cycle to what is left to go: transients fall by a tenth or more in a cycle.
const LEFT_TO_GO: f64 = 10.0;

impl AmplitudeRequest {
    /// All candidates for a scene, from cheap to dear.
    pub fn candidates(scene: &Scene) -> Vec<AutoSettings> {
        let base = base(scene);
        let of = |(mesh, doubled): (usize, u32)| {
            let own = settings(base << doubled, mesh);
            [own, own.with_elastic_inertia()]
        };
        quasi_static(None).into_iter().flat_map(of).collect()
    }

    /// Number of the mesh to begin with.
    fn first_mesh(&self) -> usize {
        let allowed = OF_TOLERANCE * self.tolerance_percent / 100.0;
        let is_fine = |mesh: &usize| of_elements(*mesh) <= allowed;
        (0..FINEST_FIRST).find(is_fine).unwrap_or(FINEST_FIRST)
    }
}

/// Quasi-static candidates from cheap to dear: number of the mesh, and how often the steps are doubled. Those with more steps on the mesh that is
/// known already cost these alone.
fn quasi_static(known: Option<usize>) -> Vec<(usize, u32)> {
    let cost = |(mesh, doubled): &(usize, u32)| {
        let own = if known == Some(*mesh) { 0.0 } else { 1.0 };
        OF_MESH[*mesh] * (own + OF_STEPS * f64::from((1 << doubled) - 1))
    };
    let of_mesh = |mesh| (0..=DOUBLINGS).map(move |doubled| (mesh, doubled));
    let mut all: Vec<_> = (0..MESHES.len()).flat_map(of_mesh).collect();
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    all
}

/// Steps of a candidate that are not doubled, so that all planets pass through the same phases: a multiple of those with which
/// candidates are compared.
fn base(scene: &Scene) -> u32 {
    let parts = phase_parts(scene);
    let least = |every: u32| STEPS.div_ceil(every * parts) * every * parts;
    // A multiple of six and of the parts; parts that share a factor with six need no more steps for it.
    (least(1)..=least(6)).find(|n| n.is_multiple_of(6) && n.is_multiple_of(parts)).unwrap_or(STEPS)
}

fn settings(steps: u32, mesh: usize) -> AutoSettings {
    let (elements, cells) = MESHES[mesh];
    AutoSettings::quasi_static(elements, cells).with_divided_layer().with_steps(steps)
}

/// The amplitude of a request with given settings, corrected as that of a candidate, µm.
///
/// # Errors
/// If the settings are refused, a motion does not become steady, or nothing is known of the inertia that they ask for.
pub fn amplitude_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &AmplitudeRequest,
) -> Result<f64, ExperimentError> {
    on((scene, case), settings, request, |turning| {
        let motions = turning.motions(&request.speeds_rpm)?;
        let unknown = ExperimentError::Incomplete("inertia of elastic displacements");
        let by_inertia = match settings.elastic_inertia {
            true => elastic_response(turning, &motions)?.ok_or(unknown)?.growth(),
            false => 1.0,
        };
        Ok(1e6 * by_inertia * motions.largest())
    })
}

/// Harmonics of the response at all speeds of a request with given settings as the time steps have them, without any correction: by
/// speed, then by coordinate and harmonic, real and imaginary part, µm.
///
/// # Errors
/// If the settings are refused, or a motion does not become steady.
pub fn stepped_amplitude_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &AmplitudeRequest,
) -> Result<Vec<Vec<[f64; 2]>>, ExperimentError> {
    let found =
        on((scene, case), settings, request, |own| own.motions_in_steps(&request.speeds_rpm))?;
    let in_um = |line: &[f64; 2]| line.map(|x| 1e6 * x);
    Ok(found.stepped().map(|own| own.lines().iter().map(in_um).collect()).collect())
}

/// The cheapest candidate whose estimated error is within the tolerance, with its answer and its sweep.
///
/// Indicators are taken on the coarsest mesh that gives an answer, whose gears the candidates on this mesh share.
///
/// # Errors
/// If no candidate has the amplitude, or none is estimated to be within the tolerance.
pub fn choose_amplitude(
    scene: &Scene,
    case: &LoadCase,
    request: &AmplitudeRequest,
) -> Result<ChosenSweep, AutoError> {
    let quantity = request.to_string();
    let mut trial = Trial::new(quantity, "µm", request.tolerance_percent)?;
    let size = SetSize::new(scene, case)?;
    let (of, base) = ((scene, case), base(scene));
    for mesh in request.first_mesh()..MESHES.len() {
        let own = settings(base, mesh);
        let searched = on(of, own, request, |turning| {
            let indicators = Indicators::new(turning, (&size, mesh), request)?;
            let search = Search { of, request, base, turning };
            Ok(search.among(indicators, &mut trial))
        });
        match searched {
            Ok(Some((choice, sweep))) => {
                return Ok(ChosenSweep { choice: trial.with(choice), sweep });
            }
            Ok(None) => return Err(trial.refusal()),
            Err(e) => trial.refused(own, e),
        }
    }
    Err(trial.refusal())
}

const MESH: &str = "finite elements and contact cells";
const TIME_STEPS: &str = "time steps";
const PERIODICITY: &str = "periodicity of the steady state";
const STEP_FREQUENCY: &str = "the frequency that time steps give a harmonic";

struct Search<'s, 't> {
    of: (&'s Scene, &'s LoadCase),
    request: &'s AmplitudeRequest,
    /// Steps that are not doubled.
    base: u32,
    /// The coarsest candidate.
    turning: &'s Turning<'t>,
}

/// A choice with its sweep.
type Found = Option<(Choice, Sweep)>;

impl Search<'_, '_> {
    fn among(&self, mut known: Indicators, trial: &mut Trial) -> Found {
        let mut list = quasi_static(Some(known.mesh)).into_iter();
        list.find_map(|(mesh, doubled)| self.tried(trial, &mut known, mesh, doubled))
    }

    fn tried(&self, trial: &mut Trial, known: &mut Indicators, mesh: usize, doubled: u32) -> Found {
        let own = settings(self.base << doubled, mesh);
        if mesh < self.request.first_mesh() {
            trial.refused(own, "not run: elements alone may take more than half of the tolerance");
            return None;
        }
        if mesh < known.mesh {
            // At its fewest steps it is in the list already.
            if doubled > 0 {
                trial.refused(own, "its mesh is refused, as above");
            }
            return None;
        }
        let without = [
            ErrorPart::new(MESH, known.of_mesh(mesh)),
            ErrorPart::new(TIME_STEPS, known.of_steps(doubled)),
            ErrorPart::new(PERIODICITY, LEFT_TO_GO * known.motions.residual()),
        ];
        let with = |inertia: f64| {
            let inertia = std::iter::once(ErrorPart::new(BODY_INERTIA, inertia));
            Together::Expanded.of(&without.iter().cloned().chain(inertia).collect::<Vec<_>>())
        };
        let allowed = self.request.tolerance_percent;
        // The bound of the inertia costs little; what replaces it is asked for where it decides.
        let is_decided_by_it = with(0.0) <= allowed && with(known.inertia) > allowed;
        if is_decided_by_it && let Err(e) = known.replace_bound(self.turning) {
            trial.refused(own, e);
            return None;
        }
        let own = if known.with_inertia.is_some() { own.with_elastic_inertia() } else { own };
        let is_coarsest = (mesh, doubled) == (known.mesh, 0);
        let expected = with(known.inertia);
        if !is_coarsest && !trial.is_expected(own, expected) {
            return None;
        }
        let found = match is_coarsest {
            true => None,
            false => Some(self.on_gears(trial, known, (mesh, own))?),
        };
        let motions = found.as_ref().unwrap_or(&known.motions);
        let parts = vec![
            ErrorPart::new(MESH, known.of_mesh_seen(mesh, motions)),
            ErrorPart::new(TIME_STEPS, known.of_steps_seen((mesh, doubled), motions)),
            ErrorPart::new(BODY_INERTIA, known.inertia),
            ErrorPart::new(PERIODICITY, LEFT_TO_GO * motions.residual()),
        ];
        let by_inertia = known.with_inertia.unwrap_or(1.0);
        let value = 1e6 * by_inertia * motions.largest();
        let choice =
            trial.judged(own, value, parts, Together::Expanded, || known.why_no_bound())?;
        let correction = |of: &str, by: f64| Correction { of: of.into(), percent: 100.0 * by };
        let of_inertia = known.with_inertia.map(|by| correction(BODY_INERTIA, by - 1.0));
        let corrections = std::iter::once(correction(STEP_FREQUENCY, motions.corrected_by()))
            .chain(of_inertia)
            .collect();
        let sweep = found.map_or_else(|| known.motions.sweep.clone(), |found| found.sweep);
        Some((Choice { corrections, ..choice }, sweep))
    }

    /// The candidate `own`: on the gears of the coarsest candidate where it has the same mesh.
    fn on_gears(
        &self,
        trial: &mut Trial,
        known: &Indicators,
        (mesh, own): (usize, AutoSettings),
    ) -> Option<Motions> {
        let speeds = &self.request.speeds_rpm;
        let found = match mesh == known.mesh {
            true => self.turning.with_steps(own, |turning| turning.motions(speeds)),
            false => on(self.of, own, self.request, |turning| turning.motions(speeds)),
        };
        found.map_err(|e| trial.refused(own, e)).ok()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use gearset::{SceneKind, template};

    use super::*;

    /// OH-58 with four planets, its load case, and the request for a response at some speeds.
    pub(in super::super) fn oh58(
        response: AutoResponse,
        speeds_rpm: &[f64],
    ) -> (Scene, LoadCase, AmplitudeRequest) {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::from_file(path.as_ref()).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let request =
            AmplitudeRequest { speeds_rpm: speeds_rpm.to_vec(), ..request(response, 5.0) };
        (scene, case, request)
    }

    fn request(response: AutoResponse, tolerance_percent: f64) -> AmplitudeRequest {
        AmplitudeRequest {
            response,
            speeds_rpm: vec![1500.0],
            steady: SteadySettings { between_cycles: 0, ..SteadySettings::default() },
            tolerance_percent,
        }
    }

    /// The first mesh is the coarsest whose elements leave half of the tolerance, but no finer than the second.
    #[test]
    fn the_first_mesh_leaves_room_for_other_errors() {
        let of = |tolerance| request(AutoResponse::SunTranslation, tolerance).first_mesh();
        let least = 200.0 * of_elements(0);
        assert!((1.0..2.0).contains(&least), "{least}");
        assert_eq!([0.5, 0.99 * least, 1.01 * least, 10.0].map(of), [1, 1, 0, 0]);
    }

    /// The amplitude with the inertia of the bodies to first order is nearer to that with thirty modes of each body, by a quarter of their change
    /// and more.
    #[test]
    fn inertia_is_added_to_an_amplitude_as_modes_change_it() {
        for speed in [1500.0, 2500.0] {
            let (scene, case, request) = oh58(AutoResponse::TransmissionError, &[speed]);
            let plain = AutoSettings::quasi_static(6, 20).with_steps(120);
            let of = |own| amplitude_with(&scene, &case, own, &request).unwrap();
            let own = of(plain.with_elastic_inertia()) / of(plain) - 1.0;
            let stepped = |own| {
                let lines = stepped_amplitude_with(&scene, &case, own, &request).unwrap();
                lines[0].iter().map(|[re, im]| 0.5 * (re * re + im * im)).sum::<f64>().sqrt()
            };
            let modal =
                stepped(AutoSettings::modal(30, 6, 20).with_steps(120)) / stepped(plain) - 1.0;
            println!("{speed} rpm: {own:+.5} to first order, {modal:+.5} by modes");
            assert!(
                modal.abs() > 1e-3 && (own - modal).abs() < 0.75 * modal.abs(),
                "{own} {modal}"
            );
        }
    }

    /// With its torque and rotation reversed a set of evenly spaced planets presses on its other flanks, and but
    /// for damping moves as its mirror image backwards in time, at positions that fall otherwise on the steps:
    /// with 120 of them both corrections change a motion alike to a fiftieth. What inertia changes of the
    /// amplitude is the small part of this change that is in phase with the motion, and is compared with all of
    /// it.
    #[test]
    fn a_mirrored_set_is_corrected_alike() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let reversed = case.with_sun_torque(-case.sun_torque_nm).in_direction(case.direction());
        let own = AutoSettings::quasi_static(6, 20).with_steps(120).with_elastic_inertia();
        for response in [AutoResponse::TransmissionError, AutoResponse::SunTranslation] {
            let request = request(response, 5.0);
            let [one, other] = [case, reversed].map(|case| {
                let found = on((&scene, &case), own, &request, |turning| {
                    let motions = turning.motions(&request.speeds_rpm)?;
                    let inertia = elastic_response(turning, &motions)?.unwrap();
                    let of_all = inertia.rms() / motions.of_sun(turning);
                    let of_response = inertia.rms() / motions.largest();
                    Ok((motions.corrected_by(), inertia.growth() - 1.0, of_all, of_response))
                });
                found.unwrap()
            });
            println!("{response:?}: {one:?}, mirrored {other:?}");
            let same = |a: f64, b: f64| (a - b).abs() < 0.02 * a.abs().max(b.abs()).max(1e-9);
            assert!(same(one.2, other.2), "{response:?}");
            // What planet phasing forbids is rounding, and has no change.
            if one.2 > 1e-6 {
                assert!(same(one.0, other.0) && same(one.3, other.3), "{response:?}");
                assert!((one.1 - other.1).abs() < 0.02 * one.3, "{response:?}");
            }
        }
    }
}
