//! Straight beams and columns, in the plane and in space.

mod axes;
mod axial_force;
mod bar;
mod bending;
mod end_frame;
mod plane;
mod releases;
mod section;
mod space;

pub(crate) use end_frame::EndFrame;
pub use plane::Beam;
pub use section::BeamSection;
pub use space::SpaceBeam;
