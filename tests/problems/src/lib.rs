//! Scenes, closed forms and reference tables that tests, benches and studies share, each written once.
//!
//! They panic for scenes that cannot be built.

#![allow(missing_docs, missing_debug_implementations, reason = "not published")]
#![allow(
    clippy::len_without_is_empty,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    reason = "not published"
)]

pub mod block_on_springs;
pub mod boundary_passivity;
pub mod bricks;
pub mod chatter;
pub mod columns;
pub mod contact_problems;
pub mod containment;
pub mod dense;
pub mod directions;
pub mod enumerated_contact;
pub mod faults;
pub mod fiber_frames;
pub mod fiber_tables;
pub mod flexible_scenes;
pub mod headline;
pub mod impedance;
pub mod incoherent_disc;
pub mod laws_with_memory;
pub mod near_field;
pub mod near_field_waves;
pub mod passivity;
pub mod patch;
pub mod prescribed;
pub mod profiles;
pub mod rigid_strip;
pub mod rocking;
pub mod rocking_footing;
pub mod sampled_block;
pub mod scenes;
pub mod settling_law;
pub mod settling_strips;
pub mod soil_box;
pub mod space_beams;
pub mod static_steps;
pub mod stiff_element;
pub mod strip_rotation;
pub mod supported;
pub mod tabled_structures;
pub mod tower;
pub mod truncation;
pub mod welded_block;
pub mod wrapped;
pub mod yielding_blocks;
pub mod yielding_column;
pub mod yielding_convergence;
pub mod yielding_paths;
pub mod yielding_springs;
pub mod yielding_strip;

pub use basemat_testkit::{
    DISTORTED_QUAD_NODES, ReferenceTable, assert_close, check_sum, csv, data_path, heavy, random,
    series, table,
};
