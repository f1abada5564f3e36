//! GOAL: waves from below pass a box of the soil around it as if it were not there.
//! SCENE: a box of soil at rest around a foundation, without the foundation, under vertical and inclined shear waves.
//! REFERENCE: closed forms of the waves at depth.

use basemat_problems::near_field_waves::free_field_difference;

/// GOAL: the error of every node is below 0.5 % of the largest motion in the box.
#[test]
fn every_node_of_the_box_moves_as_the_free_field() {
    for angle in [0.0, 0.35] {
        let difference = free_field_difference(angle).unwrap();
        println!("{angle} rad: {:.3} %", 100.0 * difference);
        assert!(difference < 0.005, "{angle} rad: {difference}");
    }
}
