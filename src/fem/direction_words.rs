//! Words for directions.

use super::direction::Direction;

words! { Direction, "direction", {
    X = "x",
    Y = "y",
    Rotation = "rotation",
} }
