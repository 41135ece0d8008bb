//! Error against cost of the settings of a study, a panel for each quantity.

use experiments::study::{QuantityResult, StudyResult};

use super::drawing::{self, Panel, Pen, Series, Symbol, panels};
use super::error_cost::{self, Setting};
use super::{Figure, distinct};

/// Smallest error that is drawn, percent.
const LEAST: f64 = 1e-6;

const BELOW: &str = "#d9dde1";

/// A setting whose rank changes as the truth moves within its uncertainty.
const OPEN: Symbol = Symbol::Disc(4.0, "#b9bdc1");

/// One figure of a study; `name` is that of its file.
pub fn of_study(study: &StudyResult, name: &str) -> Figure {
    let groups = distinct(study.settings.iter().map(|setting| setting.group.as_str()));
    let list: Vec<Panel> =
        study.quantities.iter().map(|quantity| panel(study, quantity, &groups)).collect();
    let caption = format!(
        "{}, {} N·m on the sun; cost 1: a mesh cycle of the lumped model of 140 steps",
        study.scene, study.sun_torque_nm
    );
    let picture = panels([&study.title, &caption], 2, [430.0, 330.0], &list);
    Figure::new(format!("study_{}", name.replace('-', "_")), picture)
}

fn panel(study: &StudyResult, quantity: &QuantityResult, groups: &[&str]) -> Panel {
    let uncertain = quantity.truth.uncertainty_percent;
    let pairs = quantity.rows.iter().zip(&study.settings);
    let settings = pairs.filter_map(|(row, setting)| {
        let cost = row.time.cost_cycles.filter(|q| q.median > 0.0)?;
        let number = groups.iter().position(|g| *g == setting.group).unwrap_or(0);
        let symbol = match (row.doubt.is_some(), row.ranks) {
            (true, _) => Some(doubtful(drawing::colour(number))),
            (_, Some([low, high])) if low != high => Some(OPEN),
            _ => None,
        };
        let start = format!("{}: ", setting.group);
        Some(Setting {
            label: setting.name.strip_prefix(&start).unwrap_or(&setting.name).to_owned(),
            group: &setting.group,
            cost: [cost.low, cost.median, cost.high],
            error: row.guarded_percent?.max(uncertain).max(LEAST),
            is_efficient: row.time.is_efficient,
            symbol,
        })
    });
    let settings: Vec<Setting<'_>> = settings.collect();
    let (cost, wanted) = ("cost, lumped mesh cycles", study.tolerance_percent);
    let mut panel = error_cost::panel(&quantity.name, cost, groups, &settings, wanted);
    let below = "below U: not to be told from\nthe truth, drawn at U";
    let area = (f64::NAN, uncertain.max(LEAST));
    panel.series.extend([
        Series::new("rank changes as the truth\nmoves by ±U", OPEN, []),
        Series::new(
            "a finer setting is farther off:\ndrawn with its error",
            doubtful("#6b7075"),
            [],
        ),
        Series::new(below, Symbol::Below(BELOW), [area]),
    ]);
    panel
}

/// A setting than which a finer one is farther off.
fn doubtful(colour: &'static str) -> Symbol {
    Symbol::Ring(4.0, Pen::new(colour, 1.6))
}
