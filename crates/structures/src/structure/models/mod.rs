//! Models of structures: rigid bodies, buildings, finite elements, matrices, groups.

mod base_reactions;
mod beam_rows;
mod cut;
mod dof_names;
mod element_state;
mod feet;
mod fem_model;
mod group;
mod group_forces;
#[cfg(feature = "embedded")]
mod in_trench;
mod inelastic_elements;
mod line_load;
mod linked;
mod matrix_model;
mod model_nodes;
mod p_delta;
mod rigid_block;
mod rigid_body;
mod rigid_links;
mod rigid_motion;
mod section;
mod shear_building;
mod shear_damping;
mod shell_rows;
mod soil_at_rest;
mod storey_building;
mod storey_laws;
mod storey_section;
mod with_elements;
#[cfg(feature = "embedded")]
mod with_walls;

pub use beam_rows::{BeamEndRows, BeamRows};
pub use fem_model::FemModel;
pub use group::StructureGroup;
pub use matrix_model::MatrixModel;
pub use rigid_block::RigidBlock;
pub use rigid_body::RigidBody;
pub use section::{Section, SpaceSection};
pub use shear_building::{ShearBuilding, Storey};
pub use shell_rows::ShellRows;
pub use storey_building::{PlanStorey, StoreyBuilding};
pub use storey_laws::IsolationLevel;
pub use with_elements::WithElements;
#[cfg(feature = "embedded")]
pub use with_walls::WithWalls;
