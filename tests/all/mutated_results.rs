//! Mutated results folders through `validate --recorded` and `results check`: no panic; 0, 1 or 2; what is refused is
//! refused with file and line.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::random::Random;

const CELLS: [&str; 20] = [
    "",
    "nan",
    "inf",
    "-1",
    "0",
    "1",
    "2",
    "1e308",
    "1e-308",
    "1,5",
    "abc",
    "\"",
    "\"a\nb\"",
    ";",
    "=1+1",
    "99999999999999999999",
    "planet_4",
    "rotational",
    "oh58_4p",
    "\t",
];

const TITLES: [&str; 8] =
    ["frequency_khz", "omega_rad_per_s", "value_mm", "scene", "phase_deg", "", "note", "Amplitude"];

/// Base radius of the sun of the OH-58, m.
const SUN: f64 = 0.5 * 0.09126 * 27.0 / 35.0;

/// Modes of the kept right model, matrices and vectors of one set, a mesh cycle of three planets, and of four planets
/// mesh stiffness, resonant peaks and steady states.
fn files() -> Vec<(&'static str, String)> {
    let set = validation::scene(validation::PublishedScene::Oh58FourPlanets).unwrap();
    let model = lumped::LumpedModel::from_scene(&set).unwrap();
    let (mass, stiffness) = (model.mass_matrix(), model.stiffness());
    let n = mass.nrows();
    let mut market = format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {n}\n");
    for i in 0..n {
        writeln!(market, "{} {} {}", i + 1, i + 1, mass[(i, i)]).unwrap();
    }
    let line = |row: Vec<String>| row.join(",") + "\n";
    let rows = stiffness.row_iter().map(|row| line(row.iter().map(f64::to_string).collect()));
    let table: String = rows.collect();
    let titles = model.coordinates.free().iter().map(|&(body, axis)| match (body, axis) {
        (_, gearset::Axis::Rotation) => format!("{}_u", body.name()),
        (gearset::Body::Planet(_), gearset::Axis::First) => format!("{}_radial", body.name()),
        (gearset::Body::Planet(_), _) => format!("{}_tangential", body.name()),
        (_, axis) => {
            format!("{}_{}", body.name(), if axis == gearset::Axis::First { "x" } else { "y" })
        }
    });
    let titles: Vec<String> = titles.collect();
    let mut vectors = format!("scene,frequency_hz,mode_type,{}\n", titles.join(","));
    for group in lumped::NaturalModes::of(&model).unwrap().groups {
        for vector in group.vectors.column_iter() {
            let numbers: Vec<String> = vector.iter().map(|x| format!("{x:.6e}")).collect();
            let (hz, name) = (group.frequency_hz, group.mode_type.name());
            writeln!(vectors, "oh58_4p,{hz:.3},{name},{}", numbers.join(",")).unwrap();
        }
    }
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/results/right");
    let read = |name: &str| std::fs::read_to_string(kept.join(name)).unwrap();
    let mut cycle = "scene,sun_torque_nm,position,body,coordinate,value\n".to_owned();
    for k in 0..28 {
        let at = f64::from(k) / 28.0;
        for (coordinate, value) in [("x", 0.0), ("y", 0.0), ("rotation", 1e-4)] {
            writeln!(cycle, "oh58_3p,1413,{at},sun,{coordinate},{value}").unwrap();
        }
        for mesh in ["sun_mesh", "ring_mesh"] {
            for n in 0..3 {
                writeln!(cycle, "oh58_3p,1413,{at},{mesh}_{n},force,{}", 1413.0 / (3.0 * SUN))
                    .unwrap();
            }
        }
    }
    let mut states = "scene,sun_torque_nm,speed_rpm,mesh_frequency_hz,body,coordinate,harmonic,amplitude,phase_rad\n".to_owned();
    for rpm in [500.0, 600.0] {
        let hz = rpm / 60.0 * 27.0 * 99.0 / 126.0;
        for l in 0..4 {
            let amplitude = 1e-4 / f64::from(1 + l);
            writeln!(states, "oh58_4p,1130,{rpm},{hz},sun,rotation,{l},{amplitude},0.5").unwrap();
        }
    }
    // A set without teeth: the pair beside which others stand takes a while.
    let mut mesh_stiffness = "scene,sun_torque_nm,body,position,stiffness_n_per_um\n".to_owned();
    for k in 0..28 {
        let at = f64::from(k) / 28.0;
        writeln!(mesh_stiffness, "lin_parker_1999_4p,1130,ring_mesh_0,{at},{}", 800 + k).unwrap();
    }
    let mut peaks =
        "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\n".to_owned();
    for (k, torque) in [565, 1130, 1695, 2260].iter().enumerate() {
        for (coordinate, harmonic, hz) in [("translation", 1, 779), ("rotation", 2, 1150)] {
            let amplitude = 1e-6 * (k as f64 + 1.5);
            writeln!(peaks, "oh58_4p,{torque},sun,{coordinate},{harmonic},{hz},{amplitude}")
                .unwrap();
        }
    }
    vec![
        ("modes.csv", read("modes.csv")),
        ("modes.csv", vectors),
        ("results.toml", read("results.toml")),
        ("matrices/oh58_4p.M.mtx", market),
        ("matrices/oh58_4p.K.csv", table),
        ("mesh_cycle.csv", cycle),
        ("mesh_stiffness.csv", mesh_stiffness),
        ("torque_peaks.csv", peaks),
        ("steady_states.csv", states),
    ]
}

