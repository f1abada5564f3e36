//! Geometry: contact elements and directions.

mod contact_element;
mod direction;

pub use contact_element::ContactElement;
pub(crate) use contact_element::{COMPONENTS, ContactLayout, check_count, check_order};
pub use direction::Direction;
pub(crate) use direction::{FRAME, TRANSLATIONS};
