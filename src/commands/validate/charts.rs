//! Charts of the report: error against cost by every shipped study, and every stability map.

use std::io::Write as _;
use std::path::Path;

use experiments::stability::{MAPS, Map, MapError, StabilityMap, stability_maps};
use validation::{KeptStudy, ValidationError, kept_maps, kept_studies};

use crate::commands::stability::{self, built_in};
use crate::commands::study::{sentence, write_text};
use crate::error::{Result, unfit};
use crate::folder::save;
use crate::inputs::Working;

/// Writes `charts.md` into the folder of the report, and the figures that it shows.
pub(super) fn write(folder: &Path) -> Result<()> {
    let _working = Working::new("computing the stability maps of the report");
    let studies = kept_studies().map_err(ValidationError::from)?;
    let kept = kept_maps().map_err(ValidationError::from)?;
    let maps = maps(kept)?;
    save(&folder.join("charts.md"), &page(&studies, &maps)?)?;
    #[cfg(feature = "charts")]
    {
        let of_studies = studies.iter().map(|s| crate::figures::of_study(&s.result, s.name));
        let figures: Vec<_> = of_studies.chain(maps.iter().map(crate::figures::of_map)).collect();
        crate::figures::save(&figures, folder)?;
    }
    Ok(())
}

/// All maps, of the set built in; those that take minutes as they are `kept`.
fn maps(kept: Vec<StabilityMap>) -> Result<Vec<StabilityMap>> {
    let is_kept = |which: &&Map| kept.iter().any(|map| map.map == which.name);
    let others: Vec<&Map> = MAPS.into_iter().filter(|which| !is_kept(which)).collect();
    let refused = |e: MapError| unfit(Path::new("the scene built in"), e);
    let mut all = stability_maps(&others, &built_in()?).map_err(refused)?;
    all.extend(kept);
    all.sort_by_key(|map| MAPS.iter().position(|which| which.name == map.map));
    Ok(all)
}

fn page(studies: &[KeptStudy], maps: &[StabilityMap]) -> Result<String> {
    let mut out = Vec::new();
    write_studies(studies, &mut out)?;
    write_maps(maps, &mut out)?;
    Ok(String::from_utf8_lossy(&out).into_owned())
}

fn write_studies(studies: &[KeptStudy], out: &mut Vec<u8>) -> Result<()> {
    writeln!(
        out,
        "# Charts\n\n## Error against cost\n\nEvery study as it was run once: costs are those of that run; values, \
         truth with its uncertainty U, errors and counted work are the same in every run. `epicyclic study` \
         with the file of a study runs it anew.\n"
    )?;
    for KeptStudy { name, version, result } in studies {
        writeln!(out, "### {}\n\nstudies/{name}.toml, version {version}\n", result.title)?;
        for quantity in &result.quantities {
            writeln!(out, "- {}", sentence(result, quantity))?;
        }
        writeln!(out)?;
        show(&format!("study_{}", name.replace('-', "_")), &result.title, out)?;
        writeln!(out, "```text")?;
        write_text(result, out)?;
        writeln!(out, "```\n")?;
    }
    Ok(())
}

fn write_maps(maps: &[StabilityMap], out: &mut Vec<u8>) -> Result<()> {
    writeln!(
        out,
        "## Stability\n\nMethods and sets pushed until they fail, what was measured beside theory. `epicyclic stability MAP` \
         computes one anew; those of contact loss, of linear kinematics and of hammering are kept.\n"
    )?;
    for map in maps {
        writeln!(out, "### {}\n", map.map)?;
        show(&format!("stability_{}", map.map.replace('-', "_")), &map.meaning, out)?;
        writeln!(out, "```text")?;
        stability::write_text(map, out)?;
        writeln!(out, "```\n")?;
    }
    Ok(())
}

/// The figure of a name, in a build that draws.
fn show(name: &str, words: &str, out: &mut Vec<u8>) -> Result<()> {
    if cfg!(feature = "charts") {
        writeln!(out, "![{words}]({name}.svg)\n")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Every file of `studies/` but the one to start from has a kept result of its title, quantities and settings, and
    /// every map is shown with the figure that the page names.
    #[test]
    fn the_page_has_every_shipped_study_and_every_map() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path()).unwrap();
        let page = std::fs::read_to_string(folder.path().join("charts.md")).unwrap();
        let studies = concat!(env!("CARGO_MANIFEST_DIR"), "/studies");
        let kept = kept_studies().unwrap();
        let mut names = HashSet::new();
        for entry in std::fs::read_dir(studies).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            if name == "first" || path.extension().is_none_or(|ending| ending != "toml") {
                continue;
            }
            let own = kept.iter().find(|s| s.name == name).expect(&name);
            let text = std::fs::read_to_string(&path).unwrap();
            let file: toml::Table = toml::from_str(&text).unwrap();
            assert_eq!(file["title"].as_str().unwrap(), own.result.title);
            let list = |key: &str| {
                file.get(key).and_then(|own| own.as_array()).cloned().unwrap_or_default()
            };
            let named: Vec<String> =
                list("quantity").iter().map(|q| q["name"].as_str().unwrap().to_owned()).collect();
            let found: Vec<String> = own.result.quantities.iter().map(|q| q.name.clone()).collect();
            assert_eq!(named, found, "{name}: run the study again and keep its result");
            let of_series =
                list("series").iter().map(|s| s["values"].as_array().unwrap().len()).sum::<usize>();
            let settings = list("setting").len() + of_series;
            assert_eq!(settings, own.result.settings.len(), "{name}: run the study again");
            assert!(page.contains(&format!("### {}\n", own.result.title)), "{name}");
            names.insert(format!("study_{name}"));
        }
        assert_eq!(kept.len(), names.len());
        names.extend(MAPS.map(|m| format!("stability_{}", m.name.replace('-', "_"))));
        for name in names {
            if cfg!(feature = "charts") {
                assert!(page.contains(&format!("]({name}.svg)")), "{name}");
                assert!(folder.path().join(format!("{name}.svg")).is_file(), "{name}");
            }
        }
    }

    /// The pictures of the studies in the documentation are those of the kept results.
    #[cfg(feature = "charts")]
    #[test]
    fn the_pictures_of_the_documentation_are_of_the_kept_studies() {
        for KeptStudy { name, result, .. } in kept_studies().unwrap() {
            let drawn = crate::figures::of_study(&result, name).picture.svg();
            let kept = format!("{}/docs/study_{name}.svg", env!("CARGO_MANIFEST_DIR"));
            if std::env::var("INSTA_UPDATE").is_ok_and(|v| v == "always") {
                std::fs::write(&kept, &drawn).unwrap();
            }
            let kept = std::fs::read_to_string(&kept).unwrap();
            for mark in ["<circle", "<path", "<text"] {
                let [a, b] = [&drawn, &kept].map(|text| text.matches(mark).count());
                assert_eq!(
                    a, b,
                    "{name}, {mark}: draw docs/study_{name}.svg anew with INSTA_UPDATE=always"
                );
            }
        }
    }
}
