//! GOAL: the same physics two ways gives the same results, whichever parts meet.
//! SCENE: random scenes of all pairs of grounds, structures, laws, motions, schemes and coordinates that a builder
//! accepts, from `parts.rs`; HEAVY_TESTS: some twenty times as many.
//! REFERENCE: the same scene written another way, each row with its limit.
//!
//! `cargo test --test heavy identities -- --nocapture` prints the scenes and pairs of parts that each row covered.

mod beds;
mod blueprint;
mod compare;
mod fiber_beams;
mod fiber_frames;
mod full_plane;
mod gmsh;
mod grounds;
mod models;
mod numbers;
mod one_body;
mod parts;
mod records;
mod resumed_soil;
mod rigid_motions;
mod same_soil;
mod scene;
mod slow_loads;
mod steps;
mod structures;
mod table;
mod tally;
mod tied_soil;
mod trenches;
mod turned;
mod user;
mod view;
mod views;
mod writings;
mod yielding_elements;
mod yielding_hinges;
mod yielding_soil;
