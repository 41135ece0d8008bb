//! What a verb is doing is shown on a terminal, and elsewhere every ten seconds.

use std::process::{Command, Output};

use crate::harness::{coarse, scene};

/// Runs its arguments with a terminal of 24 lines of 100 columns as standard error; what the terminal was sent goes to
/// standard error, so that both can be read apart.
const ON_A_TERMINAL: &str = r#"
import fcntl, os, pty, struct, subprocess, sys, termios
ours, theirs = pty.openpty()
fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
child = subprocess.Popen(sys.argv[1:], stderr=theirs, env=dict(os.environ, TERM="xterm"))
os.close(theirs)
while True:
    try:
        sent = os.read(ours, 65536)
    except OSError:  # the other end is closed
        break
    if not sent:
        break
    sys.stderr.buffer.write(sent)
sys.stderr.buffer.flush()
sys.exit(child.wait())
"#;

fn written(output: &Output) -> [String; 2] {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8(bytes.clone()).unwrap())
}

/// Standard output and error of the program, on a terminal and off it.
fn both(line: &str) -> [[String; 2]; 2] {
    let binary = env!("CARGO_BIN_EXE_epicyclic");
    let words: Vec<&str> = line.split(' ').collect();
    let on = Command::new("python3").args(["-c", ON_A_TERMINAL, binary]).args(&words).output();
    let on = on.expect("python3, which opens the terminal of this test");
    let off = Command::new(binary).args(&words).output().unwrap();
    [written(&on), written(&off)]
}

/// Each verb that takes more than a moment says what it is doing, removes it at the end, and prints the same result
/// with or without a terminal; off a terminal standard error has the lines of `validate` and one every ten seconds.
#[test]
fn verbs_show_what_they_do_on_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let plain = coarse(folder.path(), "oh58_4p.toml");
    let pair = scene("oh58_sun_planet_pair.toml");
    for (line, shown) in [
        (format!("mesh {plain}"), "meshing and factorising the bodies"),
        (format!("static {plain} --positions 2"), "meshing the bodies and solving the positions"),
        (
            format!("static {pair} --normal-force-n 1e4 --positions 8"),
            "meshing the bodies and solving the positions",
        ),
        (format!("impulse {plain} --duration-ms 10"), "meshing and factorising the bodies"),
        (format!("impulse {plain} --duration-ms 10"), "marching the free decays"),
        (
            format!("sweep {plain} --speeds-rpm 800:840:10 --model lumped --tolerance 1e-3"),
            "meshing the bodies and laying out tables",
        ),
        (
            format!("sweep {plain} --speeds-rpm 800:840:10 --model lumped --tolerance 1e-3"),
            "5 speeds",
        ),
        (format!("branches {plain} --speeds-rpm 990:1000 --model lumped"), "following the branch"),
        ("stability bouncing-bar".to_owned(), "computing the map"),
        ("validate --only table1.".to_owned(), "table1"),
    ] {
        let [[out, told], [plain_out, plain_told]] = both(&line);
        assert!(told.contains(shown), "{line}: {told:?}");
        assert!(!plain_told.contains('\u{1b}'), "{line}: {plain_told:?}");
        if line.starts_with("validate") {
            assert!(plain_told.lines().all(|l| l.contains(" checks, ")), "{line}: {plain_told:?}");
            continue;
        }
        // Off a terminal nothing within ten seconds, then a line.
        let is_late = |l: &str| {
            let seconds = l.rsplit_once(", ").and_then(|(_, end)| end.strip_suffix(" s"));
            seconds.is_some_and(|s| s.parse::<u64>().is_ok_and(|s| s >= 10))
                || l.ends_with(" to go")
        };
        assert!(plain_told.lines().all(is_late), "{line}: {plain_told:?}");
        assert_eq!(plain_out, out, "{line}");
        // The last thing that the terminal gets is an erased line.
        let last = told.rsplit('\r').next().unwrap();
        assert!(last.contains("\u{1b}[2K") && !last.contains(shown), "{line}: {last:?}");
    }
}
