//! Map over mesh compliance and γ of where the statements on growth with torque hold
//! (`kept/torque_map.toml`).

use validation::{MapCell, TorqueMap};

use super::drawing::{Anchor, Canvas, Pen, Picture, Pixel, Type};

const HOLDS: &str = "#56b4e9";
const FAILS: &str = "#e69f00";

/// Side of a map, px, and the room about it.
const MAP: f64 = 320.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 122.0;
const FOOT: f64 = 64.0;

/// One statement, with a number for each cell.
struct Panel {
    title: &'static str,
    holds: fn(&MapCell) -> bool,
    number: fn(&MapCell) -> f64,
}

/// Growth up to the last torque; lists are kept divided by their first value.
fn grown(list: &[f64]) -> f64 {
    list.last().copied().unwrap_or(f64::NAN)
}

const PANELS: [Panel; 4] = [
    Panel {
        title: "every peak grows (least growth of any step)",
        holds: |cell| cell.monotonic,
        number: MapCell::least_growth_of_a_step,
    },
    Panel {
        title: "rotational above translational (ratio)",
        holds: |cell| cell.rotation_above_translation,
        number: |cell| grown(&cell.rotational) / grown(&cell.translational),
    },
    Panel {
        title: "third translational below rotational (ratio)",
        holds: |cell| cell.third_below_rotation,
        number: |cell| grown(&cell.third) / grown(&cell.rotational),
    },
    Panel {
        title: "static order as dynamic (static ratio)",
        holds: MapCell::keeps_static_order,
        number: |cell| grown(&cell.rotational_static) / grown(&cell.translational_static),
    },
];

/// A panel for each statement; the ring is where the paper's own stiffness and phases lie
/// (`paper_gamma`: phase of the ring meshes to the sun meshes of its four-planet set, cycles).
pub fn torque_map(map: &TorqueMap, paper_gamma: f64) -> Picture {
    let cell = [LEFT + MAP + 20.0, TOP + MAP + FOOT];
    let mut canvas = Canvas::new([2.0 * cell[0], 2.0 * cell[1] - TOP + 50.0]);
    let (first, last) =
        (map.torques_nm.first().unwrap_or(&0.0), map.torques_nm.last().unwrap_or(&0.0));
    canvas.head(
        "Growth with torque over mesh compliance and phase",
        &format!("four planets, sun, quasi-static fidelity; holds: at every torque from {first:.0} to {last:.0} N·m; ratios: growth to {last:.0} N·m"),
    );
    let mut x = cell[0] - 130.0;
    for (fill, name) in [(HOLDS, "holds"), (FAILS, "fails")] {
        canvas.rectangle([x, 60.0], [16.0, 12.0], fill);
        canvas.text([x + 22.0, 70.0], Type::new(12, Anchor::Start), name);
        x += 90.0;
    }
    canvas.ring([x + 8.0, 66.0], 7.0, Pen::new("#000000", 2.0));
    canvas.text([x + 22.0, 70.0], Type::new(12, Anchor::Start), "the paper's place");
    let cells: Vec<&MapCell> = map.cell.iter().filter(|c| c.line == "map").collect();
    for (i, panel) in PANELS.iter().enumerate() {
        let (column, row) = ((i % 2) as f64, (i / 2) as f64);
        let corner = [LEFT + cell[0] * column, TOP + (cell[1] - TOP + 40.0) * row];
        draw(&mut canvas, panel, &cells, corner, paper_gamma);
    }
    canvas.picture()
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

fn draw(canvas: &mut Canvas, panel: &Panel, cells: &[&MapCell], [left, top]: Pixel, paper: f64) {
    let xs = values(cells.iter().map(|c| c.softening));
    let ys = values(cells.iter().map(|c| gamma(c)));
    let size = [MAP / xs.len().max(1) as f64, MAP / ys.len().max(1) as f64];
    let title = Type::new(13, Anchor::Middle);
    canvas.text([left + 0.5 * MAP, top - 10.0], title, panel.title);
    let middle = |x: f64, y: f64| [left + size[0] * x, top + MAP - size[1] * y];
    for cell in cells {
        let place = |list: &[f64], value: f64| list.iter().position(|v| *v == value);
        let (Some(ix), Some(iy)) = (place(&xs, cell.softening), place(&ys, gamma(cell))) else {
            continue;
        };
        let [x, y] = middle(ix as f64, iy as f64 + 1.0);
        let fill = if (panel.holds)(cell) { HOLDS } else { FAILS };
        canvas.rectangle([x + 0.5, y + 0.5], [size[0] - 1.0, size[1] - 1.0], fill);
        let at = [x + 0.5 * size[0], y + 0.5 * size[1] + 3.5];
        canvas.text(at, Type::new(10, Anchor::Middle), format!("{:.2}", (panel.number)(cell)));
    }
    for (i, value) in xs.iter().enumerate() {
        let [x, _] = middle(i as f64 + 0.5, 0.0);
        canvas.text([x, top + MAP + 16.0], Type::new(11, Anchor::Middle), format!("{value}"));
    }
    for (i, value) in ys.iter().enumerate() {
        let [_, y] = middle(0.0, i as f64 + 0.5);
        canvas.text([left - 6.0, y + 4.0], Type::new(11, Anchor::End), format!("{value:.3}"));
    }
    let below = "softening: 0 default scene, 1 printed mesh stiffness";
    canvas.text([left + 0.5 * MAP, top + MAP + 36.0], Type::new(12, Anchor::Middle), below);
    let beside = Type::new(12, Anchor::Middle).turned(-90.0);
    canvas.text([left - 58.0, top + 0.5 * MAP], beside, "γ, cycles");
    if let (Some(x), Some(y)) = (place(&xs, 1.0), place(&ys, paper - paper.round())) {
        canvas.ring(middle(x, y), 15.0, Pen::new("#000000", 2.0));
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
