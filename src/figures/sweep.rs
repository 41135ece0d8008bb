//! Figures of a speed sweep, arranged as Figs 4 to 11 of Parker, Agashe & Vijayakar (2000): waterfalls of the
//! harmonics over the mesh frequency and over the frequency of each harmonic, and one panel per harmonic.

use experiments::sweep::{Coordinate, Part, Sweep, SweepPoint};
use gearset::Body;
use lumped::ModeType;
use scene::Scene;

use super::drawing::{Pen, Series, colour_of};
use super::{Figure, distinct, harmonics, multipliers, waterfall};

/// A quantity whose largest amplitude is below this share of the largest in its unit is not drawn.
const NOTHING: f64 = 1e-9;

/// Natural frequencies of one type that differ by less than this share are drawn as one.
const SAME: f64 = 1e-3;

/// What a sweep was run on.
#[derive(Debug, Clone, Copy)]
pub struct SweepContext<'a> {
    /// Scene of the set.
    pub scene: &'a Scene,
    /// Torque on the sun, N m.
    pub torque_nm: f64,
    /// Natural frequencies (Hz) with their types; may be empty.
    pub natural: &'a [(f64, ModeType)],
}

/// A steady state's amplitude in one harmonic, with what the figures need of the state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub(super) mesh_hz: f64,
    pub(super) amplitude: f64,
    pub(super) is_steady: bool,
}

/// One quantity over the sweep.
pub(super) struct Quantity {
    /// For people.
    pub(super) title: String,
    /// For file names.
    name: String,
    /// µm or µrad.
    pub(super) unit: &'static str,
    /// By harmonic from 1, then by branch: increasing speeds first.
    pub(super) harmonics: Vec<Vec<Vec<Spot>>>,
}

impl Quantity {
    /// Largest amplitude of all harmonics.
    pub(super) fn largest(&self) -> f64 {
        self.harmonics.iter().map(|h| Self::largest_of(h)).fold(0.0, f64::max)
    }

    /// Largest amplitude of one harmonic.
    pub(super) fn largest_of(branches: &[Vec<Spot>]) -> f64 {
        branches.iter().flatten().map(|s| s.amplitude).fold(0.0, f64::max)
    }
}

/// What all figures of a sweep share.
pub(super) struct Subject {
    pub(super) title: String,
    /// Fidelity, torque, speeds.
    pub(super) caption: String,
    /// Whether every motion repeats with the mesh cycle and was shown to attract.
    pub(super) is_settled: bool,
    /// Highest mesh frequency, Hz.
    pub(super) top_mesh_hz: f64,
    /// Speed of the input member at a mesh frequency of 1 Hz, rpm.
    pub(super) rpm_per_hz: f64,
    /// Natural frequencies (Hz) with their types, ascending.
    pub(super) natural: Vec<(f64, ModeType)>,
}

impl Subject {
    /// Lines over the height of a panel at natural frequencies, of which `place` gives the value on its x axis; one
    /// named series for each type of mode.
    pub(super) fn natural_lines(&self, place: impl Fn(f64) -> f64) -> Vec<Series> {
        let types = distinct(self.natural.iter().map(|(_, mode_type)| *mode_type));
        let series = types.into_iter().map(|mode_type| {
            let alike = self.natural.iter().filter(|(_, other)| *other == mode_type);
            let pen = Pen::new(colour_of(mode_type), 1.0).dashed();
            Series::uprights(mode_type.name(), pen, alike.map(|(f, _)| place(*f)))
        });
        series.collect()
    }
}

/// Figures of a sweep: `waterfalls`, `frequencies`, one `harmonics_*` per quantity and, of a model with derivative,
/// `multipliers`; none for a sweep without points.
pub fn of_sweep(sweep: &Sweep, context: &SweepContext<'_>) -> Vec<Figure> {
    let Some(subject) = subject(sweep, context) else { return Vec::new() };
    let list = quantities(sweep, context.scene.planets.psi_rad.len());
    if list.is_empty() {
        return Vec::new();
    }
    let mut figures = vec![
        Figure::new("waterfalls", waterfall::over_mesh_frequency(&subject, &list)),
        Figure::new("frequencies", waterfall::over_frequency(&subject, &list)),
    ];
    figures.extend(list.iter().map(|quantity| {
        let name = format!("harmonics_{}", quantity.name);
        Figure::new(name, harmonics::picture(&subject, quantity))
    }));
    let of_multipliers = multipliers::picture(sweep, &subject.title);
    figures.extend(of_multipliers.map(|picture| Figure::new("multipliers", picture)));
    figures
}

