//! Each contradiction with its message, in tables that are right but for it.

use std::fmt::Write;
use std::path::Path;

use crate::results::ResultsFolder;

/// Base radius of the sun of `oh58_4p`, m: 27/35 of that of the planets.
const RADIUS: f64 = 0.5 * 0.09126 * 27.0 / 35.0;

const SCENE: &str = "Army OH-58 main rotor reduction, four planets";

const POSITIONS: usize = 28;

/// What a folder with one table says against itself, with file names alone.
fn found(name: &str, table: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), table).unwrap();
    let manifest = "format = 1\nkind = \"lumped\"\n";
    std::fs::write(folder.path().join("results.toml"), manifest).unwrap();
    let read = ResultsFolder::read(folder.path()).unwrap();
    read.contradictions(None).iter().map(|found| bare(&found.to_string(), folder.path())).collect()
}

/// Why a folder with one table is refused.
fn refusal(name: &str, table: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), table).unwrap();
    bare(&ResultsFolder::read(folder.path()).unwrap_err().to_string(), folder.path())
}

fn bare(message: &str, folder: &Path) -> String {
    message.replace(&format!("{}/", folder.display()), "")
}

/// A mesh cycle whose forces carry the torque; `value` may change a force of a planet.
fn cycle(positions: usize, value: impl Fn(usize, usize, f64) -> f64) -> String {
    let mut text = "scene,sun_torque_nm,position,body,coordinate,value\n".to_owned();
    for k in 0..positions {
        let position = k as f64 / POSITIONS as f64;
        for mesh in ["sun_mesh", "ring_mesh"] {
            for n in 0..4 {
                let share = 1413.0 / (4.0 * RADIUS);
                let phase = std::f64::consts::TAU * (position + 0.25 * n as f64);
                let force = value(k, n, share * (1.0 + 0.1 * phase.cos()));
                writeln!(text, "\"{SCENE}\",1413,{position},{mesh}_{n},force,{force}").unwrap();
            }
        }
    }
    text
}

/// One harmonic in a table of steady states.
struct Line {
    speed_rpm: f64,
    mesh_frequency_hz: f64,
    planet: usize,
    harmonic: i32,
    amplitude: f64,
    phase: f64,
}

/// Steady states whose mean forces carry the torque; `change` may change a line.
fn states(change: impl Fn(&mut Line)) -> String {
    let head = "scene,sun_torque_nm,speed_rpm,mesh_frequency_hz,body,coordinate,harmonic,amplitude,phase_rad\n";
    let mut text = head.to_owned();
    for speed_rpm in [500.0_f64, 600.0] {
        for planet in 0..4 {
            for harmonic in 0..5 {
                let mean = 1130.0 / (4.0 * RADIUS);
                let amplitude = mean / f64::powi(3.0, harmonic) * speed_rpm.powi(harmonic.min(1));
                let mut line = Line {
                    speed_rpm,
                    mesh_frequency_hz: 27.0 * 99.0 / 126.0 / 60.0 * speed_rpm,
                    planet,
                    harmonic,
                    amplitude: if harmonic == 0 { mean } else { 1e-3 * amplitude },
                    phase: if harmonic == 0 { 0.0 } else { 0.1 * (planet as f64) - 0.2 },
                };
                change(&mut line);
                let Line { speed_rpm, mesh_frequency_hz, planet, amplitude, phase, .. } = line;
                writeln!(
                    text,
                    "oh58_4p,1130,{speed_rpm},{mesh_frequency_hz},sun_mesh_{planet},force,{harmonic},{amplitude},{phase}"
                )
                .unwrap();
            }
        }
    }
    text
}

/// Some modes of the printed set of four planets, with a factor.
fn modes(unit: &str, factor: f64, times: usize) -> String {
    let mut text = format!("scene,frequency_{unit},mode_type,multiplicity\n");
    for (hz, mode_type, count) in [
        (727.27, "translational", 2),
        (1091.16, "translational", 2),
        (1536.54, "rotational", 1),
        (1970.59, "rotational", 1),
        (1892.82, "translational", 2),
    ] {
        for _ in 0..times {
            writeln!(text, "lin_parker_1999_4p,{},{mode_type},{count}", hz * factor).unwrap();
        }
    }
    text
}

