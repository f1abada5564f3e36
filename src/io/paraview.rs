//! Files for ParaView: a `.pvd` collection of `.vtu` grids, up to two per frame.
//!
//! The first grid of a frame is the structure. For a [`FemModel`] its cells are the elements in their order: lines,
//! triangles, quadrilaterals, bricks with eight corners, other solids as convex sets of points. Points have the vectors
//! `displacement` (m, change from the static state, relative to the free field), `static_displacement` (m) and `velocity`
//! (m/s, total). ParaView's filter *Warp By Vector* shows the motion of the structure. Applied to the sum of the first two
//! vectors (*Calculator*), it shows the displacement from the unloaded shape.
//!
//! The second grid is the base. It has one line for each contact element, with `pressure` and `shear`
//! (Pa), `gap` and `slip` (m) and `mode` (0 stick, 1 slip to the left, 2 slip to the right, 3 open). In plan
//! it has one rectangle for each element, with `shear_across` and `slip_across` (along y) as well; mode 7 is
//! slip in any direction. Points are (x, y, 0) in the plane, y up, and (x, y, z) in plan, z up; the nodes of the base
//! lie at height zero.
//!
//! A single state, such as the static one or a vibration mode, is a grid by itself ([`write_state`]). So is the state of
//! soil that yields ([`write_solid_state`]).
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
use crate::fem::SolidPoint;
use crate::geometry::ContactElement;
use crate::interface::ContactState;
use crate::results::shape_cell::ShapeCell;
use crate::results::{ContactFrame, DeformedShape, ShapePoint, TimeSeries};
use crate::structure::FemModel;
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
    let needed = "the recorder must keep the motion (`Recorder::motion`)";
    require_part("series of the structure", time_series.motion_frames().next().is_some(), needed)?;
    write_grids(folder.as_ref(), name, Some(shape), time_series)
}

/// Writes `name.pvd` and grids of the base only, for structures without a [`DeformedShape`].
///
/// Each frame of contact in `time_series` gives a grid (`name_base_0000.vtu`, …), as with [`write_series`].
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if no contact was kept ([`crate::results::Recorder::contact`]) or for the
/// name, [`Error::File`](crate::Error::File) if a file cannot be written.
pub fn write_base(folder: impl AsRef<Path>, name: &str, time_series: &TimeSeries) -> Result<usize> {
    let needed = "the recorder must keep the contact (`Recorder::contact`)";
    require_part("series of the base", time_series.contact_frames().next().is_some(), needed)?;
    write_grids(folder.as_ref(), name, None, time_series)
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
    write_file(path.as_ref(), structure_grid(shape, shape.up(), &[("displacement", dofs)])?.xml())
}

/// Writes a grid of the elements with internal variables, with their state at the end of the last step.
///
/// Cells have `plastic_strain`, `mobilised_strength` (from 0 to 1) and `mean_stress` (Pa; tension is positive), means
/// over the integration points of each element. Points have the vectors `displacement` by `dofs`, as for
/// [`write_state`]. During a run, `model` is [`Simulation::structure`](crate::Simulation::structure) after a downcast.
/// The folder is made if it does not exist.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for a model without such elements, errors of their materials,
/// [`Error::Index`](crate::Error::Index) if `dofs` has too few values; [`Error::File`](crate::Error::File) if the file
/// cannot be written.
pub fn write_solid_state(path: impl AsRef<Path>, model: &FemModel, dofs: &[f64]) -> Result<()> {
    let shape = DeformedShape::of_model(model);
    let mut cells = Vec::new();
    let mut plastic_strains = Vec::new();
    let mut mobilised_strengths = Vec::new();
    let mut mean_stresses = Vec::new();
    for element in model.inelastic_elements() {
        let points = model.solid_points(element)?;
        let area: f64 = points.iter().map(|point| point.area).sum();
        let mean = |value: fn(&SolidPoint) -> f64| {
            points.iter().map(|point| point.area * value(point)).sum::<f64>() / area
        };
        plastic_strains.push(mean(|point| point.state.plastic_strain));
        mobilised_strengths.push(mean(|point| point.state.mobilised_strength));
        mean_stresses.push(mean(|point| point.stress[..3].iter().sum::<f64>() / 3.0));
        cells.push(shape.grid()[element].clone());
    }
    require_part("model", !cells.is_empty(), "must have elements with internal variables")?;
    let cell_scalars = vec![
        ("plastic_strain", plastic_strains),
        ("mobilised_strength", mobilised_strengths),
        ("mean_stress", mean_stresses),
    ];
    let grid = structure_grid(&shape, shape.up(), &[("displacement", dofs)])?;
    write_file(path.as_ref(), VtuGrid { cells: &cells, cell_scalars, ..grid }.xml())
}

