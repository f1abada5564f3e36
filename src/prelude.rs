//! Names that most programs use: `use basemat::prelude::*;`.

pub use crate::bem::{ElasticGround, Ground, SpringGround, Strip};
pub use crate::coupled::{Load, Probe, State};
pub use crate::interface::{Bonded, Coulomb, InterfaceLaw};
pub use crate::motion::{FreeField, Record, STANDARD_GRAVITY, el_centro_1940};
pub use crate::results::{Comparison, Quantity, Recorder, Run, TimeSeries};
pub use crate::soil::Soil;
pub use crate::structure::{
    Base, BaseNode, FemModel, RayleighDamping, RigidBlock, ShearBuilding, Storey, Structure,
    StructureGroup, Triplets,
};
pub use crate::sweep::{Parameter, Sweep};
pub use crate::{Simulation, unobserved};
