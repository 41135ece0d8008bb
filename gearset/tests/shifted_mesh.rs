//! Backlash that profile shifts leave, and how far printed digits move it.

use gearset::{
    GearInput, Geometry, GeometryInput, MeshKind, Rack, ShiftedMesh, Teeth, ThicknessInput,
    Thinning, WrittenRounding,
};

const TEETH: Teeth = Teeth { sun: Some(18), planet: 36, ring: Some(93) };
const RACK: Rack = Rack { module_m: 21e-3, pressure_angle_rad: 0.349_065_850_398_865_9 };

fn shifts(sun: f64, planet: f64, ring: f64, thinning: Thinning) -> ThicknessInput {
    ThicknessInput::ProfileShift { sun, planet, ring, thinning }
}

/// Backlash from the teeth themselves: space less tooth on the operating pitch circles.
fn of_teeth(rack: Rack, a: f64, thickness: ThicknessInput, kind: MeshKind) -> f64 {
    let gear = |tip: f64, root: f64| GearInput {
        tip_radius_m: tip,
        root_radius_m: root,
        body_radius_m: None,
        fillet_radius_m: 1e-3,
        tip_relief: None,
    };
    let input = GeometryInput {
        center_distance_m: a,
        base_pitch_m: std::f64::consts::PI * rack.module_m * rack.pressure_angle_rad.cos(),
        rack: Some(rack),
        face_width_m: 0.1,
        sun: Some(gear(0.216, 0.171)),
        planet: gear(0.408, 0.362),
        ring: Some(gear(0.953, 1.0)),
        carrier: None,
        thickness,
    };
    Geometry::new(&input, &TEETH).unwrap().backlash(kind).unwrap()
}

#[test]
fn backlash_of_shifts_is_that_of_the_teeth() {
    let a = 0.584;
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let thickness = shifts(0.3805, 0.4924, -0.0962, Thinning::default());
        let mesh = ShiftedMesh::new(kind, &TEETH, RACK, a, &thickness).unwrap();
        let j = mesh.backlash().unwrap();
        assert!((j - of_teeth(RACK, a, thickness, kind)).abs() < 1e-15);
        // Printed for this set: 0.314 and 0.483 mm.
        let printed = if kind == MeshKind::SunPlanet { 0.314e-3 } else { 0.483e-3 };
        assert!((j - printed).abs() < 0.5e-6, "{j}");
        // At the sums and distances that close the mesh nothing is left.
        let closed = mesh.with_shift_sum(mesh.closing_shift_sum().unwrap());
        assert!(closed.backlash().unwrap().abs() < 1e-15);
        let closed = ShiftedMesh { center_distance: mesh.closing_distance().unwrap(), ..mesh };
        assert!(closed.backlash().unwrap().abs() < 1e-12);
        let thinning = Thinning { sun_m: 1e-5, planet_m: 2e-5, ring_m: 1e-5 };
        let thinned = shifts(0.3805, 0.4924, -0.0962, thinning);
        let more = of_teeth(RACK, a, thinned, kind) - j;
        assert!((more - 3e-5 * mesh.backlash_per_thinning()).abs() < 1e-15);
    }
}

#[test]
fn rounding_moves_the_backlash_as_differences_do() {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let closed = ShiftedMesh::new(
            kind,
            &TEETH,
            RACK,
            0.584,
            &shifts(0.389, 0.5039, -0.1171, Thinning::default()),
        );
        let closed = closed.unwrap();
        let closed = closed.with_shift_sum(closed.closing_shift_sum().unwrap());
        let exact = WrittenRounding::default();
        assert_eq!(closed.rounding(&exact), 0.0);
        let h = 1e-7;
        let moved = |mesh: ShiftedMesh| mesh.backlash().unwrap().abs();
        let in_distance = ShiftedMesh { center_distance: closed.center_distance + h, ..closed };
        let written = WrittenRounding { center_distance_m: h, ..exact };
        assert!((moved(in_distance) / closed.rounding(&written) - 1.0).abs() < 1e-5);
        let rack = Rack { module_m: RACK.module_m + h, ..RACK };
        let written = WrittenRounding { module_m: h, ..exact };
        let in_module = ShiftedMesh { rack, ..closed };
        assert!((moved(in_module) / closed.rounding(&written) - 1.0).abs() < 1e-3);
        // Two shifts count in each mesh, that of the third gear does not.
        let in_shifts = closed.with_shift_sum(closed.shift_sum + 2.0 * h);
        let written = WrittenRounding { shifts: [h; 3], ..exact };
        assert!((moved(in_shifts) / closed.rounding(&written) - 1.0).abs() < 1e-6);
        let third = if kind == MeshKind::SunPlanet { [0.0, 0.0, h] } else { [h, 0.0, 0.0] };
        assert_eq!(closed.rounding(&WrittenRounding { shifts: third, ..exact }), 0.0);
    }
}
