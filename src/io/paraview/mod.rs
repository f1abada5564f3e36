//! Files for ParaView: a `.pvd` collection of `.vtu` grids, up to two per frame.
//!
//! The first grid of a frame is the structure. For a [`FemModel`](crate::structure::FemModel) its cells are the
//! elements in their order: lines, triangles, quadrilaterals, bricks with eight corners, other solids as convex sets of
//! points. Points have the vectors `displacement` (m, change from the static state, relative to the free field),
//! `static_displacement` (m) and `velocity` (m/s, total). ParaView's filter *Warp By Vector* shows the motion of the
//! structure. Applied to the sum of the first two vectors (*Calculator*), it shows the displacement from the unloaded
//! shape.
//!
//! The second grid is the base. It has one line for each contact element, with `pressure` and `shear`
//! (Pa), `gap` and `slip` (m) and `mode` (0 stick, 1 slip to the left, 2 slip to the right, 3 open). In plan
//! it has one rectangle for each element, with `shear_across` and `slip_across` (along y) as well; mode 7 is
//! slip in any direction. Points are (x, y, 0) in the plane, y up, and (x, y, z) in plan, z up; the nodes of the base
//! lie at height zero.
//!
//! A single state, such as the static one or a vibration mode, is a grid by itself ([`write_state`]). So is the state of
//! soil that yields ([`write_solid_state`]); [`SolidSeries`] writes a series of such states while a run proceeds.
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

mod collection;
mod grid;
mod series;
mod solids;

pub use series::{write_base, write_series, write_state};
pub use solids::{SolidSeries, write_solid_state};
