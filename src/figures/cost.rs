//! Error against cost of the fidelities of the ladder (`kept/ladder.toml`).

use validation::{Ladder, LadderFidelity};

use super::distinct;
use super::drawing::{Panel, Picture, panels};
use super::error_cost::{self, Setting};

/// Error in height and place of the peak over cost.
pub fn cost(ladder: &Ladder) -> Picture {
    let uncertain = [ladder.peak_rad_uncertain_percent, ladder.peak_rpm_uncertain_percent];
    let list = [
        panel(ladder, "height of the peak", LadderFidelity::height_percent, uncertain[0], 1.0),
        panel(ladder, "place of the peak", LadderFidelity::place_percent, uncertain[1], 0.2),
    ];
    let caption = format!(
        "sun rotation, second harmonic, four planets, {} N·m; truth: full bodies; labels: steps a mesh cycle",
        ladder.torque_nm
    );
    panels(["What a fidelity costs and how far off it is", &caption], 2, [430.0, 380.0], &list)
}

/// One kind of error, the uncertainty of its reference, below which none is drawn, and what is wanted, all in percent.
fn panel(
    ladder: &Ladder,
    title: &str,
    percent: fn(&LadderFidelity, &Ladder) -> f64,
    uncertain: f64,
    wanted: f64,
) -> Panel {
    let usual = ladder.fidelity.first().map_or(0, |fidelity| fidelity.contact_cells);
    let place =
        |f: &LadderFidelity| (f.cycle_ratio(), percent(f, ladder).abs().max(uncertain).max(1e-3));
    let settings: Vec<Setting<'_>> = ladder
        .fidelity
        .iter()
        .map(|f| {
            let (cost, error) = place(f);
            let is_worse = |other| {
                let (c, e) = place(other);
                c <= cost && e <= error && (c < cost || e < error)
            };
            let cells = match f.contact_cells == usual {
                true => String::new(),
                false => format!(", {} cells", f.contact_cells),
            };
            Setting {
                label: format!("{}{cells}", f.steps_per_cycle),
                group: &f.name,
                cost: [cost; 3],
                error,
                is_efficient: !ladder.fidelity.iter().any(is_worse),
                symbol: None,
            }
        })
        .collect();
    let groups = distinct(ladder.fidelity.iter().map(|f| f.name.as_str()));
    let cost = "cost of a mesh cycle, lumped at 140 steps = 1";
    error_cost::panel(title, cost, &groups, &settings, wanted)
}