/// Writes the collection and its grids; returns the number of grids.
fn write_grids(
    folder: &Path,
    name: &str,
    shape: Option<&DeformedShape>,
    time_series: &TimeSeries,
) -> Result<usize> {
    let is_valid_name = !name.is_empty() && name.chars().all(is_allowed_in_name);
    require_part("name of a series", is_valid_name, "letters, digits, - and _ only, one at least")?;
    std::fs::create_dir_all(folder).map_err(write_error(folder))?;

    let mut entries = Vec::new();
    let static_displacement = time_series.static_displacement();
    if let Some(shape) = shape {
        for (k, frame) in time_series.motion_frames().enumerate() {
            let file_name = format!("{name}_{k:04}.vtu");
            let mut vectors =
                vec![("displacement", frame.displacement), ("velocity", frame.velocity)];
            if !static_displacement.is_empty() {
                vectors.push(("static_displacement", static_displacement));
            }
            let grid = structure_grid(shape, time_series.up(), &vectors)?;
            write_file(&folder.join(&file_name), grid.xml())?;
            entries.push(CollectionEntry { time: frame.time, part: 0, file_name });
        }
    }
    let mut point_indices = 0..;
    let mut cells = Vec::new();
    for element in time_series.elements() {
        let corners = point_indices.by_ref().take(element.outline().count());
        cells.push(ShapeCell::flat(corners.collect()));
    }
    for (k, frame) in time_series.contact_frames().enumerate() {
        let file_name = format!("{name}_base_{k:04}.vtu");
        write_file(&folder.join(&file_name), base_grid(time_series, &cells, &frame))?;
        entries.push(CollectionEntry { time: frame.time, part: 1, file_name });
    }
    entries.sort_by(|entry, other| entry.time.total_cmp(&other.time));
    write_file(&folder.join(format!("{name}.pvd")), collection(&entries))?;
    Ok(entries.len())
}

/// Whether the name of a series may contain a character.
fn is_allowed_in_name(character: char) -> bool {
    character.is_alphanumeric() || character == '-' || character == '_'
}

/// A vector [x, y, z], z up, in the axes of the file.
///
/// `up_axis`: index of the file's axis that points up.
fn in_file_axes(up_axis: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
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
fn structure_grid<'a>(
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

/// Text of a grid of the base with the state of its contact elements.
fn base_grid(time_series: &TimeSeries, cells: &[ShapeCell], frame: &ContactFrame<'_>) -> String {
    let corners = time_series.elements().iter().flat_map(ContactElement::outline);
    let points = corners.map(|corner| in_file_axes(time_series.up(), corner)).collect();
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

/// Entry of a grid in a collection.
struct CollectionEntry {
    /// Time of the grid, s.
    time: f64,
    /// 0 for the structure, 1 for the base.
    part: usize,
    /// Name of the grid's file.
    file_name: String,
}

/// Text of a `.pvd` file with these grids.
fn collection(entries: &[CollectionEntry]) -> String {
    let mut xml_text = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for CollectionEntry { time, part, file_name } in entries {
        // Writing to a string does not fail.
        let _ = writeln!(
            xml_text,
            "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file_name}\"/>"
        );
    }
    xml_text + "</Collection>\n</VTKFile>\n"
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
