//! Tongues of parametric instability of a lumped set with prescribed mesh stiffness.

use lumped::{ParametricSet, Tongue, TongueEdges, tongues};
use scene::Scene;

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "parametric",
    about: "Parametric instability by varying mesh stiffness: tongues over mesh frequency",
    meaning: "between the borders of a tongue the varying mesh stiffness feeds a vibration that grows from nothing",
    of: MapOf::Planets(map),
};

/// Harmonics of the mesh frequency.
const HARMONICS: u32 = 3;

/// ε at which borders are tabled, and those of the figure.
const TABLED: f64 = 0.02;
const DRAWN: [f64; 3] = [0.01, 0.02, 0.04];

/// Widest tongues standing alone that are measured, and tongues that phasing and contact ratio close.
const MEASURED: usize = 8;
const CLOSED: usize = 6;

/// A tongue weaker than this, beside what it would be without phasing, is closed.
const NOTHING: f64 = 1e-9;

/// Title of the figure's panel.
const PANEL: &str = "ε, half the peak-to-peak variation over the mean stiffness";

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let set = ParametricSet::from_scene(scene, TABLED)?;
    let mut map = StabilityMap::of(
        &MAP,
        scene.title.clone(),
        "detuning of the mesh frequency over the first-order half-width at ε = 0.04",
    );
    // The wedge of first order, in which all tongues are of one width.
    let top = DRAWN[DRAWN.len() - 1];
    map.draw(Drawn::Theory, PANEL, "first order", [(-1.0, top), (0.0, 0.0), (1.0, top)]);
    let mut all = tongues(&set, HARMONICS)?;
    all.sort_by(|a, b| b.half_width_hz.total_cmp(&a.half_width_hz));
    let open: Vec<Tongue> = all.iter().filter(|t| t.strength() > NOTHING).cloned().collect();
    for tongue in open.iter().filter(|t| is_alone(t, &open)).take(MEASURED) {
        let of = named(tongue);
        let found = set.edges(tongue)?;
        let half = TABLED * tongue.half_width_hz;
        let at = |edge: fn(&TongueEdges) -> f64| found.as_ref().map(edge);
        for (quantity, unit, measured, theory) in [
            ("lower border", "Hz", at(|e| e.low_hz), tongue.mesh_frequency_hz - half),
            ("upper border", "Hz", at(|e| e.high_hz), tongue.mesh_frequency_hz + half),
            ("half-width", "Hz", at(|e| 0.5 * (e.high_hz - e.low_hz)), half),
            ("growth", "1/s", at(|e| e.growth_per_s), TABLED * tongue.growth_per_s),
        ] {
            let quantity = format!("{quantity} at ε = {TABLED}");
            map.compare_in(unit, &of, quantity, measured, Some(theory));
        }
        // The borders found, in ε over detuning as part of the first-order half-width at the largest ε.
        let mut points = Vec::new();
        for epsilon in DRAWN {
            if let Some(found) = set.with_variation(epsilon)?.edges(tongue)? {
                for border in [found.low_hz, found.high_hz] {
                    let detuning = border - tongue.mesh_frequency_hz;
                    points.push((detuning / (top * tongue.half_width_hz), epsilon));
                }
            }
        }
        let [p, q] = tongue.frequency_hz;
        let name = format!("l = {}, {p:.0} + {q:.0} Hz", tongue.harmonic);
        map.draw(Drawn::Points, PANEL, &name, points);
    }
    // Of the closed ones those that would be the widest.
    all.sort_by(|a, b| b.bound_hz.total_cmp(&a.bound_hz));
    let is_apart = |t: &&Tongue| {
        let reach = 3.0 * TABLED * (t.half_width_hz + t.bound_hz);
        let near = |o: &&Tongue| (o.mesh_frequency_hz - t.mesh_frequency_hz).abs() < reach;
        !all.iter().filter(near).any(|o| o.strength() > NOTHING)
    };
    let closed = all.iter().filter(|t| t.strength() <= NOTHING && t.bound_hz > 0.0);
    for tongue in closed.filter(is_apart).take(CLOSED) {
        let growth = set.growth_per_s(tongue.mesh_frequency_hz)?;
        let of = format!("{}, closed by phasing or contact ratio", named(tongue));
        map.compare_in("1/s", of, "growth at its centre", growth, Some(0.0));
    }
    Ok(map)
}

/// Whether no other open tongue has its centre within six half-widths at the largest ε: first-order borders are those
/// of one tongue alone.
fn is_alone(tongue: &Tongue, open: &[Tongue]) -> bool {
    let near = |o: &&Tongue| {
        let wide = 6.0 * DRAWN[DRAWN.len() - 1] * tongue.half_width_hz.max(o.half_width_hz);
        (o.mesh_frequency_hz - tongue.mesh_frequency_hz).abs() < wide
    };
    open.iter().filter(near).count() == 1
}

fn named(tongue: &Tongue) -> String {
    let [p, q] = tongue.frequency_hz;
    let [a, b] = tongue.mode_type.map(|t| t.name());
    match p == q && a == b {
        true => format!("l = {}, twice {p:.1} Hz ({a})", tongue.harmonic),
        false => format!("l = {}, {p:.1} Hz ({a}) + {q:.1} Hz ({b})", tongue.harmonic),
    }
}