#[test]
fn tables_that_are_right_have_none() {
    assert_eq!(found("mesh_cycle.csv", &cycle(POSITIONS, |_, _, force| force)), [""; 0]);
    assert_eq!(found("steady_states.csv", &states(|_| ())), [""; 0]);
    assert_eq!(found("modes.csv", &modes("hz", 1.0, 1)), [""; 0]);
    assert_eq!(found("modes.csv", &modes("khz", 1e-3, 1)), [""; 0]);
}

#[test]
fn positions_that_are_not_even_and_a_sun_that_turns_against_its_torque() {
    let head = "scene,sun_torque_nm,position,body,coordinate,value\n";
    let turned = |place: fn(f64) -> f64, turn: f64| {
        let mut text = head.to_owned();
        for k in 0..POSITIONS {
            let at = place(k as f64 / POSITIONS as f64);
            writeln!(text, "oh58_4p,1413,{at},sun,rotation,{}", turn * (1.0 + at)).unwrap();
        }
        found("mesh_cycle.csv", &text)
    };
    assert_eq!(turned(|at| at, 0.01), [""; 0]);
    // Rows of one position that differ in the last bits are rows of one position.
    assert_eq!(turned(|at| at + 1e-12, 0.01), [""; 0]);
    for (place, what) in [
        ((|at| 0.5 * at) as fn(f64) -> f64, "0.4821429 and 0 leave a gap"),
        (|at| at * 28.0 / 27.0, "1 and 0 are one position of the cycle"),
        (|at| at.powf(1.5), "leave a gap"),
    ] {
        let [one] = turned(place, 0.01).try_into().unwrap();
        let stated = one.contains("column `position`: positions are not even: ");
        assert!(stated && one.contains(what), "{one}");
    }
    assert_eq!(
        turned(|at| at, -0.01),
        [
            "mesh_cycle.csv:2 and mesh_cycle.csv:29: column `value`: the sun turns by -1.4821428571428572e-2 rad on average \
             under 1413 N·m, against its torque: give torque and rotation counter-clockwise positive, the rotation from the \
             unloaded place"
        ]
    );
}

#[test]
fn every_force_1_n_under_1413_nm() {
    assert_eq!(
        found("mesh_cycle.csv", &cycle(POSITIONS, |_, _, _| 1.0)),
        [
            "mesh_cycle.csv:6 and mesh_cycle.csv:9: column `value`: forces of the ring meshes times the base radius of the sun are 0.1408 \
          N·m at position 0, the torque is 1413.0000 N·m: give forces along the line of action in N, positive where \
          pressed, of every planet"
        ]
    );
}

#[test]
fn amplitudes_times_1e300() {
    assert_eq!(
        found("steady_states.csv", &states(|line| line.amplitude *= 1e300)),
        [
            "steady_states.csv:2 and steady_states.csv:41: column `amplitude`: force of sun_mesh_0 is 8.025503039748056e303 N, more than a \
          thousand times the torque over the base radius of the sun (40 rows of this size): give displacements in m, \
          rotations in rad, forces in N, or the unit in the title of the column"
        ]
    );
}

#[test]
fn every_mode_twice() {
    assert_eq!(
        found("modes.csv", &modes("hz", 1.0, 2)),
        [
            "modes.csv:2 and modes.csv:3: column `frequency_hz`: every mode is listed more than once, rotational modes are single, translational \
          ones pairs, planet modes N − 3 of a frequency: list each mode once; where two are as near as this, give more \
          digits"
        ]
    );
    let untyped = "scene,frequency_hz\noh58_4p,1\noh58_4p,1\noh58_4p,2\noh58_4p,2\n";
    assert_eq!(found("modes.csv", untyped).len(), 1);
}

#[test]
fn one_position_for_28() {
    assert_eq!(
        found("mesh_cycle.csv", &cycle(1, |_, _, force| force)),
        [
            "mesh_cycle.csv:2 and mesh_cycle.csv:9: column `position`: 1 position in the mesh cycle of `Army OH-58 main rotor reduction, four \
          planets` at 1413 N·m, 28 are asked for: give even positions over one cycle, or their number as `positions` in \
          results.toml"
        ]
    );
}

