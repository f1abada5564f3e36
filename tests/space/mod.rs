//! GOAL: structures in space move correctly in three directions on any ground: bonded, lifting off, sliding.
//! SCENE: rigid bodies on independent springs and dashpots under each cell, and on elastic ground.
//! REFERENCE: equations of motion integrated here, Newton's law, the same body in the plane, symmetry.

mod bearings;
mod cells;
mod coupled_cubes;
mod elastic;
mod equations;
mod finite_elements;
mod floor_spectra;
mod incoherent_disc;
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
mod plate_element;
mod raft;
mod random;
mod reduced;
mod refused;
mod result_pictures;
mod results;
mod rocking_footing;
mod sections;
mod settling;
mod settling_scenes;
mod several;
mod shells;
mod slabs;
mod sliding;
mod sliding_references;
mod springs;
mod steady_sliding;
mod storey_runs;
mod storeys;
mod tilting;
mod torn;
mod two_mats;
mod uplift;
mod warnings;
mod winkler;
