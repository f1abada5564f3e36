//! Files for ParaView: a `.pvd` collection of `.vtu` grids, up to two per frame.
//!
//! The first grid of a frame is the structure. For a [`FemModel`](crate::structure::FemModel) its cells are the
//! elements in their order: lines, triangles, quadrilaterals, bricks with eight corners, other solids as convex sets of
//! points. Points have the vectors `displacement` (m, change from the static state, relative to the free field),
//! `static_displacement` (m) and `velocity` (m/s, total). Apply *Warp By Vector* to see the structure move, to the sum
//! of the first two (*Calculator*) to see it from its unloaded shape.
//!
//! The second grid is the base. It has one line for each contact element, with `pressure` and `shear`
//! (Pa), `gap` and `slip` (m) and `mode` (0 stick, 1 slip to the left, 2 slip to the right, 3 open). In plan
//! it has one rectangle for each element, with `shear_across` and `slip_across` (along y) as well; mode 7 is
//! slip in any direction. Points are (x, y, 0) in the plane, y up, and (x, y, z) in plan, z up; the nodes of the base
//! lie at height zero.
//!
//! A single state, such as the static one or a vibration mode, is a grid by itself ([`write_state`]).
//!
//! Files are ASCII XML as in *VTK File Formats* (Kitware, for VTK 4.2 and later), and need no library.
//!
//! ```no_run
//! # fn scene() -> basemat::Result<(basemat::Simulation, basemat::structure::RigidBlock)> { unimplemented!() }
//! use basemat::results::{Recorder, DeformedShape};
//! let (mut simulation, block) = scene()?;
//! let shape = DeformedShape::of_block(&block, 10.0)?;
//! let mut time_series = Recorder::new().contact(10).motion(10).start(&simulation)?;
//! simulation.run(2000, |state| time_series.record(state))?;
//! // results/block.pvd, block_0000.vtu, block_base_0000.vtu, …
//! basemat::io::paraview::write_series("results", "block", &shape, &time_series)?;
//! # Ok::<(), basemat::Error>(())
//! ```

use std::fmt::{Display, Write};
use std::path::Path;

use crate::error::{Result, require_part};
use crate::geometry::ContactElement;
use crate::interface::ContactState;
use crate::results::shape_cell::ShapeCell;
use crate::results::{ContactFrame, DeformedShape, ShapePoint, TimeSeries};
use crate::text::file::{write_error, write_file};

/// Writes `name.pvd` and the grids of all kept frames into `folder`; returns the number of grids.
///
/// Each frame of motion in `time_series` gives a grid of the structure (`name_0000.vtu`, …), each frame of
/// contact a grid of the base (`name_base_0000.vtu`, …). The folder is made if it does not exist.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if no motion was kept ([`crate::results::Recorder::motion`]) or the
/// name contains anything but letters, digits, `-` and `_`; [`Error::Index`](crate::Error::Index) if `shape`
/// belongs to another structure; [`Error::File`](crate::Error::File) if a file cannot be written.
pub fn write_series(
    folder: impl AsRef<Path>,
    name: &str,
    shape: &DeformedShape,
    time_series: &TimeSeries,
) -> Result<usize> {
    let needed = "tell the recorder to keep the motion";
    require_part("series of the structure", time_series.motion_frames().next().is_some(), needed)?;
    write(folder.as_ref(), name, Some(shape), time_series)
}

/// Writes `name.pvd` and grids of the base only, for structures without a [`DeformedShape`].
///
/// Each frame of contact in `time_series` gives a grid (`name_base_0000.vtu`, …), as with [`write_series`].
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if no contact was kept ([`crate::results::Recorder::contact`]) or for the
/// name, [`Error::File`](crate::Error::File) if a file cannot be written.
pub fn write_base(folder: impl AsRef<Path>, name: &str, time_series: &TimeSeries) -> Result<usize> {
    let needed = "tell the recorder to keep the contact";
    require_part("series of the base", time_series.contact_frames().next().is_some(), needed)?;
    write(folder.as_ref(), name, None, time_series)
}

/// Writes one grid of a structure, a `.vtu` file, with the vectors `displacement` at its points.
///
/// `dofs`: values of the degrees of freedom, m and rad, such as
/// [`Simulation::static_displacement`](crate::Simulation::static_displacement) or a vibration mode. The folder is made
/// if it does not exist.
///
/// # Errors
/// [`Error::Index`](crate::Error::Index) if `shape` has degrees of freedom beyond `dofs`;
/// [`Error::File`](crate::Error::File) if the file cannot be written.
pub fn write_state(path: impl AsRef<Path>, shape: &DeformedShape, dofs: &[f64]) -> Result<()> {
    write_file(path.as_ref(), structure_grid(shape, shape.up(), &[("displacement", dofs)])?)
}

