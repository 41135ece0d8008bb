//! Lists the files of the data folders for `src/lib.rs`.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

const FOLDERS: [&str; 7] =
    ["scenes", "reference", "checks", "dataset", "kept", "kept/studies", "kept/stability"];

fn main() -> Result<(), Box<dyn Error>> {
    let root = env::var("CARGO_MANIFEST_DIR")?;
    let mut list = String::from("&[\n");
    for folder in FOLDERS {
        let path = Path::new(&root).join(folder);
        println!("cargo::rerun-if-changed={}", path.display());
        let mut files =
            fs::read_dir(path)?.map(|e| e.map(|e| e.path())).collect::<Result<Vec<_>, _>>()?;
        files.retain(|file| match file.extension().and_then(|end| end.to_str()) {
            Some("toml" | "json") => true,
            Some("csv") => folder == "dataset",
            _ => false,
        });
        files.sort();
        for file in files {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            writeln!(list, "({:?}, include_str!({file:?})),", format!("{folder}/{name}"))?;
        }
    }
    list.push(']');
    fs::write(Path::new(&env::var("OUT_DIR")?).join("files.rs"), list)?;
    Ok(())
}
