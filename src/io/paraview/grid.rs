//! Grids of points and cells with their data, as text of `.vtu` files.

use std::fmt::{Display, Write};

use crate::error::Result;
use crate::results::shape_cell::ShapeCell;
use crate::results::{DeformedShape, ShapePoint};

/// A vector [x, y, z], z up, in the axes of the file.
///
/// `up_axis`: index of the file's axis that points up.
pub(super) fn in_file_axes(up_axis: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let mut vector = [x, y, 0.0];
    vector[up_axis] = z;
    vector
}

/// A vector [right, height, away] of a deformed shape in the axes of the file.
fn shape_vector(up_axis: usize, [right, height, away]: [f64; 3]) -> [f64; 3] {
    in_file_axes(up_axis, [right, away, height])
}

/// Grid of the structure with vectors at its points.
///
/// `vectors`: the name of each vector, and the degrees of freedom from which it is computed.
pub(super) fn structure_grid<'a>(
    shape: &'a DeformedShape,
    up_axis: usize,
    vectors: &[(&'static str, &[f64])],
) -> Result<VtuGrid<'a>> {
    let mut point_vectors = Vec::new();
    for &(name, dofs) in vectors {
        let values = shape.displacements(dofs)?.into_iter();
        point_vectors.push((name, values.map(|vector| shape_vector(up_axis, vector)).collect()));
    }
    let positions = shape.points().iter().map(ShapePoint::place);
    Ok(VtuGrid {
        points: positions.map(|position| shape_vector(up_axis, position)).collect(),
        cells: shape.grid(),
        point_vectors,
        cell_scalars: Vec::new(),
    })
}

/// Points, cells and data of a `.vtu` file.
pub(super) struct VtuGrid<'a> {
    /// Coordinates of the points, m.
    pub(super) points: Vec<[f64; 3]>,
    pub(super) cells: &'a [ShapeCell],
    /// Name of each vector, and its value at each point.
    pub(super) point_vectors: Vec<(&'static str, Vec<[f64; 3]>)>,
    /// Name of each scalar, and its value in each cell.
    pub(super) cell_scalars: Vec<(&'static str, Vec<f64>)>,
}

impl VtuGrid<'_> {
    /// The file's text.
    pub(super) fn xml(&self) -> String {
        let point_count = self.points.len();
        let cell_count = self.cells.len();
        let mut xml_text = String::from(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n",
        );
        // Writing to a string does not fail, here and below.
        let _ = writeln!(
            xml_text,
            "<Piece NumberOfPoints=\"{point_count}\" NumberOfCells=\"{cell_count}\">\n<PointData>"
        );
        for (name, vectors) in &self.point_vectors {
            write_array(&mut xml_text, "Float64", name, 3, vectors.iter().map(vector_text));
        }
        xml_text += "</PointData>\n<CellData>\n";
        for (name, values) in &self.cell_scalars {
            write_array(&mut xml_text, "Float64", name, 1, values.iter());
        }
        xml_text += "</CellData>\n<Points>\n";
        write_array(&mut xml_text, "Float64", "points", 3, self.points.iter().map(vector_text));
        xml_text += "</Points>\n<Cells>\n";
        write_array(
            &mut xml_text,
            "Int64",
            "connectivity",
            1,
            self.cells.iter().flat_map(|cell| &cell.points),
        );
        let offsets = self.cells.iter().scan(0, |end, cell| {
            *end += cell.points.len();
            Some(*end)
        });
        write_array(&mut xml_text, "Int64", "offsets", 1, offsets);
        write_array(
            &mut xml_text,
            "UInt8",
            "types",
            1,
            self.cells.iter().map(|cell| cell.form as u8),
        );
        xml_text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        xml_text
    }
}

/// Components of a vector, separated by spaces.
fn vector_text([x, y, z]: &[f64; 3]) -> String {
    format!("{x} {y} {z}")
}

/// Appends an array of data with one value on each line.
fn write_array<T: Display>(
    xml_text: &mut String,
    number_type: &str,
    name: &str,
    component_count: usize,
    values: impl Iterator<Item = T>,
) {
    let _ = writeln!(
        xml_text,
        "<DataArray type=\"{number_type}\" Name=\"{name}\" NumberOfComponents=\"{component_count}\" \
         format=\"ascii\">"
    );
    for value in values {
        let _ = writeln!(xml_text, "{value}");
    }
    *xml_text += "</DataArray>\n";
}