#[test]
fn phases_in_degrees() {
    let degrees = states(|line| {
        if line.harmonic > 0 {
            line.phase = 45.0 * line.planet as f64 + 10.0;
        }
    });
    assert_eq!(
        found("steady_states.csv", &degrees),
        [
            "steady_states.csv:3 and steady_states.csv:41: column `phase_rad`: phases beyond ±2π (32 rows, up to 145): degrees?: give them in \
          rad within ±2π, or call the column `phase_deg`"
        ]
    );
    assert_eq!(found("steady_states.csv", &degrees.replace("phase_rad", "phase_deg")), [""; 0]);
}

#[test]
fn mesh_frequency_minus_1() {
    assert_eq!(
        found("steady_states.csv", &states(|line| line.mesh_frequency_hz = -1.0)),
        [
            "steady_states.csv:2 and steady_states.csv:41: column `mesh_frequency_hz`: the mesh frequency is -1 Hz (40 rows so): give magnitudes above \
          0, and the sense of rotation as `sun_turns`"
        ]
    );
}

#[test]
fn all_rows_at_one_speed() {
    assert_eq!(
        found("steady_states.csv", &states(|line| line.speed_rpm = 500.0)),
        [
            "steady_states.csv:2 and steady_states.csv:22: column `speed_rpm`: all 40 rows are at 500 rpm, with several mesh frequencies: give \
          every row the speed that it was found at"
        ]
    );
    let one =
        |line: &mut Line| (line.speed_rpm, line.mesh_frequency_hz) = (500.0, 176.78571428571428);
    assert_eq!(
        found("steady_states.csv", &states(one)),
        [
            "steady_states.csv:2 and steady_states.csv:41: column `speed_rpm`: all 40 rows are at 500 rpm, with several numbers for one body, \
          coordinate and harmonic: give every row the speed that it was found at"
        ]
    );
}

#[test]
fn two_planets_merged() {
    let merge = |line: &mut Line| {
        if line.planet == 3 && line.harmonic > 0 {
            line.phase = 0.1 * 1.0 - 0.2;
        }
    };
    assert_eq!(
        found("steady_states.csv", &states(merge)),
        [
            "steady_states.csv:7 and steady_states.csv:17: columns `amplitude`, `phase_rad`: planets 1 and 3 have the same numbers in all 10 rows: give every \
          planet the numbers of its own place and phase"
        ]
    );
}

#[test]
fn khz_in_a_hz_column() {
    for (factor, by) in [(1e-3, "1000: kHz?"), (std::f64::consts::TAU, "1/2π: rad/s?")] {
        assert_eq!(
            found("modes.csv", &modes("hz", factor, 1)),
            [format!(
                "modes.csv:2 and modes.csv:6: column `frequency_hz`: frequencies of `Lin & Parker 1999 model set, four planets` as they stand are \
                 not those of the lumped model, all 5 agree after × {by}: give them in Hz, or call the column \
                 `frequency_khz` or `omega_rad_per_s`"
            )]
        );
    }
}

#[test]
fn rad_per_s_of_a_torsional_model() {
    // Lin & Parker's model set of four planets with every centre held.
    let manifest = "format = 1\nkind = \"torsional\"\nscene = \"lin_parker_1999_4p\"\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("results.toml"), manifest).unwrap();
    for (factor, said) in [(1.0, false), (std::f64::consts::TAU, true)] {
        let list = [2120.62, 6444.0, 6635.21, 12554.33].map(|hz: f64| format!("{}\n", factor * hz));
        let table = format!("frequency_hz\n{}", list.concat());
        std::fs::write(folder.path().join("modes.csv"), table).unwrap();
        let found = ResultsFolder::read(folder.path()).unwrap().contradictions(None);
        assert_eq!(found.len(), usize::from(said));
        assert!(found.iter().all(|f| f.to_string().contains("all 4 agree after × 1/2π: rad/s?")));
    }
}

