//! The directions in which a node moves.

use basemat::fem::Direction;

/// All directions of a node in space: along the axes, then about them.
pub const NODE_DIRECTIONS: [Direction; 6] = [
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RotationX,
    Direction::RotationY,
    Direction::RotationZ,
];
