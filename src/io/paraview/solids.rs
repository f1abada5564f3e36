//! States of solids that yield, as cell data: one by one, or as a series.

use std::path::{Path, PathBuf};

use super::collection::{CollectionEntry, prepare_folder, write_collection};
use super::grid::{VtuGrid, structure_grid};
use crate::error::{Result, finite, require, require_part};
use crate::fem::SolidPoint;
use crate::results::DeformedShape;
use crate::structure::FemModel;
use crate::text::file::write_file;

/// Writes a grid of the elements with internal variables, with their state at the end of the last step.
///
/// Cells have `plastic_strain`, `mobilised_strength` (from 0 to 1) and `mean_stress` (Pa; tension is positive), means
/// over the integration points of each element. Points have the vectors `displacement` by `dofs`, as for
/// [`write_state`](super::write_state). During a run, `model` is [`Simulation::structure`](crate::Simulation::structure) after a downcast.
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

/// Series of grids of the elements with internal variables, written while a run proceeds.
///
/// Internal variables exist only at the present step, so that no grid can be written after the run. Each grid is one of
/// [`write_solid_state`]: `name_0000.vtu`, … The collection `name.pvd` is complete after every grid.
///
/// ```
/// use std::any::Any;
///
/// use basemat::fem::{Iwan, Mesh};
/// use basemat::io::paraview::SolidSeries;
/// use basemat::prelude::*;
///
/// let clay = Iwan::hyperbolic(20.0e6, 60.0e3, 0.6, 0.45, 1800.0)?;
/// let block = Mesh::quad8_block(&[-2.0, 0.0, 2.0], &[0.0, 2.0], |_, _| clay.clone())?;
/// let model = FemModel::on_base(block)?;
/// let mut simulation = Simulation::builder(0.01)
///     .ground(SpringGround::under(&model, 8, 1.0e8, 1.0e8)?)
///     .structure(model)
///     .interface(Bonded)
///     .motion(el_centro_1940())
///     .build()?;
/// let folder = std::env::temp_dir().join("basemat_solid_series");
/// let mut series = SolidSeries::new(&folder, "clay")?;
/// let mut run = simulation.begin_run();
/// for step in 1..=20 {
///     run.record(simulation.step()?);
///     if step % 10 == 0 {
///         let structure: &dyn Any = simulation.structure();
///         let model: &FemModel = structure.downcast_ref().expect("the structure is a FemModel");
///         let state = simulation.state();
///         series.write(state.time, model, state.displacement())?;
///     }
/// }
/// let run = simulation.end_run(run);
/// assert_eq!((series.grid_count(), run.steps), (2, 20));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug)]
pub struct SolidSeries {
    folder: PathBuf,
    name: String,
    entries: Vec<CollectionEntry>,
}

impl SolidSeries {
    /// Series without grids, whose files begin with `name`; makes the folder if it does not exist.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) if the name contains anything but letters, digits, `-` and `_`;
    /// [`Error::File`](crate::Error::File) if the folder cannot be made.
    pub fn new(folder: impl AsRef<Path>, name: &str) -> Result<Self> {
        let folder = folder.as_ref();
        prepare_folder(folder, name)?;
        Ok(Self { folder: folder.to_owned(), name: name.to_owned(), entries: Vec::new() })
    }

    /// Writes the grid of a time (s) and the collection of all grids so far.
    ///
    /// `model` and `dofs` are those of [`write_solid_state`] at the end of the present step. For a member of a
    /// [`StructureGroup`](crate::structure::StructureGroup) they are the member and its part of the degrees of freedom.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a time that is not finite or not after that of the last grid; as for
    /// [`write_solid_state`].
    pub fn write(&mut self, time: f64, model: &FemModel, dofs: &[f64]) -> Result<()> {
        finite("time of a grid", time)?;
        let last_time = self.entries.last().map_or(f64::NEG_INFINITY, |entry| entry.time);
        require("time of a grid", time, time > last_time, "after the time of the last grid")?;
        let file_name = format!("{}_{:04}.vtu", self.name, self.entries.len());
        write_solid_state(self.folder.join(&file_name), model, dofs)?;
        self.entries.push(CollectionEntry { time, part: 0, file_name });
        write_collection(&self.folder, &self.name, &self.entries)
    }

    /// Number of grids so far.
    pub fn grid_count(&self) -> usize {
        self.entries.len()
    }
}
