//! Mutated scene files through the command: no panic; every invalid one exits with 2 and a message that names a key;
//! every valid one runs or is refused by a verb for what it lacks, and what it prints keeps to the schema.

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

/// Scenes of the repository.
fn sources() -> Vec<String> {
    [
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
    .collect()
}

/// Whether a JSON text keeps to the schema of a verb; numbers that are none would be null.
fn keeps_to(schema: &jsonschema::Validator, text: &[u8]) -> Result<(), String> {
    let value = serde_json::from_slice(text).map_err(|e| e.to_string())?;
    let faults: Vec<String> = schema.iter_errors(&value).map(|e| e.to_string()).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

fn schema(name: &str) -> jsonschema::Validator {
    let path = format!("{}/schemas/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let schema = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    jsonschema::validator_for(&schema).unwrap()
}

/// Puts mutated scenes through the cheap verbs.
fn mutated_through_cheap_verbs(count: usize, seed: u64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let name = path.to_str().unwrap();
    let (sources, mut random) = (sources(), Random(seed));
    let checked = schema("scene_check");
    let verbs = [("modes", schema("modes")), ("rules", schema("rules"))];
    let (mut valid, mut invalid) = (0, 0);
    for i in 0..count {
        let text = mutate(&sources[i % sources.len()], &mut random);
        std::fs::write(&path, &text).unwrap();
        let run = |words: &[&str]| {
            let (mut out, mut err) = (Vec::new(), Vec::new());
            let (first, last) = (["epicyclic"], [name, "--format", "json"]);
            let all = first.iter().chain(words).chain(&last);
            let code = epicyclic::run(all, &mut out, &mut err);
            (code, out, String::from_utf8(err).unwrap())
        };
        match run(&["scene", "check"]) {
            (0, out, _) => {
                valid += 1;
                keeps_to(&checked, &out).unwrap_or_else(|e| panic!("scene check: {e}\n{text}"));
                // Whatever is valid must also run, or be refused for what it lacks.
                for (verb, schema) in &verbs {
                    let (code, out, err) = run(&[verb]);
                    assert!(code == 0 || code == 2, "{code}\n{text}");
                    match code {
                        0 => {
                            keeps_to(schema, &out).unwrap_or_else(|e| panic!("{verb}: {e}\n{text}"))
                        }
                        _ => assert!(!err.is_empty(), "{text}"),
                    }
                }
            }
            (2, out, err) => {
                invalid += 1;
                assert!(out.is_empty());
                assert!(err.contains('`') && err.contains("allowed"), "{err}");
            }
            (code, ..) => panic!("exit code {code}"),
        }
    }
    println!("{valid} valid, {invalid} invalid");
    assert!(valid * 20 > count && invalid * 20 > count, "{valid} valid, {invalid} invalid");
}

#[test]
fn ten_thousand_mutated_scenes() {
    mutated_through_cheap_verbs(10_000, 58);
}

#[test]
#[ignore = "ten minutes: cargo test --release --test all mutated -- --ignored"]
fn a_hundred_thousand_mutated_scenes() {
    mutated_through_cheap_verbs(100_000, 2026);
}

/// Seconds and KiB of address space of one run of an expensive verb.
const MOST_SECONDS: u64 = 60;
const MOST_KIB: u64 = 4 << 20;

/// Two hundred valid mutated scenes with coarse meshes through every expensive verb, in processes of their own that
/// may take 4 GiB and 60 s: each ends with 0, or with 2 and a message.
#[test]
#[ignore = "half an hour: cargo test --release --test all mutated -- --ignored"]
fn two_hundred_mutated_scenes_through_expensive_verbs() {
    let folder = tempfile::tempdir().unwrap();
    let (sources, mut random) = (sources(), Random(7));
    let mut scenes = Vec::new();
    while scenes.len() < 200 {
        let whole = [0, 1, 2, 4, 5, 6][scenes.len() % 6];
        let mut text = mutate(&sources[whole], &mut random);
        if !text.contains("[fe_contact]") {
            text += "\n[fe_contact]\nflank_elements = 8\n";
        }
        let path = folder.path().join(format!("{}.toml", scenes.len()));
        std::fs::write(&path, &text).unwrap();
        let name = path.to_str().unwrap().to_owned();
        let check = ["epicyclic", "scene", "check", &name];
        if epicyclic::run(check, &mut Vec::new(), &mut Vec::new()) == 0 {
            scenes.push((name, text));
        }
    }
    let refused = std::sync::Mutex::new(0);
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some((name, text)) = scenes.get(at) else { break };
                    *refused.lock().unwrap() += expensive(name, text);
                }
            });
        }
    });
    println!("{} of {} runs were refused", refused.into_inner().unwrap(), 4 * scenes.len());
}

/// Runs the expensive verbs on one scene; how many refuse it.
fn expensive(name: &str, text: &str) -> usize {
    let pair = text.contains("kind = \"gear_pair\"");
    let load = if pair { "--normal-force-n 3000" } else { "" };
    let verbs = [
        ("mesh", format!("mesh {name}")),
        (
            if pair { "static_pair" } else { "static_set" },
            format!("static {name} --positions 2 {load}"),
        ),
        ("impulse", format!("impulse {name} --duration-ms 10")),
        (
            "sweep",
            format!(
                "sweep {name} --speeds-rpm 800:800:1 --tolerance 1e-3 --between-cycles 0 --most-cycles 20"
            ),
        ),
    ];
    let mut refused = 0;
    for (verb, line) in verbs {
        let program = env!("CARGO_BIN_EXE_epicyclic");
        let limited = format!(
            "ulimit -v {MOST_KIB}; exec timeout {MOST_SECONDS} {program} {line} --format json"
        );
        let found = std::process::Command::new("bash").args(["-c", &limited]).output().unwrap();
        let err = String::from_utf8_lossy(&found.stderr);
        match found.status.code() {
            Some(0) => keeps_to(&schema(verb), &found.stdout)
                .unwrap_or_else(|e| panic!("{verb}: {e}\n{text}")),
            Some(2) => {
                assert!(!err.is_empty() && !err.contains("panicked"), "{verb}: {err}\n{text}");
                refused += 1;
            }
            other => panic!("{verb} ended with {other:?}: {err}\n{text}"),
        }
    }
    refused
}
