//! `results.toml`: where results come from and how their numbers are to be read.
//!
//! ```toml
//! format = 1                      # of the folder; required
//! kind = "lumped"                 # or "fe_contact", "torsional", "measured"; required
//! program = "my_model"
//! version = "2.3"
//! scene = "oh58_4p"               # where tables have no column `scene`
//! held = ["ring"]                 # members held in the model, also where the scene lets them move
//! positions = 28                  # in a mesh cycle
//!
//! [convention]                    # of vectors and matrices; these are the defaults
//! order = ["carrier", "ring", "sun", "planets"]
//! planets = "radial_tangential"   # translations of planets; or "x_y"
//! rotation = "arc"                # u = r θ; or "angle", θ
//! radius = "base"                 # r of u = r θ; or "pitch"
//! sense = "counter_clockwise"     # positive rotation; or "clockwise"
//! ```

use std::path::Path;

use gearset::Member;
use scene::read_text;
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::convention::{Convention, ORDER};
use super::error::ManifestError;
use crate::model_kind::ModelKind;
use crate::nearest::did_you_mean;

/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// Positions of a mesh cycle that the suites ask for.
pub(in crate::results) const POSITIONS: usize = 28;

/// What `results.toml` says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Manifest {
    /// Kind of model; `None` where the folder has no `results.toml`.
    pub kind: Option<ModelKind>,
    /// The program that computed the results.
    pub program: Option<String>,
    /// Its version.
    pub version: Option<String>,
    /// Id, file or title of the scene of all tables without a column `scene`.
    pub scene: Option<String>,
    /// Members that neither move nor turn in the model, beside those that the scene holds.
    pub held: Vec<Member>,
    /// Positions in a mesh cycle at least, which are 28 if not given.
    pub positions: usize,
    /// How vectors and matrices are to be read.
    pub convention: Convention,
}

impl Default for Manifest {
    fn default() -> Self {
        Self {
            kind: None,
            program: None,
            version: None,
            scene: None,
            held: Vec::new(),
            positions: POSITIONS,
            convention: Convention::default(),
        }
    }
}

impl Manifest {
    /// Reads the file.
    ///
    /// # Errors
    /// [`ManifestError`] with the first fault: file, line, key and what is allowed.
    pub fn read(path: &Path) -> Result<Self, ManifestError> {
        let text = read_text(path, MOST_BYTES)
            .map_err(|source| ManifestError::Unreadable { path: path.to_owned(), source })?;
        Self::parse(path, &text)
    }

    /// The same of a text; `path` is named in messages.
    ///
    /// # Errors
    /// As [`Manifest::read`].
    pub fn parse(path: &Path, text: &str) -> Result<Self, ManifestError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let root = DeTable::parse(text).map_err(|error| ManifestError::Syntax {
            path: path.to_owned(),
            line: line_of(text, error.span().map_or(0, |span| span.start)),
            reason: error.message().replace('\n', "; "),
        })?;
        let file = Keys { path, text, table: "", entries: root.get_ref() };
        file.refuse_others(&[
            "format",
            "kind",
            "program",
            "version",
            "scene",
            "held",
            "positions",
            "convention",
        ])?;
        let format = file.count("format", 1, 1)?;
        if format.is_none() {
            return Err(file.fault("format", 0, "is absent: allowed is 1".to_owned()));
        }
        let kinds = ModelKind::ALL.map(ModelKind::name);
        let kind = file.choice("kind", &kinds)?;
        if kind.is_none() {
            return Err(file.fault(
                "kind",
                0,
                format!("is absent: allowed is {}", kinds.join(", ")),
            ));
        }
        Ok(Self {
            kind,
            program: file.text("program")?,
            version: file.text("version")?,
            scene: file.text("scene")?,
            held: file.choices("held", &["sun", "ring", "carrier"])?,
            positions: file.count("positions", 1, 100_000)?.unwrap_or(POSITIONS),
            convention: file.convention()?,
        })
    }
}

