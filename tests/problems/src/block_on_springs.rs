//! A block on springs, for scenes of many tests.

use basemat::bem::SpringGround;
use basemat::structure::RigidBlock;

/// A block 4 m wide and 3 m high.
pub fn block() -> RigidBlock {
    RigidBlock::new(4.0, 3.0, 2000.0).unwrap()
}

/// Springs under the block.
pub fn bed(elements: usize) -> SpringGround {
    SpringGround::new(-2.0..2.0, elements, 4.0e7, 2.0e7).unwrap()
}