#[test]
fn a_harmonic_of_a_scene_with_two_rules() {
    let table = "scene,harmonic,excites\noh58_4p,1,rotational\noh58_4p,1,none\n";
    assert_eq!(
        found("rules.csv", table),
        [
            "rules.csv:2 and rules.csv:3: column `excites`: different numbers for one harmonic of a scene (1 such pair): \
             keep the right row"
        ]
    );
}

fn validation_scene(id: &str) -> String {
    epicyclic_data::text(&format!("scenes/{id}.toml")).unwrap().to_owned()
}

#[test]
fn what_is_misspelt_is_recognised() {
    assert_eq!(
        refusal("modes.csv", "scene,frequency_hz,mode_type\noh58_4p,770,rotatonal\n"),
        "modes.csv:2: column `mode_type` is `rotatonal`: allowed is rotational, translational, planet, mixed; did you \
         mean `rotational`?"
    );
    let folder = tempfile::tempdir().unwrap();
    let table = "scene,frequency_hz,mode_tpye\noh58_4p,770,rotational\n";
    std::fs::write(folder.path().join("modes.csv"), table).unwrap();
    // A file of another program is kept aside, one that is meant to be a scene is refused.
    std::fs::write(folder.path().join("pyproject.toml"), "[project]\nname = \"x\"\n").unwrap();
    let read = ResultsFolder::read(folder.path()).unwrap();
    let remarks: Vec<String> =
        read.remarks.iter().map(|r| bare(&r.to_string(), folder.path())).collect();
    assert_eq!(
        remarks,
        [
            "pyproject.toml:1: kept aside: a scene has `title`, `kind` or `teeth`",
            "modes.csv:1: column `mode_tpye`: kept aside, asked for by no check; did you mean `mode_type`?",
        ]
    );
    std::fs::write(folder.path().join("mine.toml"), "title = \"x\"\n").unwrap();
    assert!(ResultsFolder::read(folder.path()).is_err());
    std::fs::remove_file(folder.path().join("mine.toml")).unwrap();
    std::fs::write(folder.path().join("mesh_cycles.csv"), "x\n").unwrap();
    let read = ResultsFolder::read(folder.path()).unwrap();
    let last = bare(&read.remarks.last().unwrap().to_string(), folder.path());
    let said =
        "mesh_cycles.csv:1: kept aside, no table is called so; did you mean `mesh_cycle.csv`?";
    assert_eq!(last, said);
    let other = validation_scene("oh58_4p").replace("count = 4", "count = 4 # changed");
    std::fs::write(folder.path().join("oh58_4p.toml"), &other).unwrap();
    assert!(ResultsFolder::read(folder.path()).is_ok());
    let other = other.replace("title = \"Army", "title = \"Mine, Army");
    std::fs::write(folder.path().join("oh58_4p.toml"), other).unwrap();
    let error = ResultsFolder::read(folder.path()).unwrap_err().to_string();
    let said = "oh58_4p.toml: is called as a shipped scene and is another: give the file a name of its own";
    assert_eq!(bare(&error, folder.path()), said);
    std::fs::create_dir(folder.path().join("results")).unwrap();
    let error = ResultsFolder::read(&folder.path().join("resluts")).unwrap_err().to_string();
    assert_eq!(
        bare(&error, folder.path()),
        "resluts: is no folder: allowed is a folder with tables, as `epicyclic results new` makes one; did you mean \
         `results`?"
    );
}

#[test]
fn titles_that_are_a_file_stem_or_misspelt() {
    let table = |name: &str| format!("scene;frequency_hz\n{name};770\n");
    for name in ["oh58_4p", "oh58_4p.toml", "scenes/oh58_4p.toml", SCENE] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("modes.csv"), table(name)).unwrap();
        assert_eq!(ResultsFolder::read(folder.path()).unwrap().modes[0].scene.scene.title, SCENE);
    }
    assert_eq!(
        refusal("modes.csv", &table("Army OH-58 main rotor reductoin, four planets")),
        "modes.csv:2: column `scene` is `Army OH-58 main rotor reductoin, four planets`: allowed is an id or a title of a \
         shipped scene, or a scene file in the folder; did you mean `Army OH-58 main rotor reduction, four planets`?"
    );
    assert_eq!(
        refusal("modes.csv", "frequency_hz\n770\n"),
        "modes.csv:2: column `scene` is empty: needed is an id, file or title of a scene, here or as `scene` in results.toml"
    );
}

