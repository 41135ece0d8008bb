//! The Campbell chart of a set: where mesh harmonics meet natural frequencies, and whether they can
//! excite what they meet.

use super::picture::Picture;
use gearset::{AllowedKinds, Kinematics, Scene, excitation_of_scene};
use kuva::plot::{LinePlot, LineStyle, MarkerShape, ScatterPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;
use lumped::{ModeType, NaturalModes};

const HARMONICS: u32 = 5;
const TOP_SPEED_RPM: f64 = 2500.0;
const TOP_FREQUENCY_HZ: f64 = 2500.0;

/// SVG of the chart; `None` for a scene without teeth or operating point.
pub(crate) fn campbell(scene: &Scene, modes: &NaturalModes) -> Option<Picture> {
    let strengths = excitation_of_scene(scene, HARMONICS)?;
    let mut at_top = scene.clone();
    at_top.operation.as_mut()?.speed_rpm = TOP_SPEED_RPM;
    let top_mesh_hz = Kinematics::from_scene(&at_top).ok()?.mesh_frequency_hz;
    let mut plots = Vec::new();
    for l in 1..=HARMONICS {
        let reach = (TOP_FREQUENCY_HZ / (f64::from(l) * top_mesh_hz)).min(1.0);
        let end = (reach * TOP_SPEED_RPM, reach * f64::from(l) * top_mesh_hz);
        plots.push(Plot::Line(
            LinePlot::new()
                .with_data([(0.0, 0.0), end])
                .with_color("#9aa0a6")
                .with_stroke_width(1.0),
        ));
    }
    let kinds = [
        (ModeType::Translational, "#1b6ca8", "translational"),
        (ModeType::Rotational, "#c0392b", "rotational"),
        (ModeType::Planet, "#2e8b57", "planet"),
    ];
    for (mode_type, color, name) in kinds {
        let (mut can, mut cannot) = (Vec::new(), Vec::new());
        let low = modes.of_type(mode_type).filter(|g| g.frequency_hz < TOP_FREQUENCY_HZ);
        for (i, group) in low.enumerate() {
            let f = group.frequency_hz;
            let line = LinePlot::new()
                .with_data([(0.0, f), (TOP_SPEED_RPM, f)])
                .with_color(color)
                .with_stroke_width(1.0)
                .with_line_style(LineStyle::Dashed);
            plots.push(Plot::Line(if i == 0 { line.with_legend(name) } else { line }));
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
        let marks = |points, size, color: &str| {
            ScatterPlot::new()
                .with_data(points)
                .with_color(color.to_owned())
                .with_size(size)
                .with_marker(MarkerShape::Circle)
        };
        plots.push(Plot::Scatter(marks(cannot, 2.5, "#7a7f85")));
        plots.push(Plot::Scatter(marks(can, 5.0, color)));
    }
    let layout = Layout::auto_from_plots(&plots)
        .with_title("Resonances that planet phasing allows")
        .with_subtitle(format!(
            "{}. Grey: mesh harmonics 1 to 5; large dots: excited, small: forbidden",
            scene.title
        ))
        .with_subtitle_size(12)
        .with_x_label("sun speed, rpm")
        .with_y_label("natural frequency, Hz");
    Some(Picture::new(render_multiple(plots, layout)))
}

fn admits(allowed: AllowedKinds, mode_type: ModeType) -> bool {
    match mode_type {
        ModeType::Rotational => allowed.rotational,
        ModeType::Translational => allowed.translational,
        ModeType::Planet => allowed.planet,
        ModeType::Mixed => true,
    }
}
