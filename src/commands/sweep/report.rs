//! A sweep as text and in files.

use std::io::Write;

use super::result::SweepOutput;
use super::table::table;
use crate::commands::auto_choice;
use crate::error::Result;
use crate::output::Report;

impl Report for SweepOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(self.harmonics(), out)
    }

    /// One line per speed: strongest harmonics of the sun's motion, contact, cycles and residual; then a legend,
    /// warnings, and the speeds that could not be computed.
    fn text(&self, out: &mut dyn Write) -> Result<()> {
        let (scene, fidelity, torque) = (&self.scene, &self.fidelity, self.sun_torque_nm);
        writeln!(out, "{scene}: {fidelity}, {torque} N·m on the sun\n")?;
        if let Some(choice) = &self.auto {
            auto_choice::write(choice, out)?;
            writeln!(out)?;
        }
        table().text(self.points(), out)?;
        table().legend(out)?;
        self.remarks(out)
    }
}

impl SweepOutput {
    /// The JSON file beside the table: the result without the harmonics, which the table has, and what its columns are.
    pub(super) fn sidecar(&self, scene_file: &str) -> Result<Vec<u8>> {
        let mut value = serde_json::to_value(self)?;
        for point in value["points"].as_array_mut().into_iter().flatten() {
            if let Some(point) = point.as_object_mut() {
                point.remove("lines");
            }
        }
        value["scene_file"] = scene_file.into();
        value["columns"] = serde_json::to_value(table().list())?;
        Ok(serde_json::to_vec_pretty(&value)?)
    }

    #[cfg(feature = "parquet")]
    pub(super) fn parquet(&self) -> Result<Vec<u8>> {
        let bytes = table().parquet("sweep", &self.harmonics());
        bytes.map_err(|e| crate::error::CommandError::Output(std::io::Error::other(e)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use experiments::sweep::{
        Attraction, Coordinate, FailedPoint, Line, MultipliersOf, SearchStart, SteadyMethod,
        SteadySettings, SteadyState, Sweep, SweepPoint,
    };
    use scene::{LoadCase, Scene};

    /// A sweep of three chains: two speeds found, the first in the second chain, and one that failed.
    fn sweep() -> Sweep {
        let case = |rpm: f64| LoadCase::turning(1130.0, rpm, 0.35 * rpm);
        let point = |rpm: f64, repeats_after: Option<usize>| {
            let line = |coordinate, amplitude| Line {
                part: experiments::sweep::Part::SUN,
                coordinate,
                harmonic: 1,
                amplitude,
                phase_rad: 0.0,
            };
            let lines = vec![
                line(Coordinate::Radial, 3e-6),
                line(Coordinate::Tangential, 4e-6),
                line(Coordinate::Rotation, 1e-6),
            ];
            SweepPoint {
                state: SteadyState { case: case(rpm), lines },
                method: SteadyMethod::Marching,
                why_marched: None,
                steps_per_cycle: 140,
                computed_at_rpm: None,
                cycles: 40,
                derivatives: 0,
                start: SearchStart::Rest,
                attracts: match repeats_after {
                    Some(_) => Attraction::ByDecay,
                    None => Attraction::NotShown,
                },
                multipliers: Vec::new(),
                multipliers_of: MultipliersOf::Steps,
                largest_multiplier: None,
                critical: None,
                residual: 1e-10,
                is_steady: repeats_after == Some(1),
                transient: None,
                step_error: None,
                inertia_error: None,
                between: None,
                repeats_after,
                lowest_force_n: 0.0,
                contact_loss: 0.25,
                backside_contact: None,
                grazing_margin: None,
                size: 0,
                kinematic_rest_m: None,
                kinematic_rest_share: None,
                is_beyond_linear: false,
            }
        };
        let failed = FailedPoint {
            chain: "up_00".into(),
            case: case(1600.0),
            reason: "the motion diverges".into(),
            error: None,
        };
        let chains = vec![
            ("up_00".to_owned(), vec![point(1700.0, Some(2))]),
            ("peak_00".to_owned(), vec![point(1500.0, None)]),
        ];
        Sweep { fidelity: "quasi-static".into(), chains, failed: vec![failed] }
    }

    fn result() -> SweepOutput {
        let scene = scene::template(scene::SceneKind::Planetary);
        let scene = Scene::from_toml(scene).unwrap();
        SweepOutput::new(&scene, 1130.0, &SteadySettings::default(), &sweep())
    }

    fn text() -> String {
        let mut out = Vec::new();
        Report::text(&result(), &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_failed_speed_is_in_every_output() {
        let last = "1 of 3 speeds could not be computed:\n  1600.0 rpm (up_00): the motion \
             diverges\n";
        assert!(text().ends_with(last), "{}", text());
        let json = serde_json::to_value(result()).unwrap();
        assert_eq!(json["failed"][0]["speed_rpm"], 1600.0);
        assert_eq!(json["failed"][0]["reason"], "the motion diverges");
        let sidecar: serde_json::Value =
            serde_json::from_slice(&result().sidecar("").unwrap()).unwrap();
        assert_eq!(sidecar["failed"], json["failed"]);
        assert_eq!(sidecar["sun_torque_nm"], 1130.0);
        let mut table = Vec::new();
        result().csv(&mut table).unwrap();
        let table = String::from_utf8(table).unwrap();
        assert!(!table.contains("1600") && table.contains("sun,translation,1,"), "{table}");
        // The sidecar says what every column of the table is.
        let columns = sidecar["columns"].as_array().unwrap().iter();
        let names: Vec<&str> = columns.map(|column| column[0].as_str().unwrap()).collect();
        assert_eq!(table.lines().next().unwrap(), names.join(","));
    }

    #[test]
    fn the_text_is_by_speed_and_explains_its_columns() {
        let text = text();
        assert!(text.find("1500.0").unwrap() < text.find("1700.0").unwrap(), "{text}");
        for column in ["lowest N", "no contact", "backside", "repeats", "residual"] {
            assert!(text.contains(&format!("\n{column}:")), "{column} is not explained: {text}");
        }
        for words in [
            "At 2 of these speeds teeth part",
            "At 1 of these speeds the motion is subharmonic",
            "At 1 of these speeds no motion that repeats after 1 to 8 mesh cycles and \
             attracts was found",
            "n/a",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
    }
}