/// One change of a text: of a line, a cell, a title, a separator or a byte.
fn mutate(text: &str, random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = random.below(lines.len());
    let replace = |line: &str, random: &mut Random, words: &[&str]| {
        let separator = if line.contains(',') { "," } else { " " };
        let mut cells: Vec<String> = line.split(separator).map(str::to_owned).collect();
        let cell = random.below(cells.len());
        cells[cell] = words[random.below(words.len())].to_owned();
        cells.join(separator)
    };
    match random.below(10) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[random.below(lines.len())].clone()),
        2 | 3 => lines[at] = replace(&lines[at], random, &CELLS),
        4 => lines[0] = replace(&lines[0], random, &TITLES),
        5 => lines.truncate(at),
        6 => {
            let scaled = |cell: &str| match cell.parse::<f64>() {
                Ok(x) => format!("{}", 1000.0 * x),
                Err(_) => cell.to_owned(),
            };
            lines[at] = lines[at].split(',').map(scaled).collect::<Vec<_>>().join(",");
        }
        7 => lines.iter_mut().for_each(|line| *line = line.replace(',', ";")),
        8 => return [b"\xef\xbb\xbf", text.as_bytes()].concat(),
        _ => {
            let mut bytes = text.as_bytes().to_vec();
            let byte = random.below(bytes.len());
            bytes[byte] = random.next() as u8;
            return bytes;
        }
    }
    lines.join("\n").into_bytes()
}

fn mutated_through_the_judgement(count: usize, seed: u64) {
    let (files, mut random) = (files(), Random(seed));
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("matrices")).unwrap();
    let name = folder.path().to_str().unwrap();
    let mut codes = [0; 3];
    for _ in 0..count {
        // Two speeds are no sweep: with steady states no folder passes, so that half of them have none. Of the two
        // tables of modes, one has vectors; matrices are there in every third folder.
        let mut present = files.clone();
        present.truncate(files.len() - random.below(2));
        if random.below(3) > 0 {
            present.retain(|(file, _)| !file.starts_with("matrices/"));
        }
        present.remove(random.below(2));
        for (file, _) in &files {
            let _ = std::fs::remove_file(folder.path().join(file));
        }
        for (file, text) in &present {
            std::fs::write(folder.path().join(file), text).unwrap();
        }
        for _ in 0..=random.below(2) {
            let (file, _) = &present[random.below(present.len())];
            let path: PathBuf = folder.path().join(file);
            let text = std::fs::read(&path).unwrap();
            let text = String::from_utf8_lossy(&text).into_owned();
            if !text.is_empty() {
                std::fs::write(&path, mutate(&text, &mut random)).unwrap();
            }
        }
        let run = |words: &[&str]| {
            let (mut out, mut err) = (Vec::new(), Vec::new());
            let code = epicyclic::run(["epicyclic"].iter().chain(words), &mut out, &mut err);
            (code, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
        };
        let (code, out, err) = run(&["validate", "--recorded", name]);
        codes[usize::from(code)] += 1;
        match code {
            0 | 1 => assert!(!out.contains("NaN") && out.contains(" passed, "), "{out}"),
            _ => assert!(out.is_empty() && says_where(&err), "{err}"),
        }
        let (check, _, _) = run(&["results", "check", name]);
        assert!([0, 2].contains(&check) && (code == 2) == (check == 2), "{code} {check}: {err}");
    }
    println!("{codes:?} of exit codes 0, 1 and 2");
    assert!(codes.iter().all(|n| 50 * n > count), "{codes:?}");
}

/// Whether a refusal names a file and a line of it; a file without lines has none.
fn says_where(err: &str) -> bool {
    let has_line = |name: &str| {
        err.split(name).skip(1).any(|rest| {
            rest.strip_prefix(':')
                .is_some_and(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    let matrices = ["oh58_4p.M.mtx", "oh58_4p.K.csv"];
    files().iter().map(|(name, _)| *name).chain(matrices).any(has_line)
        || [": no rows: ", ": cannot be read: "].iter().any(|words| err.contains(words))
}

#[test]
fn three_hundred_mutated_results_folders() {
    mutated_through_the_judgement(300, 56);
}

#[test]
#[ignore = "minutes: cargo test --release --test all mutated_results -- --ignored"]
fn ten_thousand_mutated_results_folders() {
    mutated_through_the_judgement(10_000, 2026);
}
