//! GOAL: bonded bases in plan march in three directions, on any ground that has three.
//! SCENE: rigid bodies on independent springs and dashpots under each cell.
//! REFERENCE: equations of motion integrated here, Newton's law, the same body in the plane, symmetry.

mod cells;
mod elastic;
mod equations;
mod march;
mod mast;
mod refused;
mod springs;
mod storeys;
mod uplift;
mod warnings;