/// Caption and scales; `None` without points.
fn subject(sweep: &Sweep, context: &SweepContext<'_>) -> Option<Subject> {
    let points = sweep.points();
    let (first, last) = (points.first()?, points.last()?);
    let mut natural: Vec<(f64, ModeType)> = context.natural.to_vec();
    natural.retain(|(f, _)| f.is_finite() && *f > 0.0);
    natural.sort_by(|a, b| a.0.total_cmp(&b.0));
    natural.dedup_by(|b, a| a.1 == b.1 && b.0 - a.0 < SAME * a.0);
    let moved = points.iter().filter(|p| !p.is_steady).count();
    let unsettled = match moved {
        0 => String::new(),
        n => format!(
            "; {n} of {} repeat after several mesh cycles or were not shown to attract",
            points.len()
        ),
    };
    let failed = match sweep.failed.len() {
        0 => String::new(),
        1 => "; 1 speed could not be computed".to_owned(),
        n => format!("; {n} speeds could not be computed"),
    };
    Some(Subject {
        title: context.scene.title.clone(),
        caption: format!(
            "fidelity {}, {:.0} N·m on the sun, {:.0} to {:.0} rpm{unsettled}{failed}",
            sweep.fidelity,
            context.torque_nm,
            first.state.case.speed_rpm,
            last.state.case.speed_rpm
        ),
        is_settled: moved == 0,
        top_mesh_hz: last.state.case.mesh_frequency_hz,
        rpm_per_hz: last.state.case.speed_rpm / last.state.case.mesh_frequency_hz,
        natural,
    })
}

/// Points of chains of increasing speed (those about peaks included), then of decreasing; by speed.
fn branches(sweep: &Sweep) -> Vec<Vec<&SweepPoint>> {
    let (mut up, mut down): (Vec<&SweepPoint>, Vec<&SweepPoint>) = (Vec::new(), Vec::new());
    for (name, points) in &sweep.chains {
        let side = if name.starts_with("down") { &mut down } else { &mut up };
        side.extend(points);
    }
    let mut both = vec![up, down];
    both.retain(|side| !side.is_empty());
    for side in &mut both {
        side.sort_by(|a, b| a.state.case.speed_rpm.total_cmp(&b.state.case.speed_rpm));
    }
    both
}

/// Rotations and translations of the bodies that are large enough to be drawn; of the planets, planet 0.
fn quantities(sweep: &Sweep, planets: usize) -> Vec<Quantity> {
    use Coordinate::{Radial, Rotation, Tangential};
    let mut wanted: Vec<(Part, &str, &[Coordinate])> = Vec::new();
    for part in [Part::SUN, Part::CARRIER, Part::RING] {
        wanted.push((part, "rotation", &[Rotation]));
        wanted.push((part, "translation", &[Radial, Tangential]));
    }
    if planets > 0 {
        wanted.push((Part::Body(Body::Planet(0)), "rotation", &[Rotation]));
        wanted.push((Part::Body(Body::Planet(0)), "radial", &[Radial]));
        wanted.push((Part::Body(Body::Planet(0)), "tangential", &[Tangential]));
    }
    let branches = branches(sweep);
    let mut list: Vec<Quantity> = wanted
        .into_iter()
        .map(|(part, kind, coordinates)| quantity(&branches, part, kind, coordinates))
        .collect();
    let largest = |unit: &str| {
        list.iter().filter(|q| q.unit == unit).map(Quantity::largest).fold(0.0, f64::max)
    };
    let [of_rotations, of_translations] = ["µrad", "µm"].map(largest);
    list.retain(|q| {
        let all = if q.unit == "µrad" { of_rotations } else { of_translations };
        q.largest() > NOTHING * all
    });
    list
}

fn quantity(
    branches: &[Vec<&SweepPoint>],
    part: Part,
    kind: &str,
    coordinates: &[Coordinate],
) -> Quantity {
    let name = part.name();
    let displacement = match kind {
        "radial" | "tangential" => " displacement",
        _ => "",
    };
    let spot = |p: &SweepPoint, l: usize| {
        // √(radial² + tangential²) of a translation
        let all = coordinates.iter().map(|c| p.state.amplitude(part, *c, l));
        Spot {
            mesh_hz: p.state.case.mesh_frequency_hz,
            amplitude: 1e6 * all.fold(0.0, f64::hypot),
            is_steady: p.is_steady,
        }
    };
    let lines = branches.iter().flatten().flat_map(|p| &p.state.lines);
    let top = lines.map(|line| line.harmonic).max().unwrap_or(0);
    let of_branches =
        |l| branches.iter().map(|side| side.iter().map(|p| spot(p, l)).collect()).collect();
    Quantity {
        title: format!("{}, {kind}{displacement}", name.replace('_', " ")),
        name: format!("{name}_{kind}"),
        unit: if kind == "rotation" { "µrad" } else { "µm" },
        harmonics: (1..=top).map(of_branches).collect(),
    }
}
