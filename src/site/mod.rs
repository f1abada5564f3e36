//! Site response: vertically travelling waves in layered ground.

mod column;

pub use column::{Column, ControlPoint, VerticalWave};
