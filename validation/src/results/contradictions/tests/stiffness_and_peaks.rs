//! Mesh stiffness over the mesh cycle, and resonant peaks over torque.

use std::fmt::Write;

use super::{POSITIONS, found, refusal};

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
        super::found("mesh_stiffness.csv", &few),
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
