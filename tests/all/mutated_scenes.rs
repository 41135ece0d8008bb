//! Ten thousand mutated scene files through the command: no panic; every invalid one exits with 2
//! and a message that names a key, every valid one runs.

use std::path::Path;

/// A stream of random numbers (SplitMix64), the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

const VALUES: [&str; 18] = [
    "nan",
    "inf",
    "-1",
    "0",
    "1",
    "3",
    "1e308",
    "1e-308",
    "\"free\"",
    "\"held\"",
    "[]",
    "{}",
    "true",
    "1e9",
    "99999999999999999999",
    "[0, 1, 2, 3]",
    "{ sun = 1 }",
    "1979-05-27",
];

fn mutate(text: &str, random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let at = random.below(lines.len());
        let value = VALUES[random.below(VALUES.len())];
        match random.below(6) {
            0 => drop(lines.remove(at)),
            1 => {
                let from = random.below(lines.len());
                let copy = lines[from].clone();
                lines.insert(at, copy);
            }
            2 | 3 => {
                if let Some((key, _)) = lines[at].split_once('=') {
                    lines[at] = format!("{key}= {value}");
                }
            }
            4 => {
                let chars: Vec<char> = lines[at].chars().collect();
                if !chars.is_empty() {
                    let cut = random.below(chars.len());
                    lines[at] =
                        chars.iter().enumerate().filter(|c| c.0 != cut).map(|c| c.1).collect();
                }
            }
            // Scale a number: wrong geometry rather than wrong syntax.
            _ => {
                if let Some((key, old)) = lines[at].split_once('=')
                    && let Ok(x) = old.split('#').next().unwrap_or("").trim().parse::<f64>()
                {
                    let factor = [0.5, 0.9, 0.99, 1.01, 1.1, 2.0, -1.0][random.below(7)];
                    lines[at] = format!("{key}= {:?}", x * factor);
                }
            }
        }
    }
    lines.join("\n")
}

#[test]
fn ten_thousand_mutated_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let name = path.to_str().unwrap();
    let sources: Vec<String> = [
        "oh58_4p",
        "oh58_3p",
        "oh58_sun_planet_pair",
        "lin_parker_1999_4p",
        "five_planets",
        "oh58_4p_published_stiffness",
        "oh58_4p_second_system",
    ]
    .iter()
    .map(|s| Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{s}.toml")))
    .map(|p| std::fs::read_to_string(p).unwrap())
    .collect();
    let mut random = Random(58);
    let (mut valid, mut invalid) = (0, 0);
    for i in 0..10_000 {
        std::fs::write(&path, mutate(&sources[i % sources.len()], &mut random)).unwrap();
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let check = ["epicyclic", "scene", "check", name];
        let code = epicyclic::run(check, &mut out, &mut err);
        let err = String::from_utf8(err).unwrap();
        match code {
            0 => {
                valid += 1;
                // Whatever is valid must also run, or be refused for what it lacks.
                for verb in ["modes", "rules"] {
                    let (mut out, mut err) = (Vec::new(), Vec::new());
                    let code = epicyclic::run(["epicyclic", verb, name], &mut out, &mut err);
                    let text = std::fs::read_to_string(&path).unwrap();
                    assert!(code == 0 || code == 2, "{code}\n{text}");
                    assert_eq!(code == 2, !err.is_empty(), "{text}");
                }
            }
            2 => {
                invalid += 1;
                assert!(out.is_empty());
                assert!(err.contains('`') && err.contains("allowed"), "{err}");
            }
            _ => panic!("exit code {code}"),
        }
    }
    println!("{valid} valid, {invalid} invalid");
    assert!(valid > 500 && invalid > 500, "{valid} valid, {invalid} invalid");
}