/// Writes the collection and its grids; returns the number of grids.
fn write(
    folder: &Path,
    name: &str,
    shape: Option<&DeformedShape>,
    time_series: &TimeSeries,
) -> Result<usize> {
    let is_valid = !name.is_empty() && name.chars().all(is_allowed_in_name);
    require_part("name of a series", is_valid, "letters, digits, - and _ only, one at least")?;
    std::fs::create_dir_all(folder).map_err(write_error(folder))?;

    let mut entries = Vec::new();
    let static_displacement = time_series.static_displacement();
    if let Some(shape) = shape {
        for (k, frame) in time_series.motion_frames().enumerate() {
            let file = format!("{name}_{k:04}.vtu");
            let mut vectors =
                vec![("displacement", frame.displacement), ("velocity", frame.velocity)];
            if !static_displacement.is_empty() {
                vectors.push(("static_displacement", static_displacement));
            }
            let grid = structure_grid(shape, time_series.up(), &vectors)?;
            write_file(&folder.join(&file), grid)?;
            entries.push(CollectionEntry { time: frame.time, part: 0, file });
        }
    }
    let mut point_indices = 0..;
    let mut cells = Vec::new();
    for element in time_series.elements() {
        let corners = point_indices.by_ref().take(element.outline().count());
        cells.push(ShapeCell::flat(corners.collect()));
    }
    for (k, frame) in time_series.contact_frames().enumerate() {
        let file = format!("{name}_base_{k:04}.vtu");
        write_file(&folder.join(&file), base_grid(time_series, &cells, &frame))?;
        entries.push(CollectionEntry { time: frame.time, part: 1, file });
    }
    entries.sort_by(|a, b| a.time.total_cmp(&b.time));
    write_file(&folder.join(format!("{name}.pvd")), collection(&entries))?;
    Ok(entries.len())
}

fn is_allowed_in_name(character: char) -> bool {
    character.is_alphanumeric() || character == '-' || character == '_'
}

/// The vector `[x, y, z]`, z up, in the file's axes: those along the surface, and then `up`.
fn in_file_axes(up: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let mut vector = [x, y, 0.0];
    vector[up] = z;
    vector
}

/// A vector [right, height, away] of a deformed shape in the file's axes.
fn shape_vector(up: usize, [right, height, away]: [f64; 3]) -> [f64; 3] {
    in_file_axes(up, [right, away, height])
}

/// A grid of the structure with the vectors of its points by these values of the degrees of freedom.
fn structure_grid(
    shape: &DeformedShape,
    up: usize,
    vectors: &[(&'static str, &[f64])],
) -> Result<String> {
    let mut point_vectors = Vec::new();
    for &(name, dofs) in vectors {
        let vectors = shape.displacements(dofs)?.into_iter();
        point_vectors.push((name, vectors.map(|vector| shape_vector(up, vector)).collect()));
    }
    let places = shape.points().iter().map(ShapePoint::place);
    let grid = VtuGrid {
        points: places.map(|place| shape_vector(up, place)).collect(),
        cells: shape.grid(),
        point_vectors,
        cell_scalars: Vec::new(),
    };
    Ok(grid.xml())
}

/// A grid of the base with the state of its contact elements.
fn base_grid(time_series: &TimeSeries, cells: &[ShapeCell], frame: &ContactFrame<'_>) -> String {
    let corners = time_series.elements().iter().flat_map(ContactElement::outline);
    let points = corners.map(|place| in_file_axes(time_series.up(), place)).collect();
    let mut cell_scalars = Vec::new();
    for &(name, _, is_in_plan_only, value) in &ContactState::NUMBER_COLUMNS {
        if time_series.in_plan() || !is_in_plan_only {
            cell_scalars.push((name, frame.states.iter().map(value).collect()));
        }
    }
    let modes = frame.modes.iter().map(|mode| f64::from(*mode as u8)).collect();
    cell_scalars.push(("mode", modes));
    VtuGrid { points, cells, point_vectors: Vec::new(), cell_scalars }.xml()
}

/// A grid in a collection.
struct CollectionEntry {
    /// Time of the grid, s.
    time: f64,
    /// 0 for the structure, 1 for the base.
    part: usize,
    /// Name of the grid's file.
    file: String,
}

fn collection(entries: &[CollectionEntry]) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for CollectionEntry { time, part, file } in entries {
        // Writing to a string does not fail.
        let _ = writeln!(
            out,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file}\"/>"
        );
    }
    out + "</Collection>\n</VTKFile>\n"
}

/// Points, cells and data of a `.vtu` file.
pub(super) struct VtuGrid<'a> {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) cells: &'a [ShapeCell],
    pub(super) point_vectors: Vec<(&'static str, Vec<[f64; 3]>)>,
    pub(super) cell_scalars: Vec<(&'static str, Vec<f64>)>,
}

impl VtuGrid<'_> {
    /// The file's text.
    pub(super) fn xml(&self) -> String {
        let points = self.points.len();
        let cells = self.cells.len();
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
            write_array(&mut out, "Float64", name, 3, vectors.iter().map(vector_text));
        }
        out += "</PointData>\n<CellData>\n";
        for (name, values) in &self.cell_scalars {
            write_array(&mut out, "Float64", name, 1, values.iter());
        }
        out += "</CellData>\n<Points>\n";
        write_array(&mut out, "Float64", "points", 3, self.points.iter().map(vector_text));
        out += "</Points>\n<Cells>\n";
        write_array(
            &mut out,
            "Int64",
            "connectivity",
            1,
            self.cells.iter().flat_map(|cell| &cell.points),
        );
        let offsets = self.cells.iter().scan(0, |end, cell| {
            *end += cell.points.len();
            Some(*end)
        });
        write_array(&mut out, "Int64", "offsets", 1, offsets);
        write_array(&mut out, "UInt8", "types", 1, self.cells.iter().map(|cell| cell.form as u8));
        out += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        out
    }
}

fn vector_text([x, y, z]: &[f64; 3]) -> String {
    format!("{x} {y} {z}")
}

/// Appends one array of data, a value a line.
fn write_array<T: Display>(
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
