//! VTK's XML format for unstructured grids, ASCII: eight-node quadrilaterals (cell type 23).

use std::fmt::Write as _;

use super::outline::Drawn;

/// A mesh as a .vtu file; coordinates in m, cell data `part` (tooth number).
pub fn vtu(drawn: &Drawn) -> String {
    let (points, cells) = (drawn.points.len(), drawn.elements.len());
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
    );
    for [x, y] in &drawn.points {
        let _ = writeln!(text, "{x:.12e} {y:.12e} 0");
    }
    text.push_str("</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n");
    for e in &drawn.elements {
        let list: Vec<String> = e.nodes.iter().map(usize::to_string).collect();
        let _ = writeln!(text, "{}", list.join(" "));
    }
    text.push_str("</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
    for i in 1..=cells {
        let _ = writeln!(text, "{}", 8 * i);
    }
    text.push_str("</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
    text.push_str(&"23\n".repeat(cells));
    text.push_str("</DataArray>\n</Cells>\n<CellData>\n<DataArray type=\"Int64\" Name=\"part\" format=\"ascii\">\n");
    for e in &drawn.elements {
        let _ = writeln!(text, "{}", e.part);
    }
    text.push_str("</DataArray>\n</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    text
}
