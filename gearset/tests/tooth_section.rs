//! Outlines of teeth between root and tip circle, and their areas and polar moments.

use std::f64::consts::PI;

use gearset::{Gear, ToothSide, gauss_points};
use scene::{Scene, SceneKind, template};

fn gears() -> [Gear; 3] {
    let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
    let geometry = scene.tooth_geometry().unwrap();
    [geometry.sun.unwrap(), geometry.planet, geometry.ring.unwrap()]
}

/// At the form circle the fillet passes into the flank with the same angle and the same tangent; on the root circle
/// it leaves the land that the geometry states.
#[test]
fn fillets_pass_smoothly_from_flank_to_root_circle() {
    let [sun, planet, ring] = gears();
    // A deep fillet below the base circle has a radial line above it.
    let low = Gear { root_radius: sun.base_radius - 2.0 * sun.fillet_radius, ..sun.clone() };
    assert!(low.form_roll_length().is_none());
    for gear in [sun, planet, ring, low] {
        let at = |r: f64| gear.tooth_half_angle(r);
        let sign = if gear.side == ToothSide::External { 1.0 } else { -1.0 };
        let join = gear.form_radius();
        let step = 1e-7 * join;
        let slope = |r: f64| (at(r + step) - at(r)) / step;
        if gear.form_roll_length().is_some() {
            assert!((at(join + 1e-12) - at(join - 1e-12)).abs() < 1e-8, "{gear:?}");
            let [inside, outside] = [join - 2.0 * step, join + step].map(slope);
            assert!((inside - outside).abs() < 1e-3 * inside.abs(), "{inside} {outside}");
        }
        let land = PI / f64::from(gear.teeth) - at(gear.root_radius + sign * 1e-15);
        assert!((land - 0.5 * gear.root_land_angle()).abs() < 1e-6, "{gear:?}");
    }
}

/// Against areas of polygons with a hundred thousand corners on the outline.
#[test]
fn moments_are_those_of_the_outline() {
    for gear in gears() {
        let count = 100_000;
        let (low, high) =
            (gear.root_radius.min(gear.tip_radius), gear.root_radius.max(gear.tip_radius));
        let (mut area, mut polar) = (0.0, 0.0);
        let step = (high - low) / f64::from(count);
        for i in 0..count {
            let r = low + (f64::from(i) + 0.5) * step;
            let filled = 2.0 * f64::from(gear.teeth) * gear.tooth_half_angle(r);
            area += filled * r * step;
            polar += filled * r.powi(3) * step;
        }
        let body = gear.body_radius.unwrap();
        area += PI * (gear.root_radius.powi(2) - body.powi(2)).abs();
        polar += 0.5 * PI * (gear.root_radius.powi(4) - body.powi(4)).abs();
        let (own, own_polar) = gear.section_moments().unwrap();
        assert!((own / area - 1.0).abs() < 1e-5, "{own} {area}");
        assert!((own_polar / polar - 1.0).abs() < 1e-5, "{own_polar} {polar}");
    }
}

/// Gauss's formula with eight points is exact to the power 15.
#[test]
fn gauss_points_integrate_a_power_exactly() {
    for (power, from, to) in [(0, -1.0, 2.0), (7, 0.5, 1.5), (15, 0.0, 2.0)] {
        let own: f64 = gauss_points(from, to).map(|(x, w)| w * f64::powi(x, power)).sum();
        let n = power + 1;
        let exact = (f64::powi(to, n) - f64::powi(from, n)) / f64::from(n);
        assert!((own / exact - 1.0).abs() < 1e-13, "{own} {exact}");
    }
}
