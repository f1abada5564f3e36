//! GOAL: bases in plan march in three directions, on any ground that has three: bonded, lifting off, sliding.
//! SCENE: rigid bodies on independent springs and dashpots under each cell, and on elastic ground.
//! REFERENCE: equations of motion integrated here, Newton's law, the same body in the plane, symmetry.

mod bearings;
mod cells;
mod elastic;
mod equations;
mod finite_elements;
mod interaction;
mod landing;
mod limits;
mod many_springs;
mod march;
mod mast;
mod model_pictures;
mod motions;
mod outlines;
mod pictures;
mod raft;
mod random;
mod reduced;
mod refused;
mod results;
mod sections;
mod several;
mod shells;
mod slabs;
mod sliding;
mod springs;
mod storeys;
mod torn;
mod uplift;
mod warnings;
mod winkler;
