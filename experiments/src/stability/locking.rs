//! Locking of quadrilaterals in bending: the energy of one element that is bent, by family.
//!
//! A rectangle of 2a × 2b whose nodes follow pure bending by the curvature κ, u = κxy, v = −κ (x² + ν y²)/2 (plane
//! stress), has the exact energy ½ κ² E t (4ab) b²/3. Bilinear functions make of it u = κxy, v = const: a shear κx
//! that pure bending does not have, and no contraction across. The energy over the exact one ([`locked`]) has no bound
//! as elements get longer. Incompatible modes and eight nodes contain the exact field: 1.

use fe_contact::element::{Shape, matrices};
use fe_contact::{Elastic, FeError};
use nalgebra::DVector;
use scene::PlaneState;

use super::map::{Map, MapError, MapOf, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "locking",
    about: "Bending stiffness of one quadrilateral, by family and shape",
    meaning: "bilinear elements resist bending by a shear that is not there: teeth come out too stiff, the more the \
         longer the elements",
    of: MapOf::Nothing(map),
};

const STEEL: Elastic =
    Elastic { young: 207e9, poisson: 0.3, density: 7800.0, plane: PlaneState::Stress };

/// Length over height a/b.
const RATIOS: [f64; 9] = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];

/// Half the height, m.
const HALF_HEIGHT: f64 = 1e-3;

fn map() -> Result<StabilityMap, MapError> {
    let system = "one element bent with the curvature of a beam, plane stress, ν = 0.3";
    let mut map = StabilityMap::of(&MAP, system, "length over height of the element");
    for (name, shape, incompatible) in [
        ("linear", Shape::LINEAR, false),
        ("incompatible", Shape::LINEAR, true),
        ("quadratic", Shape::QUADRATIC, false),
    ] {
        let theory = |ratio: f64| match (shape.is_linear(), incompatible) {
            (true, false) => locked(ratio),
            _ => 1.0,
        };
        let mut points = Vec::new();
        for ratio in RATIOS {
            let found = energy_ratio(&shape, incompatible, ratio)?;
            let quantity = format!("bending stiffness over exact at {ratio} times its height");
            map.compare(name, quantity, found, Some(theory(ratio)));
            points.push((ratio, found));
        }
        let exact = RATIOS.map(|r| (r, theory(r)));
        map.draw_beside("bending stiffness over exact", name, points, exact);
    }
    Ok(map)
}

/// `[eq:locking]` Energy of a bent bilinear element over the exact one: 1/(1 − ν²) + (a/b)²/(2(1 + ν)).
///
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::borders_that_have_a_closed_form_are_those_of_theory`,
/// `tests/all/stability_command.rs::a_square_bilinear_element_is_as_stiff_as_the_warning_says`.
fn locked(ratio: f64) -> f64 {
    let nu = STEEL.poisson;
    1.0 / (1.0 - nu * nu) + ratio * ratio / (2.0 * (1.0 + nu))
}

fn energy_ratio(shape: &Shape, incompatible: bool, ratio: f64) -> Result<f64, MapError> {
    let (a, b) = (ratio * HALF_HEIGHT, HALF_HEIGHT);
    let mut places = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    if !shape.is_linear() {
        places.extend([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]);
    }
    let points: Vec<[f64; 2]> = places.iter().map(|[xi, eta]| [a * xi, b * eta]).collect();
    let (curvature, thickness, nu) = (1.0, 1.0, STEEL.poisson);
    let bent = points
        .iter()
        .flat_map(|[x, y]| [curvature * x * y, -0.5 * curvature * (x * x + nu * y * y)]);
    let bent = DVector::from_iterator(2 * points.len(), bent);
    let own = matrices(shape, &points, &STEEL, thickness, incompatible).map_err(|cause| {
        MapError::Fe(FeError::Distorted { body: "bent element", element: 0, cause })
    })?;
    let energy = 0.5 * bent.dot(&(&own.stiffness * &bent));
    // ½ κ² E t (4ab) b²/3
    let exact = 0.5 * curvature * curvature * STEEL.young * thickness * 4.0 * a * b * b * b / 3.0;
    Ok(energy / exact)
}
