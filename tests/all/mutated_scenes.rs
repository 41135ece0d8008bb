//! Mutated scene files through the command: no panic; every invalid one exits with 2 and a message that names a key;
//! every valid one runs or is refused by a verb for what it lacks, and what it prints keeps to the schema.

use std::path::Path;

use super::random::Random;

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

/// The first number in a text that is none; schemas allow null where a value may be missing, so that JSON cannot show
/// all of them.
fn not_a_number(text: &[u8]) -> Result<(), String> {
    let text = String::from_utf8_lossy(text);
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    match words.find(|word| ["NaN", "inf"].contains(word)) {
        Some(word) => Err(format!("{word} in\n{text}")),
        None => Ok(()),
    }
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
    let (mut valid, mut invalid, mut refused) = (0, 0, 0);
    for i in 0..count {
        let text = mutate(&sources[i % sources.len()], &mut random);
        std::fs::write(&path, &text).unwrap();
        let run = |words: &[&str], format: &str| {
            let (mut out, mut err) = (Vec::new(), Vec::new());
            let (first, last) = (["epicyclic"], [name, "--format", format]);
            let all = first.iter().chain(words).chain(&last);
            let code = epicyclic::run(all, &mut out, &mut err);
            (code, out, String::from_utf8(err).unwrap())
        };
        match run(&["scene", "check"], "json") {
            (0, out, _) => {
                valid += 1;
                keeps_to(&checked, &out).unwrap_or_else(|e| panic!("scene check: {e}\n{text}"));
                // Whatever is valid must also run, or be refused for what it lacks.
                for (verb, schema) in &verbs {
                    let (code, out, err) = run(&[verb], "json");
                    assert!(code == 0 || code == 2, "{code}\n{text}");
                    if code == 2 {
                        refused += 1;
                        assert!(!err.is_empty(), "{text}");
                        continue;
                    }
                    let sound = keeps_to(schema, &out).and_then(|()| {
                        let (code, out, _) = run(&[verb], "text");
                        if code == 0 { not_a_number(&out) } else { Err(format!("text: {code}")) }
                    });
                    sound.unwrap_or_else(|e| panic!("{verb}: {e}\n{text}"));
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
    println!("{valid} valid, {invalid} invalid; {refused} runs of valid scenes refused");
    assert!(valid * 20 > count && invalid * 20 > count, "{valid} valid, {invalid} invalid");
}

#[test]
fn five_hundred_mutated_scenes() {
    mutated_through_cheap_verbs(500, 58);
}

#[test]
#[ignore = "ten minutes: cargo test --release --test all mutated -- --ignored"]
fn a_hundred_thousand_mutated_scenes() {
    mutated_through_cheap_verbs(100_000, 2026);
}

/// Seconds of processor time and KiB of address space of one run of an expensive verb.
const MOST_SECONDS: u64 = 60;
const MOST_KIB: u64 = 4 << 20;

/// Two hundred valid mutated scenes with coarse meshes through every expensive verb, in processes of their own that
/// may take 4 GiB and 60 s: each ends with 0, or with 2 and a message. Every fourth scene's tables are read too.
/// `MUTATED_SCENES=100..138` runs a part of them: the scenes are the same, whatever is run.
#[test]
#[ignore = "an hour: cargo test --release --test all mutated -- --ignored"]
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
    let part = part_of_scenes(scenes.len());
    let mut runs = Vec::new();
    for (i, (name, text)) in scenes.iter().enumerate().filter(|(i, _)| part.contains(i)) {
        for verb in verbs(name, text) {
            runs.push(Run::of(name, &verb, "json"));
            if i % 4 == 0 {
                runs.push(Run::of(name, &verb, "text"));
            }
        }
        let faults = runs.iter().filter(|run| run.fault.is_some()).count();
        println!("scene {i}: {} runs so far, {faults} with faults", runs.len());
    }
    let faults: Vec<&Run> = runs.iter().filter(|run| run.fault.is_some()).collect();
    let most = |of: fn(&Run) -> f64| runs.iter().map(of).fold(0.0, f64::max);
    println!(
        "{} runs, {} of them refused; at most {:.0} MiB and {:.1} s of processor time",
        runs.len(),
        runs.iter().filter(|run| run.code == Some(2)).count(),
        most(|run| run.kib as f64) / 1024.0,
        most(|run| run.seconds)
    );
    for run in &faults {
        let text = std::fs::read_to_string(&run.scene).unwrap();
        println!("{}\n{}\n{text}", run.line, run.fault.as_deref().unwrap_or_default());
    }
    assert!(faults.is_empty(), "{} runs with faults", faults.len());
}

/// Which scenes to run: `MUTATED_SCENES` as first..end, or all.
fn part_of_scenes(count: usize) -> std::ops::Range<usize> {
    let Ok(part) = std::env::var("MUTATED_SCENES") else { return 0..count };
    let ends = part.split_once("..").map(|(first, end)| (first.parse(), end.parse()));
    let Some((Ok(first), Ok(end))) = ends else { panic!("MUTATED_SCENES={part}: not first..end") };
    assert!(first < end && end <= count, "MUTATED_SCENES={part}: not within 0..{count}");
    first..end
}

/// The expensive verbs for a scene, each with the name of its schema.
fn verbs(name: &str, text: &str) -> [(&'static str, String); 4] {
    let pair = text.contains("kind = \"gear_pair\"");
    let load = if pair { "--normal-force-n 3000" } else { "" };
    let speeds = "--speeds-rpm 800:800:1 --tolerance 1e-3 --between-cycles 0 --most-cycles 20";
    [
        ("mesh", format!("mesh {name}")),
        (
            if pair { "static_pair" } else { "static_set" },
            format!("static {name} --positions 2 {load}"),
        ),
        ("impulse", format!("impulse {name} --duration-ms 10")),
        ("sweep", format!("sweep {name} {speeds}")),
    ]
}

/// One run of an expensive verb in a process of its own.
struct Run {
    scene: String,
    line: String,
    code: Option<i32>,
    /// Largest resident memory, KiB.
    kib: u64,
    /// Processor time, s.
    seconds: f64,
    /// What is wrong with how it ended or with what it printed.
    fault: Option<String>,
}

impl Run {
    fn of(scene: &str, (verb, line): &(&str, String), format: &str) -> Self {
        let [out, err] = ["out", "err"].map(|end| format!("{scene}.{end}"));
        let program = env!("CARGO_BIN_EXE_epicyclic");
        let limited = format!(
            "ulimit -v {MOST_KIB} -t {MOST_SECONDS}; exec {program} {line} --format {format} >{out} 2>{err}"
        );
        let mut child = std::process::Command::new("bash").args(["-c", &limited]).spawn().unwrap();
        let (mut kib, mut ticks) = (0, 0);
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            (kib, ticks) = usage(child.id()).unwrap_or((kib, ticks));
            std::thread::sleep(std::time::Duration::from_millis(5));
        };
        let (out, err) = (std::fs::read(out).unwrap(), std::fs::read_to_string(err).unwrap());
        let fault = match status.code() {
            Some(0) if format == "json" => keeps_to(&schema(verb), &out).err(),
            Some(0) => not_a_number(&out).err(),
            Some(2) if !err.is_empty() && !err.contains("panicked") => None,
            other => Some(format!("ended with {other:?} ({status}): {err}")),
        };
        // Linux counts a hundred ticks a second.
        let (seconds, line) = (ticks as f64 / 100.0, line.clone());
        Self { scene: scene.to_owned(), line, code: status.code(), kib, seconds, fault }
    }
}

/// Largest resident memory (KiB) and processor time (ticks) of a process so far.
fn usage(process: u32) -> Option<(u64, u64)> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib = peak.trim().strip_suffix(" kB")?.parse().ok()?;
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // Fields 14 and 15 of proc(5); the second, in brackets, may have spaces.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    Some((kib, fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?))
}
