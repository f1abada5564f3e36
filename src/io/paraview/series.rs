//! Grids of a structure and of its base, from the time series of a run or one by one.

use std::path::Path;

use super::collection::{CollectionEntry, prepare_folder, write_collection};
use super::grid::{VtuGrid, in_file_axes, structure_grid};
use crate::error::{Result, require_part};
use crate::geometry::ContactElement;
use crate::interface::ContactState;
use crate::results::shape_cell::ShapeCell;
use crate::results::{ContactFrame, DeformedShape, TimeSeries};
use crate::text::file::write_file;

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

/// Writes the collection and its grids; returns the number of grids.
fn write_grids(
    folder: &Path,
    name: &str,
    shape: Option<&DeformedShape>,
    time_series: &TimeSeries,
) -> Result<usize> {
    prepare_folder(folder, name)?;
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
    entries.sort_by(|entry, other_entry| entry.time.total_cmp(&other_entry.time));
    write_collection(folder, name, &entries)?;
    Ok(entries.len())
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