/// The keys of one table of the file.
struct Keys<'d> {
    path: &'d Path,
    text: &'d str,
    /// Name of the table; empty for the file itself.
    table: &'static str,
    entries: &'d DeTable<'d>,
}

impl<'d> Keys<'d> {
    fn convention(&self) -> Result<Convention, ManifestError> {
        let Some(value) = self.value("convention") else { return Ok(Convention::default()) };
        let Some(entries) = value.get_ref().as_table() else {
            let fault = "must be a table: [convention]".to_owned();
            return Err(self.fault("convention", value.span().start, fault));
        };
        let table = Keys { table: "convention.", entries, ..*self };
        table.refuse_others(&["order", "planets", "rotation", "radius", "sense"])?;
        let standard = Convention::default();
        let order: Vec<String> = table.choices("order", &ORDER)?;
        let is_whole = ORDER.iter().all(|body| order.iter().filter(|o| o == body).count() == 1);
        if !order.is_empty() && !is_whole {
            let at = table.value("order").map_or(0, |value| value.span().start);
            let fault = format!("must name each of {} once", ORDER.join(", "));
            return Err(table.fault("order", at, fault));
        }
        Ok(Convention {
            order: if order.is_empty() { standard.order } else { order },
            planets: table
                .choice("planets", &["radial_tangential", "x_y"])?
                .unwrap_or(standard.planets),
            rotation: table.choice("rotation", &["arc", "angle"])?.unwrap_or(standard.rotation),
            radius: table.choice("radius", &["base", "pitch"])?.unwrap_or(standard.radius),
            sense: table
                .choice("sense", &["counter_clockwise", "clockwise"])?
                .unwrap_or(standard.sense),
        })
    }

    fn value(&self, key: &str) -> Option<&'d Spanned<DeValue<'d>>> {
        let mut entries = self.entries.iter();
        entries.find(|(name, _)| name.get_ref() == key).map(|(_, value)| value)
    }

    fn fault(&self, key: &str, at: usize, fault: String) -> ManifestError {
        let (path, line) = (self.path.to_owned(), line_of(self.text, at));
        let shown = key.chars().map(|c| if c.is_control() { '?' } else { c });
        let key = shown.fold(self.table.to_owned(), |name, c| name + c.encode_utf8(&mut [0; 4]));
        ManifestError::Key { path, line, key, fault }
    }

    fn refuse_others(&self, known: &[&str]) -> Result<(), ManifestError> {
        let strange =
            |(name, _): &(&Spanned<_>, &_)| !known.contains(&AsRef::<str>::as_ref(name.get_ref()));
        let Some((name, _)) = self.entries.iter().find(strange) else { return Ok(()) };
        let hint = did_you_mean(name.get_ref(), known.iter().copied());
        let fault = format!("is not known: allowed is {}{hint}", known.join(", "));
        Err(self.fault(name.get_ref(), name.span().start, fault))
    }

