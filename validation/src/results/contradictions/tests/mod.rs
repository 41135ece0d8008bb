//! Each contradiction with its message, in tables that are right but for it.

use std::fmt::Write;
use std::path::Path;

use crate::results::ResultsFolder;

mod kinds;
mod reading;
mod stiffness_and_peaks;

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
