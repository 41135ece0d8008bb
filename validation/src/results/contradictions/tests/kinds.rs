//! Each kind of contradiction with its message.

use std::fmt::Write;

use super::{Line, POSITIONS, cycle, found, modes, states};
use crate::results::ResultsFolder;

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
