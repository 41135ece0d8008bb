//! The `[fe_contact]` table.

use crate::choices::{CellLayout, ElementFamily, FeContactInput, FlankLayer, PlaneState};
use crate::keys::bound::Bound;
use crate::read::document::Section;
use crate::scene::PerMesh;

pub(crate) fn fe_contact(s: Section<'_, '_>) -> FeContactInput {
    let default = FeContactInput::default();
    let planes = [("strain", PlaneState::Strain), ("stress", PlaneState::Stress)];
    let plane = s.choice("plane", &planes, "state of the gears' plane");
    let elements = [
        ("linear", ElementFamily::Linear),
        ("incompatible", ElementFamily::Incompatible),
        ("quadratic", ElementFamily::Quadratic),
    ];
    let element = s.choice("element", &elements, "quadrilateral behind the flanks");
    let flank = s.integer("flank_elements", (3, 64), "elements along one flank");
    let of_layer = [("whole", FlankLayer::Whole), ("divided", FlankLayer::Divided)];
    let layer = s.choice("flank_layer", &of_layer, "elements next to the flanks");
    let cells = s.integer("contact_cells", (8, 400), "contact cells of one tooth pair");
    let layouts = [("graded", CellLayout::Graded), ("even", CellLayout::Even)];
    let cell_layout = s.choice("cell_layout", &layouts, "contact cells in time");
    let at_rest = s.choice("cell_layout_at_rest", &layouts, "contact cells at rest");
    let why = "depth below the flank at which half-plane and FE are matched";
    let matching_depth = s.number("matching_depth_mm", Bound::Positive, why).map(|d| d * 1e-3);
    let why = "elements along a flank, below which the default depth never is";
    let in_elements = s.number("matching_depth_elements", Bound::Positive, why);
    if matching_depth.is_some() && in_elements.is_some() {
        let why = "a depth in mm is not derived from the elements";
        s.fault("matching_depth_elements", "no value beside `matching_depth_mm`", why);
    }
    let points = s.integer("matching_points", (1, 2), "1: the paper's eq. (1); 2: extrapolated");
    let flexibility_factor = s.section("flexibility_factor").map(|f| {
        let why = "factor on the FE part of a mesh's flexibility";
        let value = |key| f.number(key, Bound::Positive, why).unwrap_or(1.0);
        let found = PerMesh { sun_planet: value("sun_planet"), ring_planet: value("ring_planet") };
        f.finish();
        found
    });
    s.finish();
    FeContactInput {
        plane: plane.unwrap_or(default.plane),
        element: element.unwrap_or(default.element),
        flank_elements: flank.map_or(default.flank_elements, |n| n as u32),
        flank_layer: layer.unwrap_or(default.flank_layer),
        contact_cells: cells.map_or(default.contact_cells, |n| n as u32),
        cell_layout: cell_layout.unwrap_or(default.cell_layout),
        cell_layout_at_rest: at_rest.unwrap_or(default.cell_layout_at_rest),
        matching_depth,
        matching_depth_elements: in_elements,
        matching_points: points.map_or(default.matching_points, |n| n as u32),
        flexibility_factor: flexibility_factor.unwrap_or(default.flexibility_factor),
    }
}