    fn text(&self, key: &str) -> Result<Option<String>, ManifestError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match value.get_ref().as_str() {
            Some(text) if !text.trim().is_empty() => Ok(Some(text.trim().to_owned())),
            _ => Err(self.fault(key, value.span().start, "must be a text in quotes".to_owned())),
        }
    }

    fn count(&self, key: &str, least: usize, most: usize) -> Result<Option<usize>, ManifestError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let number = value.get_ref().as_integer();
        let number = number
            .and_then(|n| usize::from_str_radix(&n.as_str().replace('_', ""), n.radix()).ok());
        let number = number.filter(|n| (least..=most).contains(n)).ok_or_else(|| {
            let range = if least == most {
                format!("{least}")
            } else {
                format!("a whole number from {least} to {most}")
            };
            self.fault(key, value.span().start, format!("must be {range}"))
        })?;
        Ok(Some(number))
    }

    /// One of the words.
    fn choice<T: DeserializeOwned>(
        &self,
        key: &str,
        words: &[&str],
    ) -> Result<Option<T>, ManifestError> {
        self.value(key).map(|value| self.word(key, value, words)).transpose()
    }

    /// A list of the words.
    fn choices<T: DeserializeOwned>(
        &self,
        key: &str,
        words: &[&str],
    ) -> Result<Vec<T>, ManifestError> {
        let Some(value) = self.value(key) else { return Ok(Vec::new()) };
        let Some(list) = value.get_ref().as_array() else {
            let fault = format!("must be a list of {}", words.join(", "));
            return Err(self.fault(key, value.span().start, fault));
        };
        list.iter().map(|word| self.word(key, word, words)).collect()
    }

    fn word<T: DeserializeOwned>(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        words: &[&str],
    ) -> Result<T, ManifestError> {
        let given = value.get_ref().as_str().unwrap_or("no text");
        let known = words.iter().find(|word| word.eq_ignore_ascii_case(given));
        let read = known.and_then(|word| {
            use serde::de::IntoDeserializer;
            use serde::de::value::Error;
            T::deserialize(IntoDeserializer::<Error>::into_deserializer(*word)).ok()
        });
        read.ok_or_else(|| {
            let hint = did_you_mean(given, words.iter().copied());
            let fault =
                format!("is `{}`: allowed is {}{hint}", given.escape_debug(), words.join(", "));
            self.fault(key, value.span().start, fault)
        })
    }
}

/// The line, from 1, that holds byte `at`.
pub(super) fn line_of(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        Manifest::parse("results.toml".as_ref(), text).unwrap_err().to_string()
    }

    #[test]
    fn the_example_of_the_page_says_the_defaults() {
        let head = include_str!("file.rs").lines().take_while(|line| line.starts_with("//!"));
        let example: Vec<&str> = head.map(|line| line.trim_start_matches("//!").trim()).collect();
        let example = example.join("\n");
        let example = example.split("```").nth(1).unwrap().trim_start_matches("toml");
        let read = Manifest::parse("results.toml".as_ref(), example).unwrap();
        assert_eq!(read.convention, Convention::default());
        assert_eq!((read.positions, read.kind), (POSITIONS, Some(ModelKind::Lumped)));
        assert_eq!(read.held, [Member::Ring]);
        assert_eq!(read.scene.as_deref(), Some("oh58_4p"));
        let short = Manifest::parse("results.toml".as_ref(), "format = 1\nkind = \"measured\"\n");
        assert_eq!(
            short.unwrap(),
            Manifest { kind: Some(ModelKind::Measured), ..Manifest::default() }
        );
    }

    #[test]
    fn faults_name_line_key_and_remedy() {
        for (text, message) in [
            ("", "results.toml:1: `format` is absent: allowed is 1"),
            ("format = 2", "results.toml:1: `format` must be 1"),
            (
                "format = 1",
                "results.toml:1: `kind` is absent: allowed is lumped, fe_contact, torsional, measured",
            ),
            (
                "format = 1\nkind = \"lumpd\"",
                "results.toml:2: `kind` is `lumpd`: allowed is lumped, fe_contact, torsional, measured; did you mean `lumped`?",
            ),
            (
                "format = 1\nkind = \"lumped\"\nprogramm = \"x\"",
                "results.toml:3: `programm` is not known: allowed is format, kind, program, version, scene, held, positions, convention; did you mean `program`?",
            ),
            (
                "format = 1\nkind = \"lumped\"\n[convention]\nplanets = 3",
                "results.toml:4: `convention.planets` is `no text`: allowed is radial_tangential, x_y",
            ),
            (
                "format = 1\nkind = \"lumped\"\n[convention]\norder = [\"sun\", \"sun\"]",
                "results.toml:4: `convention.order` must name each of carrier, ring, sun, planets once",
            ),
        ] {
            assert_eq!(refusal(text), message);
        }
        assert!(refusal("format = 1\nkind = ").starts_with("results.toml:2: is no TOML: "));
    }
}
