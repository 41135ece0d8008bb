//! Figures as a reader meets them, judged by the text of their SVG files: labels that keep clear of one another and of
//! lines, and curves that can be told apart where they coincide.

use std::path::Path;

use crate::harness::{coarse, run, scene};

/// A text of an SVG file with the corners of the box it fills, by estimate.
struct Label {
    words: String,
    corners: [[f64; 2]; 4],
}

/// The value of an attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = element.split_once(&format!(" {name}=\""))?;
    rest.split_once('"').map(|(value, _)| value)
}

fn number(element: &str, name: &str) -> f64 {
    attribute(element, name).unwrap().parse().unwrap()
}

/// The shift of a group; none for groups that only clip.
fn shift(group: &str) -> [f64; 2] {
    let translate = attribute(group, "transform").and_then(|t| t.strip_prefix("translate("));
    let Some(inside) = translate else { return [0.0; 2] };
    let (x, y) = inside.trim_end_matches(')').split_once(',').unwrap();
    [x.parse().unwrap(), y.parse().unwrap()]
}

/// Width of a text over its type size: that of DejaVu Sans, a wide font, to a tenth.
fn width(words: &str) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | ' ' | '.' | ',' | ':' | ';' | '\'' => 0.32,
        'f' | 't' | 'r' | '-' | '(' | ')' => 0.4,
        '=' | 'm' | 'w' | 'M' | 'W' => 0.85,
        _ => 0.62,
    };
    words.chars().map(of).sum()
}

/// Corners of a text, 0.7 of the type size high above its base line.
fn corners(element: &str, words: &str, origin: [f64; 2]) -> [[f64; 2]; 4] {
    let size = number(element, "font-size");
    let width = size * width(words);
    let left = match attribute(element, "text-anchor").unwrap() {
        "middle" => -0.5 * width,
        "end" => -width,
        _ => 0.0,
    };
    let turn = attribute(element, "transform").and_then(|t| t.strip_prefix("rotate("));
    let degrees: f64 = turn.map_or(0.0, |t| t.split(',').next().unwrap().parse().unwrap());
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let base = [number(element, "x") + origin[0], number(element, "y") + origin[1]];
    [[left, -0.7 * size], [left + width, -0.7 * size], [left + width, 0.0], [left, 0.0]]
        .map(|[u, v]| [base[0] + cosine * u - sine * v, base[1] + sine * u + cosine * v])
}

/// All texts of an SVG file.
fn labels(svg: &str) -> Vec<Label> {
    let mut origins = vec![[0.0; 2]];
    let mut found = Vec::new();
    for part in svg.split('<').skip(1) {
        let (element, rest) = part.split_once('>').unwrap();
        let [x, y] = *origins.last().unwrap();
        if element == "/g" {
            origins.pop();
        } else if element == "g" || element.starts_with("g ") {
            let [dx, dy] = shift(element);
            origins.push([x + dx, y + dy]);
        } else if element.starts_with("text ") {
            let entities =
                [("&amp;", "&"), ("&apos;", "'"), ("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">")];
            let words = entities.iter().fold(rest.to_owned(), |t, (code, c)| t.replace(code, c));
            found.push(Label { corners: corners(element, &words, [x, y]), words });
        }
    }
    found
}

/// Whether two convex shapes have points in common: no edge of either has all of the other on its far side.
fn overlap(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let apart = |edges: &[[f64; 2]]| {
        (0..edges.len()).any(|i| {
            let (p, q) = (edges[i], edges[(i + 1) % edges.len()]);
            let across = |r: &[f64; 2]| (q[1] - p[1]) * r[0] - (q[0] - p[0]) * r[1];
            let range = |shape: &[[f64; 2]]| {
                let all = shape.iter().map(across);
                all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
            };
            let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
            high_a <= low_b || high_b <= low_a
        })
    };
    !apart(a) && !apart(b)
}

/// Pairs of texts that cover one another.
fn covered(svg: &str) -> Vec<(String, String)> {
    let all = labels(svg);
    let mut found = Vec::new();
    for (i, a) in all.iter().enumerate() {
        for b in &all[..i] {
            if overlap(&a.corners, &b.corners) {
                found.push((b.words.clone(), a.words.clone()));
            }
        }
    }
    found
}

/// Every SVG file of a folder.
fn drawn(folder: &Path) -> Vec<(String, String)> {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|e| e == "svg"))
        .map(|path| (path.display().to_string(), std::fs::read_to_string(&path).unwrap()))
        .collect()
}

fn draws(line: &str) {
    let (code, _, err) = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(code, 0, "{line}: {err}");
}

#[test]
fn no_label_covers_another() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().to_str().unwrap();
    let (set, pair) = (coarse(folder.path(), "oh58_4p.toml"), scene("oh58_sun_planet_pair.toml"));
    draws(&format!("static {set} --positions 8 --sun-torque-nm 700,1400 --figures {at}/set"));
    draws(&format!("static {pair} --normal-force-n 1e4 --positions 8 --figures {at}/pair"));
    let speeds = "--speeds-rpm 300:2500:200 --tolerance 1e-4 --both-ways";
    draws(&format!("sweep {set} {speeds} --model lumped --figures {at}/sweep"));
    draws(&format!("stability explicit-step --out {at}/map"));
    draws(&format!("stability integrators --out {at}/maps"));
    draws(&format!("validate --only table1. --report {at}/report"));
    let mut count = 0;
    for name in ["set", "pair", "sweep", "map", "maps", "report"] {
        for (path, svg) in drawn(&folder.path().join(name)) {
            assert!(labels(&svg).len() > 8, "{path}");
            assert_eq!(covered(&svg), [], "{path}");
            count += 1;
        }
    }
    assert!(count > 20, "{count} figures");
}

