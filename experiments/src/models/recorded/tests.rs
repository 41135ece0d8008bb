//! Tables written, read back and refused.

use super::*;

fn record() -> Recorded {
    let mode =
        |frequency_hz, mode_type| ("a set".to_owned(), NaturalMode { frequency_hz, mode_type });
    let rest = |position: f64| RestState {
        position,
        sun: [1e-6, -2e-6, 3e-5 + position],
        sun_mesh_n: vec![100.25, 99.0],
        ring_mesh_n: vec![98.0, 97.0],
    };
    let line = |harmonic| Line {
        part: Part::SunMesh(1),
        coordinate: Coordinate::Force,
        harmonic,
        amplitude: 0.1 * harmonic as f64,
        phase_rad: -1.0,
    };
    let state = |rpm: f64| SteadyState {
        case: LoadCase::turning(1130.0, rpm, 0.35 * rpm),
        lines: vec![line(0), line(3)],
    };
    let cycle = MeshCycle {
        case: LoadCase::standing(1130.0),
        states: vec![rest(0.0), rest(0.25), rest(0.5), rest(0.75)],
    };
    Recorded {
        modes: vec![mode(770.0, ModeType::Translational), mode(1156.5, ModeType::Rotational)],
        mesh_cycles: vec![("a set".into(), cycle)],
        steady_states: vec![("a set".into(), state(500.0)), ("a set".into(), state(510.0))],
    }
}

#[test]
fn what_is_written_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    record().write(folder.path()).unwrap();
    assert_eq!(Recorded::read(folder.path()).unwrap(), record());
}

#[test]
fn bad_tables_are_refused_with_file_column_and_what_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = || Recorded::read(folder.path()).unwrap_err().to_string();
    assert!(refusal().contains("modes.csv"));
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("modes.csv", "scene,frequency_hz,mode_type\na,100,sideways\n");
    assert!(refusal().contains("sideways") && refusal().contains("rotational"));
    write("modes.csv", "scene,frequency_hz,mode_type\na,fast,planet\n");
    assert!(refusal().contains("modes.csv") && refusal().contains("line: 2"), "{}", refusal());
    for (row, column) in
        [("a,NaN,planet,1", "frequency_hz"), ("a,9,planet,18446744073709551615", "multiplicity")]
    {
        write("modes.csv", &format!("scene,frequency_hz,mode_type,multiplicity\n{row}\n"));
        assert!(refusal().contains(column), "{}", refusal());
    }
    write("modes.csv", "scene,frequency_hz,mode_type\na,100,planet\n");
    for (row, column) in [
        ("a,1,0,sun_mesh_99999999999,force,1", "body"),
        ("a,1,0,moon,force,1", "body"),
        ("a,1,inf,sun,x,1", "position"),
        ("a,1,0,sun,x,NaN", "value"),
    ] {
        let header = "scene,sun_torque_nm,position,body,coordinate,value";
        write("mesh_cycle.csv", &format!("{header}\n{row}\n"));
        assert!(refusal().contains(column), "{}", refusal());
    }
    write("mesh_cycle.csv", "scene,sun_torque_nm,position,body,coordinate,value\na,1,0,sun,x,1\n");
    write("steady_states.csv", "scene,sun_torque_nm\na,1\n");
    assert!(refusal().contains("steady_states.csv"), "{}", refusal());
}
