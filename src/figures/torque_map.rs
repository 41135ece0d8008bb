//! Map over mesh compliance and γ of where the statements on growth with torque hold
//! (`kept/torque_map.toml`).

use validation::{MapCell, TorqueMap};

use super::drawing::{Axis, Label, Panel, Pen, Picture, Series, Symbol, panels};

/// One statement, with a number for each cell.
struct Statement {
    title: &'static str,
    holds: fn(&MapCell) -> bool,
    number: fn(&MapCell) -> f64,
}

/// Growth up to the last torque; lists are kept divided by their first value.
fn grown(list: &[f64]) -> f64 {
    list.last().copied().unwrap_or(f64::NAN)
}

const STATEMENTS: [Statement; 4] = [
    Statement {
        title: "every peak grows (least growth of any step)",
        holds: |cell| cell.monotonic,
        number: MapCell::least_growth_of_a_step,
    },
    Statement {
        title: "rotational above translational (ratio)",
        holds: |cell| cell.rotation_above_translation,
        number: |cell| grown(&cell.rotational) / grown(&cell.translational),
    },
    Statement {
        title: "third translational below rotational (ratio)",
        holds: |cell| cell.third_below_rotation,
        number: |cell| grown(&cell.third) / grown(&cell.rotational),
    },
    Statement {
        title: "static order as dynamic (static ratio)",
        holds: MapCell::keeps_static_order,
        number: |cell| grown(&cell.rotational_static) / grown(&cell.translational_static),
    },
];

/// A panel for each statement; the ring is where the paper's own stiffness and phases lie
/// (`paper_gamma`: phase of the ring meshes to the sun meshes of its four-planet set, cycles).
pub fn torque_map(map: &TorqueMap, paper_gamma: f64) -> Picture {
    let (first, last) =
        (map.torques_nm.first().unwrap_or(&0.0), map.torques_nm.last().unwrap_or(&0.0));
    let caption = format!(
        "four planets, sun, quasi-static fidelity; holds: at every torque from {first:.0} to {last:.0} N·m; ratios: growth to {last:.0} N·m"
    );
    let cells: Vec<&MapCell> = map.cell.iter().filter(|c| c.line == "map").collect();
    let list = STATEMENTS.map(|statement| panel(&statement, &cells, paper_gamma));
    let title = "Growth with torque over mesh compliance and phase";
    panels([title, &caption], 2, [320.0, 320.0], &list)
}

/// γ reduced to −0.5 to 0.5 cycles; whole cycles do not matter.
fn gamma(cell: &MapCell) -> f64 {
    cell.gamma_cycles - cell.gamma_cycles.round()
}

/// Distinct values, ascending.
fn values(of: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut list: Vec<f64> = of.collect();
    list.sort_by(f64::total_cmp);
    list.dedup();
    list
}

fn panel(statement: &Statement, cells: &[&MapCell], paper: f64) -> Panel {
    let xs = values(cells.iter().map(|c| c.softening));
    let ys = values(cells.iter().map(|c| gamma(c)));
    let at = |x, y| place(&xs, x).zip(place(&ys, y));
    let tiles = |holds: bool| {
        let alike = cells.iter().filter(move |c| (statement.holds)(c) == holds);
        alike.filter_map(|c| at(c.softening, gamma(c)))
    };
    let numbers = cells.iter().filter_map(|c| {
        let text = format!("{:.2}", (statement.number)(c));
        Some(Label { point: at(c.softening, gamma(c))?, text, colour: "#000000" })
    });
    let ring = Symbol::Ring(10.0, Pen::new("#000000", 2.0));
    Panel {
        title: statement.title.into(),
        x: Axis::named(
            "softening: 0 default scene, 1 printed mesh stiffness",
            xs.iter().map(|value| format!("{value}")),
        ),
        y: Axis::named("γ, cycles", ys.iter().map(|value| format!("{value:.3}"))),
        series: vec![
            Series::new("holds", Symbol::Tile("#56b4e9"), tiles(true)),
            Series::new("fails", Symbol::Tile("#e69f00"), tiles(false)),
            Series::new("the paper's place", ring, at(1.0, paper - paper.round())),
        ],
        on: numbers.collect(),
        ..Panel::default()
    }
}

/// Place of a value among ascending ones, in cells from the edge of the first; `None` outside their range.
fn place(values: &[f64], value: f64) -> Option<f64> {
    let after = values.iter().position(|v| *v >= value)?;
    let Some(before) = after.checked_sub(1) else {
        return (values[0] == value).then_some(0.5);
    };
    let share = (value - values[before]) / (values[after] - values[before]);
    Some(before as f64 + share + 0.5)
}

#[cfg(test)]
mod tests {
    use super::place;

    #[test]
    fn places_lie_in_their_cells() {
        let values = [1.0, 2.0, 4.0];
        let found = [1.0, 2.0, 3.0, 4.0, 0.4, 5.5].map(|v| place(&values, v));
        assert_eq!(found, [Some(0.5), Some(1.5), Some(2.0), Some(2.5), None, None]);
        assert_eq!(place(&[], 3.0), None);
    }
}
