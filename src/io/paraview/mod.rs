//! Files for ParaView: a `.pvd` collection of `.vtu` grids, one pair for every frame.
//!
//! The first grid of a frame is the structure, with the vectors `displacement` (m, change against
//! the static state, relative to the free field) and `velocity` (m/s, total) at its points: apply
//! *Warp By Vector* to see it move. The
//! second is the base, a line for every contact element, with `pressure` and `shear` (Pa), `gap` and
//! `slip` (m) and `mode` (0 stick, 1 slip to the left, 2 slip to the right, 3 open).
//!
//! Files are ASCII XML as in *VTK File Formats* (Kitware, for VTK 4.2 and later), and need no library.
//!
//! ```no_run
//! # fn scene() -> basemat::Result<(basemat::Simulation, basemat::structure::RigidBlock)> { unimplemented!() }
//! use basemat::results::{Recorder, Wireframe};
//! let (mut simulation, block) = scene()?;
//! let shape = Wireframe::of_block(&block, 10.0)?;
//! let mut histories = Recorder::new().contact(10).motion(10).start(&simulation)?;
//! simulation.run(2000, |state| histories.record(state))?;
//! // results/block.pvd, block_0000.vtu, block_base_0000.vtu, …
//! basemat::io::paraview::write_series("results", "block", &shape, &histories)?;
//! # Ok::<(), basemat::Error>(())
//! ```

mod grid;
mod series;

pub use series::write_series;
