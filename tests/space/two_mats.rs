//! Bodies that touch or overlap, and cells that do not fit the mats of two bodies.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, PlanError, SpringGround};
use basemat::interface::Bonded;
use basemat::structure::{RigidBlock, RigidBody, StructureGroup};
use basemat::{Error, Simulation, Soil};

use super::cells::{BED_PROPERTIES, SpringCells};
use super::several::{BODY_DENSITY, body, both_bodies};

/// A group of the first body alone.
fn first_body() -> StructureGroup {
    StructureGroup::new().with(body(0, 0), 0.0).unwrap()
}

/// The second body with the middle of its base elsewhere.
fn second_body_at(center: [f64; 2]) -> RigidBody {
    body(1, 0).centered_at(center).unwrap()
}

#[test]
fn bodies_that_touch_or_overlap_are_errors() {
    // Overlapping, crossing without a corner in the other, side to side; a body beside the first is allowed.
    let beam = RigidBody::cuboid([12.0, 2.0, 1.0], BODY_DENSITY).unwrap();
    for second_body in [second_body_at([2.0, 1.0]), second_body_at([6.0, 0.0]), beam] {
        let error = first_body().with(second_body, 0.0).err().unwrap();
        assert!(error.to_string().contains("touch or overlap"), "{error}");
    }
    assert!(first_body().with(second_body_at([6.0, 0.0]), 0.01).is_ok());
    assert!(first_body().with(second_body_at([0.0, 6.01]), 0.0).is_ok());
    let block = RigidBlock::new(4.0, 4.0, BODY_DENSITY).unwrap();
    assert!(first_body().with(block.clone(), 20.0).is_err());
    assert!(StructureGroup::new().with(block, 0.0).unwrap().with(body(0, 0), 20.0).is_err());
    // Half a cell between them.
    let close_bodies = first_body().with(second_body_at([6.75, 0.0]), 0.0).unwrap();
    let soil = Soil::from_shear_wave_speed(120.0, 0.3, 1800.0).unwrap();
    for error in [
        ElasticGround::under(soil, &close_bodies, 4).err().unwrap(),
        SpringGround::under(&close_bodies, 4, 4e7, 3e7).err().unwrap(),
    ] {
        assert!(matches!(error, Error::Plan(PlanError::TooClose { mats: [0, 1], .. })), "{error}");
    }
}

/// The error of both bodies on these cells.
fn cells_error(ground: SpringCells) -> Error {
    let builder = Simulation::builder(0.01).structure(both_bodies(0)).ground(ground);
    builder.interface(Bonded).build().err().unwrap()
}

#[test]
fn cells_that_do_not_fit_two_mats_are_errors() {
    // Cells row by row under both mats: the elements of a mat are not consecutive.
    let lines: Vec<f64> = (-4..=11).map(f64::from).collect();
    let mut rows = SpringCells::between(&lines, &[-3.0, 0.0, 3.0], BED_PROPERTIES);
    rows.elements
        .retain(|element| !(element.center()[0] > 4.0 && element.center()[0] < 7.0));
    let error = cells_error(rows.resized());
    assert!(error.to_string().contains("apart from the others of its mat"), "{error}");
    // One element reaches from one mat to the other.
    let wide_cells = SpringCells::between(&[-4.0, 4.0, 7.0, 11.0], &[-3.0, 3.0], BED_PROPERTIES);
    let error = cells_error(wide_cells);
    assert!(error.to_string().contains("under two mats"), "{error}");
    // No cell is under the second mat.
    let cells_of_first_mat = SpringCells::between(&lines[..9], &[-3.0, 0.0, 3.0], BED_PROPERTIES);
    let error = cells_error(cells_of_first_mat);
    assert!(matches!(error, Error::Size { found: 0, .. }), "{error}");
    // A plan with the first mat alone.
    let plan = Plan::rectangle(-4.0..4.0, -3.0..3.0, 4).unwrap();
    let ground = SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap();
    let builder = Simulation::builder(0.01).structure(both_bodies(0)).ground(ground);
    let result = builder.interface(Bonded).build();
    assert!(matches!(result, Err(Error::Size { found: 0, .. })));
}
