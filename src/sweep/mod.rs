//! Many independent simulations: sweeps over parameters, their tables, and shards of both.
//!
//! A [`Sweep`] runs its cases by one closure; with the feature `rayon` on all processors, without it
//! one after the other. Results are the same bit for bit: a simulation is built, marched and dropped
//! on one thread. An error or a panic in one case leaves the others.
//!
//! ```
//! use basemat::prelude::*;
//!
//! let sweep = Sweep::grid([
//!     Parameter::numbers("friction", [0.2, 0.4]),
//!     Parameter::texts("record", ["El Centro", "El Centro, halved"]),
//! ])?;
//! let table = sweep.table(["peak_slip_m"], |case| {
//!     let factor = [1.0, 0.5][case.place("record")?];
//!     let run = Simulation::builder(0.01)
//!         .ground(SpringGround::new(-3.0..3.0, 6, 2.0e7, 1.5e7)?.with_dashpots(4.0e5, 2.0e5)?)
//!         .structure(RigidBlock::new(6.0, 3.0, 2000.0)?)
//!         .interface(Coulomb::new(case.value("friction")?)?)
//!         .motion(el_centro_1940().scaled(factor)?)
//!         .build()?
//!         .run(400, |_| {})?;
//!     basemat::Result::Ok([run.whole.mean_slip.magnitude()])
//! })?;
//!
//! println!("{table}");
//! let slips = table.rows().map(|row| row.value("peak_slip_m"));
//! let slips = slips.collect::<basemat::Result<Vec<_>>>()?;
//! assert!(slips[0] > slips[1] && slips[0] > slips[2]);
//! # Ok::<(), basemat::Error>(())
//! ```
//!
//! Thousands of runs go to many processes: [`Sweep::shard`] takes a share of the cases,
//! [`Sweep::table_in`] keeps its rows in a file from which a killed process goes on, and [`Sweep::merge`]
//! puts the files of all shards together. `docs/guide.md` has a complete job array.

mod file;
mod grid;
mod run;
mod table;
mod tables;

pub use grid::Parameter;
pub use run::{Sweep, SweepCase};
pub use table::{CaseRow, CaseTable};
