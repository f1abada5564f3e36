//! Straight beams and columns, in the plane and in space.

mod axes;
mod deformed_fibers;
mod fiber_beam;
mod local_matrices;
mod plane;
mod releases;
mod section;
mod space;
mod space_fiber_beam;

pub(crate) use axes::EndFrame;
pub use fiber_beam::FiberBeam;
pub use plane::Beam;
pub use section::BeamSection;
pub use space::SpaceBeam;
pub use space_fiber_beam::SpaceFiberBeam;
