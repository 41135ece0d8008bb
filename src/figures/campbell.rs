//! The Campbell chart of a set: where mesh harmonics meet natural frequencies, and whether they can
//! excite what they meet.

use gearset::AllowedKinds;
use lumped::{ModeType, NaturalModes};
use scene::{Scene, excitation_of_scene};

use super::drawing::{Axis, CHART, Label, Panel, Pen, Picture, Series, Symbol, colour_of, panels};

const HARMONICS: u32 = 5;
const TOP_SPEED_RPM: f64 = 2500.0;
const TOP_FREQUENCY_HZ: f64 = 2500.0;

/// Natural frequencies over the speed of the sun, harmonics of the mesh frequency, and dots where they
/// meet, large if planet phasing lets the harmonic excite the mode; `None` for a scene without teeth or
/// operating point.
pub fn campbell(scene: &Scene, modes: &NaturalModes) -> Option<Picture> {
    let strengths = excitation_of_scene(scene, HARMONICS)?;
    let mut at_top = scene.clone();
    at_top.operation.as_mut()?.speed_rpm = TOP_SPEED_RPM;
    let top_mesh_hz = at_top.kinematics().ok()?.mesh_frequency_hz;
    let mut panel = Panel {
        x: Axis::within("sun speed, rpm", 0.0, TOP_SPEED_RPM),
        y: Axis::within("natural frequency, Hz", 0.0, TOP_FREQUENCY_HZ),
        ..Panel::default()
    };
    for l in 1..=HARMONICS {
        let reach = (TOP_FREQUENCY_HZ / (f64::from(l) * top_mesh_hz)).min(1.0);
        let end = (reach * TOP_SPEED_RPM, reach * f64::from(l) * top_mesh_hz);
        panel.series.push(Series::new("", Pen::new("#9aa0a6", 1.0), [(0.0, 0.0), end]));
        let edge = if reach < 1.0 { &mut panel.above } else { &mut panel.beside };
        edge.push(Label { point: end, text: format!("l = {l}"), colour: "#000000" });
    }
    for mode_type in [ModeType::Translational, ModeType::Rotational, ModeType::Planet] {
        let (mut can, mut cannot) = (Vec::new(), Vec::new());
        let low = modes.of_type(mode_type).filter(|g| g.frequency_hz < TOP_FREQUENCY_HZ);
        for (i, f) in low.map(|group| group.frequency_hz).enumerate() {
            let name = if i == 0 { mode_type.name() } else { "" };
            let pen = Pen::new(colour_of(mode_type), 1.0).dashed();
            panel.series.push(Series::level(name, pen, f));
            for strength in &strengths {
                // l f_m = f at the speed n = f/(l f_m,top) n_top
                let share = f / (f64::from(strength.harmonic) * top_mesh_hz);
                let is_allowed = admits(strength.allowed(), mode_type);
                if share <= 1.0 {
                    let side = if is_allowed { &mut can } else { &mut cannot };
                    side.push((share * TOP_SPEED_RPM, f));
                }
            }
        }
        panel.series.push(Series::new("", Symbol::Disc(2.5, "#7a7f85"), cannot));
        panel.series.push(Series::new("", Symbol::Disc(5.0, colour_of(mode_type)), can));
    }
    let caption = format!(
        "{}. Grey: mesh harmonics 1 to 5; large dots: excited, small: forbidden",
        scene.title
    );
    Some(panels(["Resonances that planet phasing allows", &caption], 1, CHART, &[panel]))
}

fn admits(allowed: AllowedKinds, mode_type: ModeType) -> bool {
    match mode_type {
        ModeType::Rotational => allowed.rotational,
        ModeType::Translational => allowed.translational,
        ModeType::Planet => allowed.planet,
        ModeType::Mixed => true,
    }
}
