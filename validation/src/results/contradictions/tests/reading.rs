//! What is misspelt or broken is told by the reader, before any contradiction.

use super::{SCENE, bare, cycle, modes, refusal, states};
use crate::results::ResultsFolder;

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
