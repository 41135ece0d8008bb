//! The Campbell chart of a set: where mesh harmonics meet natural frequencies, and whether they can
//! excite what they meet.

use gearset::AllowedKinds;
use lumped::{ModeType, NaturalModes};
use scene::{Scene, excitation_of_scene};

use super::drawing::{Curve, Labels, Picture, chart_with_words, colour_of};

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
    let (mut curves, mut words) = (Vec::new(), Vec::new());
    for l in 1..=HARMONICS {
        let reach = (TOP_FREQUENCY_HZ / (f64::from(l) * top_mesh_hz)).min(1.0);
        let end = (reach * TOP_SPEED_RPM, reach * f64::from(l) * top_mesh_hz);
        curves.push(Curve::new("", vec![(0.0, 0.0), end]).thin("#9aa0a6"));
        // Beyond the end of the line, where natural frequencies and dots end too.
        let (x, y) = match reach < 1.0 {
            true => end,
            false => (1.026 * end.0, end.1 - 0.023 * TOP_FREQUENCY_HZ),
        };
        words.push((format!("l = {l}"), x, y));
    }
    for mode_type in [ModeType::Translational, ModeType::Rotational, ModeType::Planet] {
        let (mut can, mut cannot) = (Vec::new(), Vec::new());
        let low = modes.of_type(mode_type).filter(|g| g.frequency_hz < TOP_FREQUENCY_HZ);
        for (i, group) in low.enumerate() {
            let f = group.frequency_hz;
            let name = if i == 0 { mode_type.name() } else { "" };
            let line = Curve::new(name, vec![(0.0, f), (TOP_SPEED_RPM, f)]);
            curves.push(line.thin(colour_of(mode_type)).dashed());
            for strength in &strengths {
                // l f_m = f at the speed n = f/(l f_m,top) n_top
                let share = f / (f64::from(strength.harmonic) * top_mesh_hz);
                if share <= 1.0 {
                    let point = (share * TOP_SPEED_RPM, f);
                    let side =
                        if admits(strength.allowed(), mode_type) { &mut can } else { &mut cannot };
                    side.push(point);
                }
            }
        }
        curves.push(Curve::new("", cannot).dots(2.5, "#7a7f85"));
        curves.push(Curve::new("", can).dots(5.0, colour_of(mode_type)));
    }
    let labels = Labels {
        title: "Resonances that planet phasing allows",
        subtitle: format!(
            "{}. Grey: mesh harmonics 1 to 5; large dots: excited, small: forbidden",
            scene.title
        ),
        x: "sun speed, rpm",
        y: "natural frequency, Hz",
    };
    Some(chart_with_words(&labels, &curves, &words))
}

fn admits(allowed: AllowedKinds, mode_type: ModeType) -> bool {
    match mode_type {
        ModeType::Rotational => allowed.rotational,
        ModeType::Translational => allowed.translational,
        ModeType::Planet => allowed.planet,
        ModeType::Mixed => true,
    }
}