#[test]
fn rows_twice_and_rows_that_contradict_each_other() {
    let right = cycle(POSITIONS, |_, _, force| force);
    let (head, row) = (right.lines().next().unwrap(), right.lines().nth(1).unwrap());
    assert_eq!(
        found("mesh_cycle.csv", &format!("{head}\n{row}\n{}", right.split_once('\n').unwrap().1)),
        [
            "mesh_cycle.csv:2 and mesh_cycle.csv:3: column `value`: one row twice (1 of 225 rows): write every row once"
        ]
    );
    let other = format!("{right}{}\n", row.replace("force,", "force,1"));
    assert_eq!(
        found("mesh_cycle.csv", &other),
        [
            "mesh_cycle.csv:2 and mesh_cycle.csv:226: column `value`: different numbers for one position, body and coordinate (1 such \
          pair): keep the right row"
        ]
    );
}

#[test]
fn speeds_planets_and_quantities_that_do_not_fit() {
    assert_eq!(
        found("steady_states.csv", &states(|line| line.mesh_frequency_hz *= 1.1)),
        [
            "steady_states.csv:2 and steady_states.csv:41: columns `mesh_frequency_hz`, `speed_rpm`: the mesh frequency is 194.46428571428575 Hz at 500 rpm, the teeth \
          of the scene make it 176.79 Hz (40 rows so): give the speed of the driven member of the scene, and Z_s |n_s − \
          n_c|/60 as mesh frequency"
        ]
    );
    assert_eq!(
        found("steady_states.csv", &states(|line| line.planet += 1)),
        [
            "steady_states.csv:17 and steady_states.csv:41: column `body`: `sun_mesh_4` in a set of 4 planets: number planets from 0 to 3"
        ]
    );
    let right = cycle(POSITIONS, |_, _, force| force);
    let lacking: Vec<&str> =
        right.lines().enumerate().filter(|(k, _)| *k != 9).map(|(_, l)| l).collect();
    assert_eq!(
        found("mesh_cycle.csv", &lacking.join("\n")),
        [
            "mesh_cycle.csv:2 and mesh_cycle.csv:10: column `position`: force of sun_mesh_0 is given at position 0 and not at \
             0.0357143: give every quantity at every position"
        ]
    );
}

#[test]
fn forces_of_meshes_whose_teeth_part_or_touch_behind_are_not_held_against_the_torque() {
    let heavy = states(|line| line.amplitude *= 1.2);
    assert_eq!(found("steady_states.csv", &heavy).len(), 1);
    for (coordinate, count) in [("contact_loss", 1), ("backside_contact", 0)] {
        let mut text = states(|line| line.amplitude *= 1.9);
        for speed in [500.0, 600.0] {
            let frequency = 27.0 * 99.0 / 126.0 / 60.0 * speed;
            writeln!(text, "oh58_4p,1130,{speed},{frequency},sun_mesh_0,{coordinate},0,0.1,0")
                .unwrap();
        }
        assert_eq!(found("steady_states.csv", &text).len(), count, "{coordinate}");
    }
}

