//! GOAL: invalid input, and two motions at once, are errors.
//! SCENE: empty, degenerate and non-finite boundaries; an incident field beside a motion of the scene.
//! REFERENCE: the typed error.

use basemat::bem::Ground;
use basemat::bem::full_plane::{
    Boundary, BoundaryMarch, FullPlaneGround, Given, Segment, TimeKernel, VerticalWaves,
};
use basemat::interface::Bonded;
use basemat::motion::{AtRest, RickerDisplacement};
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation, unobserved};

use super::soil;
use crate::full_plane::incident_waves::{canyon, waves};

/// GOAL: a boundary that is not flat needs its incident field, and returns an error for a motion of the scene beside it.
#[test]
fn two_motions_are_errors() {
    let mut ground = FullPlaneGround::new(soil(0.25), canyon(0.5));
    assert!(matches!(ground.prepare(0.5, None, &mut unobserved), Err(Error::Scene { .. })));
    let mut ground = ground.with_incident_field(waves()).allow_growth();
    ground.prepare(0.5, None, &mut unobserved).unwrap();
    let mut coefficients = [0.0; 8];
    ground.free_field(&RickerDisplacement::new(1.0, 0.8, 4.0).unwrap(), 4.0, &mut coefficients);
    assert!(coefficients.iter().all(|x| x.is_nan()));
    assert!(matches!(ground.history(&mut coefficients), Err(Error::Scene { .. })));
    // The error of a simulation has the reason.
    let ground = FullPlaneGround::new(soil(0.25), canyon(0.5)).with_incident_field(waves());
    let elements = ground.elements().to_vec();
    let width = elements[elements.len() - 1].right() - elements[0].left();
    let center = elements[0].left() + 0.5 * width;
    let block = RigidBlock::new(width, 0.5, 1.0).unwrap().centered_at(center).unwrap();
    let simulation = Simulation::builder(0.5)
        .structure(block)
        .ground(ground.allow_growth())
        .interface(Bonded)
        .motion(RickerDisplacement::new(1.0, 0.8, 4.0).unwrap());
    let error = simulation.build().map_or_else(Some, |mut s| s.step().err());
    let message = error.unwrap().to_string();
    assert!(message.contains("ground motion"), "{message}");
}

/// Unit element of the surface, from x to the right.
fn unit_element(x: f64) -> Segment {
    Segment { from: [x, 0.0], to: [x + 1.0, 0.0] }
}

/// Time kernel of one element.
fn unit_kernel() -> Box<TimeKernel> {
    Box::new(TimeKernel::new(soil(0.25), &[unit_element(0.0)], 0.5).unwrap())
}

/// GOAL: boundaries, marches and grounds return errors for invalid input.
#[test]
fn invalid_input_is_an_error() {
    let soil = soil(0.25);
    let mut ground = FullPlaneGround::strip(soil, -1.0..1.0, 2, 2).unwrap();
    assert!(matches!(ground.history(&mut [0.0; 4]), Err(Error::Scene { .. })));
    assert!(matches!(ground.step_compliance(&mut [0.0; 16]), Err(Error::Scene { .. })));
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ground.prepare(step, None, &mut unobserved), Err(Error::Input { .. })));
    }
    ground.prepare(0.5, None, &mut unobserved).unwrap();
    assert!(matches!(ground.history(&mut [0.0; 3]), Err(Error::Size { .. })));
    assert!(matches!(ground.step_compliance(&mut [0.0; 15]), Err(Error::Size { .. })));
    assert!(matches!(ground.static_compliance(&mut [0.0; 15]), Err(Error::Size { .. })));
    ground.commit(&[]);
    let not_finite = vec![unit_element(f64::NAN)];
    let point = vec![Segment { from: [1.0; 2], to: [1.0; 2] }];
    let overlapping = vec![unit_element(0.0), unit_element(0.3)];
    let slope = vec![Segment { from: [0.0, 0.0], to: [1.0, 0.1] }];
    assert!(matches!(Boundary::new(vec![], &[]), Err(Error::Size { .. })));
    assert!(matches!(Boundary::new(not_finite, &[0]), Err(Error::Input { .. })));
    assert!(matches!(Boundary::new(point, &[0]), Err(Error::Input { .. })));
    assert!(matches!(Boundary::new(vec![unit_element(0.0)], &[1]), Err(Error::Index { .. })));
    assert!(matches!(Boundary::new(vec![unit_element(0.0)], &[]), Err(Error::Size { .. })));
    assert!(matches!(Boundary::new(overlapping, &[0]), Err(Error::Input { .. })));
    assert!(matches!(Boundary::new(slope, &[0]), Err(Error::Input { .. })));
    assert!(matches!(BoundaryMarch::new(unit_kernel(), &[]), Err(Error::Size { .. })));
    let mut march = BoundaryMarch::new(unit_kernel(), &[Given::Traction; 2]).unwrap();
    assert!(matches!(march.step(&[1.0]), Err(Error::Size { .. })));
    assert!(matches!(VerticalWaves::new(soil, AtRest, f64::NAN), Err(Error::Input { .. })));
}
