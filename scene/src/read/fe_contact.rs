//! The `[fe_contact]` table.

use crate::choices::FeContactInput;
use crate::read::document::Section;
use crate::scene::PerMesh;

pub(crate) fn fe_contact(s: &Section<'_, '_>) -> Option<FeContactInput> {
    let matching_depth = s.optional("matching_depth_mm");
    let matching_depth_elements = s.optional("matching_depth_elements");
    if matching_depth.is_some() && matching_depth_elements.is_some() {
        let why = "a depth in mm is not derived from the elements";
        s.fault("matching_depth_elements", "no value beside `matching_depth_mm`", why);
    }
    let factor = s.table("flexibility_factor");
    Some(FeContactInput {
        plane: s.choice("plane")?,
        element: s.choice("element")?,
        flank_elements: s.integer("flank_elements")?,
        flank_layer: s.choice("flank_layer")?,
        contact_cells: s.integer("contact_cells")?,
        cell_layout: s.choice("cell_layout")?,
        cell_layout_at_rest: s.choice("cell_layout_at_rest")?,
        matching_depth_m: matching_depth,
        matching_depth_elements,
        matching_points: s.integer("matching_points")?,
        mean_positions: s.integer("mean_positions"),
        flexibility_factor: PerMesh {
            sun_planet: factor.number("sun_planet"),
            ring_planet: factor.number("ring_planet"),
        },
    })
}
