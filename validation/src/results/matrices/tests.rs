//! Matrices in both forms, and files refused.

use std::path::Path;

use lumped::nalgebra::DMatrix;

use super::{market, square};
use crate::results::ResultsFolder;

fn refusal(form: &str, text: &str) -> String {
    let read = match form {
        "mtx" => market::read("K.mtx".as_ref(), text),
        _ => square::read("K.csv".as_ref(), text),
    };
    read.unwrap_err().to_string()
}

#[test]
fn one_matrix_in_every_form_is_one_matrix() {
    let expected = DMatrix::from_row_slice(2, 2, &[4.5e6, -1.0, -1.0, 2.25]);
    for (text, line) in [
        (
            "%%MatrixMarket matrix coordinate real symmetric\n% a\n\n2 2 3\n1 1 4.5e6\n2 1 -1\n2 2 2.25\n",
            6,
        ),
        (
            "%%MatrixMarket  MATRIX coordinate real general\r\n2 2 4\r\n1 1 4.5D6\r\n2 2 2.25\r\n1 2 -1\r\n2 1 -1\r\n",
            6,
        ),
        ("%%matrixmarket matrix array real general\n2 2\n4.5e6\n-1\n-1\n2.25", 4),
        ("%%MatrixMarket matrix array real symmetric\n2 2\n4.5e6\n-1\n2.25\n", 4),
    ] {
        let read = market::read("K.mtx".as_ref(), text).unwrap();
        assert_eq!((&read.values, read.line(1, 0)), (&expected, line), "{text}");
    }
    for text in [
        "4.5e6,-1\n-1,2.25\n",
        "# K\n4500000,0;-1\n\n-1;2,25\n",
        "4.5e6  -1\n -1 2.25",
        "4.5e6\t-1\n-1\t2.25",
    ] {
        let read = square::read("K.csv".as_ref(), text).unwrap();
        assert_eq!(read.values, expected, "{text}");
    }
    // Half a unit of the seventh digit of the longest number.
    let read = square::read("K.csv".as_ref(), "1.234567e8,0\n0,1").unwrap();
    assert_eq!(read.rounding, 0.5e-6);
}

#[test]
fn refusals_name_file_line_and_remedy() {
    let head = "%%MatrixMarket matrix coordinate real general\n";
    for (form, text, message) in [
        (
            "mtx",
            "".to_owned(),
            "K.mtx:1: the first line is empty: allowed is %%MatrixMarket matrix coordinate|array real|integer general|symmetric",
        ),
        (
            "mtx",
            "%%MatrixMarket matrix coordinate complex hermitian\n1 1 1\n".to_owned(),
            "K.mtx:1: the first line is `%%MatrixMarket matrix coordinate complex hermitian`: allowed is %%MatrixMarket matrix coordinate|array real|integer general|symmetric",
        ),
        (
            "mtx",
            format!("{head}1000000000 1000000000 1\n"),
            "K.mtx:2: the size is `1000000000 × 1000000000`: allowed is as many columns as rows, 1 to 201",
        ),
        (
            "mtx",
            format!("{head}2 3 1\n1 1 1\n"),
            "K.mtx:2: the size is `2 × 3`: allowed is as many columns as rows, 1 to 201",
        ),
        (
            "mtx",
            format!("{head}2 2 99999999999999\n"),
            "K.mtx:2: the number of entries is `99999999999999`: allowed is at most 4 of 2 × 2",
        ),
        (
            "mtx",
            format!("{head}two\n"),
            "K.mtx:2: the line of sizes is `two`: allowed is rows, columns and number of entries",
        ),
        (
            "mtx",
            format!("{head}2 2 2\n1 1 1\n"),
            "K.mtx:3: the number of entries is `1`: allowed is 2 lines of entries, as line 2 says",
        ),
        (
            "mtx",
            format!("{head}2 2 1\n1 1 1\n2 2 1\n"),
            "K.mtx:4: a further line is `2 2 1`: allowed is none after the 1 of entries that line 2 says",
        ),
        (
            "mtx",
            format!("{head}2 2 1\n0 1 1\n"),
            "K.mtx:3: row of the entry is `0`: allowed is a whole number from 1 to 2",
        ),
        (
            "mtx",
            format!("{head}2 2 1\n1 3 1\n"),
            "K.mtx:3: column of the entry is `3`: allowed is a whole number from 1 to 2",
        ),
        (
            "mtx",
            format!("{head}2 2 1\n1 2 NaN\n"),
            "K.mtx:3: entry (1, 2) is `NaN`: allowed is a finite number",
        ),
        (
            "mtx",
            format!("{head}2 2 2\n1 2 1\n1 2 1\n"),
            "K.mtx:4: entry (1, 2) is `1`: allowed is once, and line 3 has it",
        ),
        (
            "csv",
            "\n".to_owned(),
            "K.csv:1: the table is empty: allowed is as many rows of numbers as columns",
        ),
        (
            "csv",
            "1,2\n".to_owned(),
            "K.csv:1: the size is `1 × 2`: allowed is as many columns as rows, 1 to 201",
        ),
        (
            "csv",
            "1,2\n3\n".to_owned(),
            "K.csv:2: the number of columns is `1`: allowed is 2, as line 1 has",
        ),
        (
            "csv",
            "1;2\n3;x\n".to_owned(),
            "K.csv:2: column 2 is `x`: allowed is a finite number, without titles of rows or columns",
        ),
        (
            "csv",
            "1,2\n3,\n".to_owned(),
            "K.csv:2: column 2 is empty: allowed is a finite number, without titles of rows or columns",
        ),
    ] {
        assert_eq!(refusal(form, &text), message);
    }
}

