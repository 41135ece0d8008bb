//! The page of all keys.

use std::fmt::Write as _;

use crate::keys::{KEYS, KeyKind, Presence, SceneKey};

/// The page of all keys in Markdown, one section for each table.
pub fn scene_key_page() -> String {
    let mut text = String::from(HEAD);
    let tables =
        [""].into_iter().chain(KEYS.iter().filter(|k| k.is_table()).map(|k| k.path.as_str()));
    for table in tables {
        let own: Vec<&SceneKey> =
            KEYS.iter().filter(|k| !k.is_table() && k.table_and_name().0 == table).collect();
        if own.is_empty() && table.is_empty() {
            continue;
        }
        // Writing to a string cannot fail.
        let _ = match KEYS.iter().find(|k| k.path == table) {
            None => writeln!(text, "\n## Top of the file\n"),
            Some(k) => {
                let name = if k.kind == KeyKind::Tables {
                    format!("[[{table}]]")
                } else {
                    format!("[{table}]")
                };
                writeln!(text, "\n## {name}\n\n{}. {}.\n", capital(&k.meaning), left_out(k))
            }
        };
        if own.is_empty() {
            continue;
        }
        text.push_str("| key | unit | allowed | left out | meaning | needed by | changes |\n|---|---|---|---|---|---|---|\n");
        for key in own {
            let name = key.table_and_name().1;
            let _ = writeln!(
                text,
                "| `{name}` | {} | {} | {} | {} | {} | {} |",
                key.unit,
                key.kind.words(),
                left_out(key),
                key.meaning,
                key.needed_by,
                key.changes
            );
        }
    }
    text
}

fn left_out(key: &SceneKey) -> String {
    match key.presence {
        Presence::Required => "must be there".into(),
        Presence::Default(value) => value.into(),
        Presence::Optional(otherwise) => {
            if key.is_table() {
                format!("Left out: {otherwise}")
            } else {
                otherwise.into()
            }
        }
    }
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}

const HEAD: &str = "\
# Keys of a scene file

A scene is a TOML file. Lengths are in mm, angles in degrees, everything else in SI units; the unit is part of each key.
`epicyclic scene new FILE` writes a commented scene, `epicyclic scene check FILE` lists every fault of a file or what
follows from it, and what each verb still lacks.

This page and the JSON schema come from one list in the program (`scene/src/keys/list.rs`). `epicyclic scene schema`
prints the schema. Written beside a scene, with

```sh
epicyclic scene schema > scene.schema.json
```

it is found without a network through the first line of the scene, which the template has:

```toml
#:schema ./scene.schema.json
```

Editors that use taplo (VS Code with Even Better TOML, Helix, Neovim, Zed) then complete the keys and underline misspelt
ones and wrong types; `taplo check scene.toml` does so in a shell. In this repository the same schema is
`schemas/scene.json`.

`[lumped]` is optional. FE/contact needs nothing of it but the carrier's mass where `[geometry.carrier]` is left out.
Without it, or with `from = \"geometry\"` alone in it, `epicyclic modes` and `epicyclic compare` take masses, inertias and
stiffnesses of a planetary set from its geometry in closed form (`docs/closed_forms.md`); `epicyclic modes --parameters`
prints them as this table. `epicyclic mesh` prints masses and moments of inertia of the meshed bodies, and
`epicyclic static` the mean mesh stiffnesses.

A key *needed by* a verb must be there for it to run, as far as the column *left out* says so; `–` is a key that is never
needed. *Changes* names the verbs whose results another value of the key changes, of some set and at some fidelity: this is
measured (`checks/keys_used.py`). `compare` uses what `modes` uses. `scene check` lists the keys of a scene that are idle:
no verb that runs on it uses them.
";