/// Tables with changed, lost and repeated bytes are read, refused with file and line, or contradict themselves; none
/// ends the program.
#[test]
fn mutated_tables_are_read_or_refused_with_their_place() {
    let mut random = fastrand::Rng::with_seed(56);
    let tables = [
        ("modes.csv", modes("hz", 1.0, 1)),
        ("mesh_cycle.csv", cycle(2, |_, _, force| force)),
        ("steady_states.csv", states(|_| ())),
    ];
    let folder = tempfile::tempdir().unwrap();
    let manifest = "format = 1\nkind = \"lumped\"\nheld = [\"ring\"]\npositions = 2\n";
    let (mut read, mut refused) = (0, 0);
    for k in 0..600 {
        let (name, table) = &tables[k % tables.len()];
        let mut files = [(*name, table.clone().into_bytes()), ("results.toml", manifest.into())];
        let which = usize::from(k % 10 == 9);
        for _ in 0..random.usize(1..4) {
            let bytes = &mut files[which].1;
            let place = random.usize(0..bytes.len());
            let signs = b"0123456789.,;-+eE\"'#\n\r\t =[]NaN\xff\xe2";
            match random.u8(0..4) {
                0 => bytes[place] = signs[random.usize(0..signs.len())],
                1 => bytes.insert(place, signs[random.usize(0..signs.len())]),
                2 => {
                    bytes.remove(place);
                }
                _ => bytes.truncate(place.max(1)),
            }
        }
        for (name, bytes) in &files {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        match ResultsFolder::read(folder.path()) {
            Ok(results) => {
                read += 1;
                results.contradictions(None);
            }
            Err(error) => {
                refused += 1;
                let message = bare(&error.to_string(), folder.path());
                let names_file = message.starts_with(*name) || message.starts_with("results.toml");
                let is_whole = message.contains("no rows") || message.contains("cannot be read");
                let line = message.split(':').nth(1).and_then(|line| line.parse::<u64>().ok());
                assert!(names_file && (is_whole || line.is_some_and(|l| l > 0)), "{message}");
            }
        }
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    assert!(read > 50 && refused > 50, "{read} read, {refused} refused");
}

/// A change of the position and stiffness of row n.
type Change<'c> = &'c dyn Fn(usize, f64, f64) -> (f64, f64);

/// The sun mesh of planet 0 over its cycle, N/µm; `change` may change position or stiffness.
fn stiffness(change: impl Fn(usize, f64, f64) -> (f64, f64)) -> String {
    let mut text = "scene,sun_torque_nm,body,position,stiffness_n_per_um\n".to_owned();
    for k in 0..POSITIONS {
        let position = k as f64 / POSITIONS as f64;
        let (position, k) = change(k, position, 600.0 - 100.0 * position);
        writeln!(text, "oh58_3p,1130,sun_mesh_0,{position},{k}").unwrap();
    }
    text
}

#[test]
fn mesh_stiffness_that_no_mesh_cycle_has() {
    let found = |change: Change| found("mesh_stiffness.csv", &stiffness(change));
    assert_eq!(found(&|_, p, k| (p, k)), [""; 0]);
    // A constant stiffness is a model, not one half written twice.
    assert_eq!(found(&|_, p, _| (p, 500.0)), [""; 0]);
    let two = |n: usize, p: f64, _: f64| (p, 500.0 + (n % 14) as f64);
    for (change, message) in [
        (
            &(|n: usize, p: f64, k: f64| if n == 3 { (2.0 / 28.0, k) } else { (p, k) }) as Change,
            "mesh_stiffness.csv:4 and mesh_stiffness.csv:5: column `stiffness_n_per_m`: different numbers for one mesh and position (1 such pair): keep \
             the right row",
        ),
        (
            &|n: usize, p: f64, k: f64| if n == 14 { (p, -k) } else { (p, k) },
            "mesh_stiffness.csv:16: column `stiffness_n_per_m`: the stiffness of sun_mesh_0 is -550000000 N/m at position 0.5 (1 \
             row not above 0): give k = F/δ with the load F and the deflection δ both positive where flanks press",
        ),
        (
            &|_, p, k: f64| (p, 1e6 * k),
            "mesh_stiffness.csv:2 and mesh_stiffness.csv:29: column `stiffness_n_per_m`: the stiffness of sun_mesh_0 is 6e14 N/m, more than 1e12 N/m (28 \
             rows of this size): give N/m, or call the column `stiffness_n_per_um` or `stiffness_n_per_mm`",
        ),
        (
            &|_, p, k: f64| (p, 1e-6 * k),
            "mesh_stiffness.csv:2 and mesh_stiffness.csv:29: column `stiffness_n_per_m`: the stiffness of sun_mesh_0 is 6e2 N/m, with which the load of \
             one planet at 1130 N·m deflects the mesh by more than the base radius of the sun (28 rows of this size): give \
             N/m, or call the column `stiffness_n_per_um` or `stiffness_n_per_mm`",
        ),
        (
            &|n, _, k| (n as f64 / 27.0, k),
            "mesh_stiffness.csv:29 and mesh_stiffness.csv:2: column `position`: positions are not even: 1 and 0 are one position of the cycle: \
             give positions k/n, k from 0 to n − 1: without 1 where 0 is there",
        ),
        (
            &|_, p: f64, k| (0.5 * p, k),
            "mesh_stiffness.csv:29 and mesh_stiffness.csv:2: column `position`: positions are not even: 0.4821429 and 0 leave a gap: \
             give positions k/n, k from 0 to n − 1: without 1 where 0 is there",
        ),
        (
            &two,
            "mesh_stiffness.csv:2 and mesh_stiffness.csv:16: column `stiffness_n_per_m`: stiffnesses of sun_mesh_0 from position 0.5 on are those from \
             position 0 on: two mesh cycles?: give one mesh cycle, which is one base pitch of the sun, as positions 0 to 1",
        ),
    ] {
        assert_eq!(found(change), [message]);
    }
    let rows = stiffness(|_, p, k| (p, k));
    let few: String = rows.lines().take(6).map(|line| format!("{line}\n")).collect();
    assert_eq!(
        super::tests::found("mesh_stiffness.csv", &few),
        [
            "mesh_stiffness.csv:2 and mesh_stiffness.csv:6: column `position`: 5 positions of sun_mesh_0 in the mesh cycle of `Army OH-58 main \
             rotor reduction, three planets` at 1130 N·m, 28 are asked for: give even positions over one cycle, or their \
             number as `positions` in results.toml"
        ]
    );
    let refused = |from: &str, to: &str| refusal("mesh_stiffness.csv", &rows.replacen(from, to, 1));
    assert_eq!(
        refused("sun_mesh_0", "sun"),
        "mesh_stiffness.csv:2: column `body` is `sun`: allowed is a mesh: sun_mesh_0, ring_mesh_0 and so on"
    );
    assert!(refused("1130", "0").contains("a torque other than 0"));
}

#[test]
fn resonant_peaks_that_cannot_be() {
    let head = "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\n";
    let row = |torque: u32, body: &str, amplitude: f64| {
        format!("oh58_4p,{torque},{body},rotation,2,1150,{amplitude}\n")
    };
    let rows = |rows: &[String]| found("torque_peaks.csv", &format!("{head}{}", rows.concat()));
    let right = [row(565, "sun", 1e-4), row(1130, "sun", 2e-4)];
    assert_eq!(rows(&right), [""; 0]);
    let twice = [right[0].clone(), row(565, "sun", 2e-4), right[1].clone()];
    assert_eq!(
        rows(&twice),
        [
            "torque_peaks.csv:2 and torque_peaks.csv:3: column `amplitude`: different numbers for one torque, body, coordinate, harmonic and \
             frequency (1 such pair): keep the right row"
        ]
    );
    assert_eq!(
        rows(&[right[0].clone(), row(1130, "sun", -2e-4), row(1695, "sun", 0.0)]),
        [
            "torque_peaks.csv:3 and torque_peaks.csv:4: column `amplitude`: the amplitude of a peak is -0.0002 rad (2 rows not above 0): give \
             magnitudes above 0, and leave out peaks that are not there"
        ]
    );
    let huge = rows(&[right[0].clone(), row(1130, "sun", 100.0)]);
    assert!(
        huge[0].starts_with("torque_peaks.csv:3: column `amplitude`: rotation of sun is 1e2 rad"),
        "{huge:?}"
    );
    let merged: Vec<String> = [565, 1130, 1695]
        .iter()
        .flat_map(|torque| {
            ["planet_0", "planet_1"].map(|p| row(*torque, p, 1e-7 * f64::from(*torque)))
        })
        .collect();
    assert_eq!(
        rows(&merged),
        [
            "torque_peaks.csv:2 and torque_peaks.csv:3: column `amplitude`: planets 0 and 1 have the same numbers in all 3 rows: give every \
             planet the numbers of its own place and phase"
        ]
    );
    let beyond = rows(&[right[0].clone(), row(565, "planet_4", 1e-4)]);
    assert!(
        beyond[0]
            .starts_with("torque_peaks.csv:3: column `body`: `planet_4` in a set of 4 planets")
    );
}
