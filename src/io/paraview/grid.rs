//! One unstructured grid as VTK XML.

use std::fmt::{Display, Write};

/// Points, cells and data of a `.vtu` file.
pub(super) struct Grid<'a> {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) cells: &'a [Vec<usize>],
    pub(super) point_vectors: Vec<(&'static str, Vec<[f64; 2]>)>,
    pub(super) cell_scalars: Vec<(&'static str, Vec<f64>)>,
}

/// VTK's number for a cell of so many points (vtkCellType.h).
fn cell_type(points: usize) -> u8 {
    match points {
        1 => 1,  // vertex
        2 => 3,  // line
        3 => 5,  // triangle
        4 => 9,  // quad
        6 => 22, // quadratic triangle
        8 => 23, // quadratic quad
        9 => 28, // biquadratic quad
        _ => 7,  // polygon
    }
}

impl Grid<'_> {
    /// The file's text.
    pub(super) fn xml(&self) -> String {
        let (points, cells) = (self.points.len(), self.cells.len());
        let mut out = String::from(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n",
        );
        // Writing to a string does not fail, here and below.
        let _ = writeln!(
            out,
            "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n<PointData>"
        );
        for (name, vectors) in &self.point_vectors {
            array(&mut out, "Float64", name, 3, vectors.iter().map(in_space));
        }
        out += "</PointData>\n<CellData>\n";
        for (name, values) in &self.cell_scalars {
            array(&mut out, "Float64", name, 1, values.iter());
        }
        out += "</CellData>\n<Points>\n";
        array(&mut out, "Float64", "points", 3, self.points.iter().map(in_space));
        out += "</Points>\n<Cells>\n";
        array(&mut out, "Int64", "connectivity", 1, self.cells.iter().flatten());
        let ends = self.cells.iter().scan(0, |end, cell| {
            *end += cell.len();
            Some(*end)
        });
        array(&mut out, "Int64", "offsets", 1, ends);
        array(&mut out, "UInt8", "types", 1, self.cells.iter().map(|cell| cell_type(cell.len())));
        out += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        out
    }
}

/// VTK knows three dimensions only.
fn in_space([x, y]: &[f64; 2]) -> String {
    format!("{x} {y} 0")
}

fn array<T: Display>(
    out: &mut String,
    kind: &str,
    name: &str,
    components: usize,
    values: impl Iterator<Item = T>,
) {
    let _ = writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
         format=\"ascii\">"
    );
    for value in values {
        let _ = writeln!(out, "{value}");
    }
    *out += "</DataArray>\n";
}