/// The control of the test above: a label moved onto its neighbour is found, in a shifted group and turned too.
#[test]
fn a_label_that_covers_another_is_found() {
    let text = |x: f64, y: f64, turn: &str, words: &str| {
        format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"10\" text-anchor=\"start\"{turn}>{words}</text>"
        )
    };
    let two = |a: &str, b: &str| covered(&format!("<svg>{a}{b}</svg>"));
    let tick = text(100.0, 50.0, "", "500");
    assert_eq!(two(&tick, &text(119.0, 50.0, "", "f_m, Hz")), []);
    assert_eq!(two(&tick, &text(117.0, 50.0, "", "f_m, Hz")).len(), 1);
    let moved = format!("<g transform=\"translate(-40,0)\">{}</g>", text(150.0, 48.0, "", "Hz"));
    assert_eq!(two(&tick, &moved).len(), 1);
    // Upright beside the tick, and fallen onto it.
    let upright = text(98.0, 50.0, " transform=\"rotate(-90,98,50)\"", "amplitude");
    let fallen = text(98.0, 50.0, " transform=\"rotate(-20,98,50)\"", "amplitude");
    assert_eq!((two(&tick, &upright).len(), two(&tick, &fallen).len()), (0, 1));
}

/// Elements of a kind whose attribute `name` has a value.
fn elements<'a>(svg: &'a str, kind: &str, name: &str, value: &str) -> Vec<&'a str> {
    let all = svg.split('<').filter_map(|part| part.split_once('>').map(|(element, _)| element));
    all.filter(|e| e.starts_with(kind) && attribute(e, name) == Some(value)).collect()
}

/// Both ends of a straight line drawn as a path.
fn ends(path: &str) -> [[f64; 2]; 2] {
    let numbers: Vec<f64> =
        attribute(path, "d").unwrap().split(' ').filter_map(|word| word.parse().ok()).collect();
    assert_eq!(numbers.len(), 4, "{path}");
    [[numbers[0], numbers[1]], [numbers[2], numbers[3]]]
}

/// Each harmonic's line has its label at its own upper end, clear of every line and dot of the chart.
#[test]
fn every_harmonic_of_a_campbell_chart_is_labelled_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    draws(&format!("validate --only table1. --report {}", folder.path().display()));
    for name in ["campbell_3p", "campbell_4p"] {
        let svg = std::fs::read_to_string(folder.path().join(format!("{name}.svg"))).unwrap();
        let harmonics: Vec<_> =
            elements(&svg, "path ", "stroke", "#9aa0a6").into_iter().map(ends).collect();
        assert_eq!(harmonics.len(), 5, "{name}");
        let all = labels(&svg);
        let dashed = elements(&svg, "path ", "stroke-dasharray", "6 3");
        let level = dashed.iter().filter(|p| p.contains(" d=")).map(|p| ends(p));
        let lines: Vec<[[f64; 2]; 2]> = harmonics.iter().copied().chain(level).collect();
        for l in 1..=5 {
            let label = all.iter().find(|label| label.words == format!("l = {l}")).unwrap();
            let middle = [0, 1].map(|i| label.corners.iter().map(|c| c[i]).sum::<f64>() / 4.0);
            let width = number(svg.split("<svg").nth(1).unwrap(), "width");
            let is_shown = label.corners.iter().all(|c| (0.0..=width).contains(&c[0]));
            assert!(is_shown, "{name}, l = {l} is cut off at the edge of the picture");
            let to = |[_, end]: &[[f64; 2]; 2]| (end[0] - middle[0]).hypot(end[1] - middle[1]);
            // The lines of higher harmonics are steeper.
            let nearest = (0..5).min_by(|a, b| to(&harmonics[*a]).total_cmp(&to(&harmonics[*b])));
            assert_eq!(nearest, Some(l - 1), "{name}, l = {l}");
            assert!(to(&harmonics[l - 1]) < 25.0, "{name}, l = {l}");
            for line in &lines {
                assert!(!overlap(&label.corners, line), "{name}, l = {l} is crossed by {line:?}");
            }
            for dot in svg.split("<circle").skip(1) {
                let (x, y, r) = (number(dot, "cx"), number(dot, "cy"), number(dot, "r"));
                let square = [[x - r, y - r], [x + r, y - r], [x + r, y + r], [x - r, y + r]];
                assert!(!overlap(&label.corners, &square), "{name}, l = {l} lies under a dot");
            }
        }
    }
}

/// Meshes that carry the same force at every position are seen beside one another: each curve is drawn thinner than
/// those below it.
#[test]
fn coinciding_curves_of_load_sharing_can_be_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().display();
    let set = scene("oh58_4p.toml");
    draws(&format!("static {set} --positions 4 --figures {at}"));
    let svg = std::fs::read_to_string(folder.path().join("load_sharing.svg")).unwrap();
    // Lines through the four positions; those of frame, grid and key have two or five points.
    let curves: Vec<&str> =
        svg.split("<path ").skip(1).filter(|p| p.matches("L ").count() == 3).collect();
    assert_eq!(curves.len(), 8);
    let widths: Vec<f64> = curves.iter().map(|p| number(p, "stroke-width")).collect();
    assert!(widths.windows(2).all(|pair| pair[0] - pair[1] > 0.5), "{widths:?}");
    let mut colours: Vec<_> =
        curves.iter().map(|p| attribute(p, "stroke").or(p.strip_prefix("stroke=\""))).collect();
    colours.sort();
    colours.dedup();
    assert_eq!(colours.len(), 8);
    let is_dashed: Vec<bool> = curves.iter().map(|p| p.contains("stroke-dasharray")).collect();
    assert_eq!(is_dashed, [[false; 4], [true; 4]].concat());
}