#[test]
fn names_of_files_are_a_letter_and_perhaps_a_scene() {
    let folder = |manifest: &str, names: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("matrices")).unwrap();
        for name in names {
            std::fs::write(folder.path().join("matrices").join(name), "1").unwrap();
        }
        let manifest = format!("format = 1\nkind = \"lumped\"\n{manifest}");
        std::fs::write(folder.path().join("results.toml"), manifest).unwrap();
        let read = ResultsFolder::read(folder.path());
        read.map_err(|error| bare(&error.to_string(), folder.path()))
    };
    let scene = "scene = \"oh58_4p\"\n";
    let read = folder(scene, &["M.mtx.csv", ".DS_Store"]).unwrap_err();
    assert!(read.starts_with("matrices/M.mtx.csv: no matrix is called so"), "{read}");
    let read = folder(scene, &["K.csv", "lin_parker_1999_3p.M.csv"]).unwrap();
    let ids: Vec<&str> = read.matrices.iter().map(|set| set.scene.id.as_str()).collect();
    assert_eq!(ids, ["oh58_4p", "lin_parker_1999_3p"]);
    for (manifest, names, message) in [
        (
            scene,
            ["K.txt"].as_slice(),
            "matrices/K.txt: no matrix is called so: allowed is M or K, or the id of a scene with .M or .K, each with .mtx or .csv; did you mean `K.mtx`?",
        ),
        (
            "",
            &["K.csv"],
            "matrices/K.csv: of which scene is not said: give `scene` in results.toml, or put its id before the name: ID.K.csv",
        ),
        (
            scene,
            &["oh85_4p.K.csv"],
            "matrices/oh85_4p.K.csv: the scene in the name is `oh85_4p`: allowed is an id or a title of a shipped scene, or a scene file in the folder; did you mean `oh58_4p`?",
        ),
        (
            scene,
            &["K.csv", "oh58_4p.K.csv"],
            "matrices/K.csv and matrices/oh58_4p.K.csv: two files of one matrix: keep one",
        ),
    ] {
        assert_eq!(folder(manifest, names).unwrap_err(), message);
    }
}

fn bare(message: &str, folder: &Path) -> String {
    message.replace(&format!("{}/", folder.display()), "")
}
