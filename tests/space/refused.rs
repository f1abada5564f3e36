//! Invalid scenes in plan, each with an error that names the fault.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Ground, SpringGround};
use basemat::coupled::Load;
use basemat::coupled::StabilityError;
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{
    Base, BaseNode, MatrixModel, RigidBlock, RigidBody, Structure, StructureGroup, Triplets,
};
use basemat::{Error, Simulation};

use super::cells::{BED, Cells};

fn build(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
    law: impl InterfaceLaw + 'static,
) -> Error {
    let built =
        Simulation::builder(0.01).structure(structure).ground(ground).interface(law).build();
    built.expect_err("an error")
}

fn cube() -> RigidBody {
    RigidBody::cuboid([4.0; 3], 2000.0).unwrap()
}

fn cells() -> Cells {
    Cells::under([4.0; 2], [0.0; 2], [4, 4], BED)
}

fn bed() -> SpringGround {
    SpringGround::new(-2.0..2.0, 4, 1e7, 1e7).unwrap()
}

#[test]
fn bases_of_another_dimension() {
    let error = build(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), cells(), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("faces"), "{error}");
    let error = build(cube(), bed(), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("contact nodes"), "{error}");
    let group = StructureGroup::new().with(cube(), 0.0).unwrap();
    let error = group.with(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), 9.0).err().unwrap();
    assert!(matches!(error, Error::Scene { quantity: "structure of a group", .. }), "{error}");
}

#[test]
fn cells_that_no_face_covers() {
    let error = build(cube(), Cells::under([7.0, 4.0], [0.0; 2], [7, 4], BED), Bonded);
    let quantity = "distance of a contact element from the faces of the base, m";
    let Error::Item { ref item, ref source } = error else { panic!("{error}") };
    assert_eq!(item, "contact element 0");
    let Error::Input { quantity: found, value, .. } = **source else { panic!("{error}") };
    // Gauss points of the outer cells, from the edge at 2 m.
    let pitch = 7.0 / 6.8;
    let expected = pitch * (3.0 + 0.5 / 3.0_f64.sqrt()) - 2.0;
    assert_eq!(found, quantity);
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    // Up to half a cell the base goes on.
    let ground = Cells::under([4.8, 4.0], [0.0; 2], [4, 4], BED);
    assert!(
        Simulation::builder(0.01)
            .structure(cube())
            .ground(ground)
            .interface(Bonded)
            .build()
            .is_ok()
    );
}

/// A load at the top, along x or along y, to the front or to the back: what is said of one axis is said of the other.
#[test]
fn errors_of_stability_name_the_axis_and_the_edge() {
    let weight = STANDARD_GRAVITY * cube().total_mass();
    let fall = |axis: usize, eccentricity: f64| {
        let [along, across, _] = cube().displacement_at([0.0, 0.0, 4.0]);
        let row = [along, across][axis].clone();
        let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 4).unwrap();
        let error = Simulation::builder(0.01)
            .structure(cube())
            .ground(SpringGround::in_plan(plan, [1e7; 3]).unwrap())
            .interface(Coulomb::new(9.0).unwrap())
            .load(Load::constant(row, weight * eccentricity / 4.0))
            .build()
            .expect_err("no equilibrium");
        let text = error.to_string();
        let Error::Stability(cause) = error else { panic!("{error}") };
        (*cause, text)
    };
    for (axis, name, edges) in [(0, 'x', ["left", "right"]), (1, 'y', ["front", "back"])] {
        for (sign, edge) in [-1.0, 1.0].into_iter().zip(edges) {
            let (cause, text) = fall(axis, 2.2 * sign);
            let StabilityError::Overturning { axis: found, eccentricity, ratio, across, .. } =
                cause
            else {
                panic!("{text}")
            };
            assert_eq!((found, across), (Some(name), Some([-2.0, 2.0])));
            assert!((eccentricity - 2.2 * sign).abs() < 1e-6 && (ratio - 1.1).abs() < 1e-6);
            assert!(text.contains(&format!("over its {edge} edge")), "{text}");
            assert!(text.contains(&format!("along {name}")) && !text.contains("/m"), "{text}");
            // Beyond the middle of the last row, 1.5 m.
            let (cause, text) = fall(axis, 1.8 * sign);
            let StabilityError::Beyond { axis: found, resultant, reach, .. } = cause else {
                panic!("{text}")
            };
            assert_eq!((found, reach), (Some(name), [-1.5, 1.5]));
            assert!((resultant - 1.8 * sign).abs() < 1e-6);
            assert!(text.contains(&format!("passes at {name} = ")), "{text}");
        }
    }
}

/// Moves the ends of an element to the right and away, m.
fn stretch(own: &mut ContactElement, [right, front, back]: [f64; 3]) {
    let [low, high] = own.depth();
    let along = [own.left(), own.right() + right];
    *own = ContactElement::in_plan(along, [low + front, high + back]);
}

#[test]
fn elements_that_are_no_cells() {
    let wrong = |change: fn(&mut Cells)| {
        let mut cells = cells();
        change(&mut cells);
        build(cube(), cells, Bonded)
    };
    let quantity = |error: Error| match error {
        Error::Input { quantity, .. } => quantity,
        error => panic!("{error}"),
    };
    // One that has no place in plan, unlike the others.
    let error = wrong(|own| own.elements[3] = ContactElement::new(-1.0, 1.0));
    assert!(matches!(error, Error::Scene { quantity: "contact elements of the ground", .. }));
    let flat = |own: &mut Cells| own.elements[3] = ContactElement::in_plan([0.0, 1.0], [1.0, 1.0]);
    assert_eq!(quantity(wrong(flat)), "depth of a contact element");
    for (stretched, blamed) in [
        ([0.0, 0.0, f64::NAN], "back end of a contact element"),
        ([0.1, 0.0, 0.0], "left end of a contact element"),
        ([0.0, -0.1, 0.0], "left end of a contact element"),
    ] {
        let mut cells = cells();
        stretch(&mut cells.elements[5], stretched);
        assert_eq!(quantity(build(cube(), cells, Bonded)), blamed);
    }
    // In the plane these rows lie on one another.
    let lines = |own: &mut Cells| {
        own.elements.iter_mut().for_each(|e| *e = ContactElement::new(e.left(), e.right()));
    };
    assert_eq!(quantity(wrong(lines)), "left end of a contact element");
    let inside = |own: &mut Cells| own.elements[0] = own.elements[0].with_fraction_inside(1.5);
    assert_eq!(quantity(wrong(inside)), "fraction of an element inside the outline");
}

#[test]
fn bodies_that_are_none() {
    let body = |outline: &[[f64; 2]], inertia| {
        RigidBody::from_mass(outline.to_vec(), 1e4, inertia, [0.0, 0.0, 1.0])
    };
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let round = [[1e4, 0.0, 0.0], [0.0, 1e4, 0.0], [0.0, 0.0, 1e4]];
    assert!(body(&square, round).is_ok());
    let mut tensor = round;
    tensor[0][1] = 1.0;
    assert!(body(&square, tensor).err().unwrap().to_string().contains("symmetric"));
    tensor[0][1] = 1e4;
    tensor[1][0] = 1e4;
    assert!(body(&square, tensor).err().unwrap().to_string().contains("positive definite"));
    assert!(matches!(body(&square[..2], round), Err(Error::Size { found: 2, needed: 3, .. })));
    assert!(RigidBody::cuboid([4.0, 0.0, 4.0], 2000.0).is_err());
    assert!(RigidBody::cylinder(4.0, 4.0, f64::NAN).is_err());
    assert!(RigidBody::from_mass(square.to_vec(), 1e4, round, [0.0, 0.0, -1.0]).is_err());
    let crossed = [square[0], square[2], square[1], square[3]];
    let error = build(body(&crossed, round).unwrap(), cells(), Bonded);
    let Error::Item { item, source } = &error else { panic!("{error}") };
    assert!(item == "face 0" && matches!(**source, Error::Scene { .. }), "{error}");
}

/// A torque beyond friction is named, with what friction gives under even pressure: µ N times the mean distance of the
/// cells from the middle.
#[test]
fn a_torque_beyond_friction_is_named() {
    let weight = 9.80665 * 2000.0 * 108.0;
    let build = |torque: f64| {
        Simulation::builder(4e-3)
            .structure(RigidBody::cuboid([6.0, 6.0, 3.0], 2000.0).unwrap())
            .ground(Cells::under([6.0; 2], [0.0; 2], [4, 4], BED))
            .interface(Coulomb::new(0.5).unwrap())
            .load(Load::new(5, move |_| torque))
            .build()
    };
    // Cells of a bed reach a tenth of their side beyond the edge.
    let places = [-1.5_f64, -0.5, 0.5, 1.5].map(|k| k * 6.0 / 3.8);
    let arms = places.iter().flat_map(|x| places.iter().map(move |y| x.hypot(*y)));
    let most = 0.5 * weight * arms.sum::<f64>() / 16.0;
    assert!(build(0.9 * most).is_ok());
    let Error::Stability(cause) = build(1.1 * most).unwrap_err() else { panic!("another error") };
    let StabilityError::Twisting { torque, resistance, ratio, .. } = *cause else {
        panic!("{cause}")
    };
    assert!(
        (ratio - 1.1).abs() < 1e-6 && (resistance / most - 1.0).abs() < 1e-9,
        "{ratio} {resistance}"
    );
    assert!((torque / (1.1 * most) - 1.0).abs() < 1e-9, "{torque}");
}

/// Forces of the size of rounding are no reason to refuse a base without friction.
#[test]
fn rounding_neither_twists_nor_pushes_off() {
    let weight = 9.80665 * 2000.0 * 108.0;
    let build = |[across, down, torque]: [f64; 3]| {
        let body = RigidBody::cuboid([6.0, 6.0, 3.0], 2000.0).unwrap();
        Simulation::builder(4e-3)
            .ground(SpringGround::under(&body, 4, 4e7, 3e7).unwrap())
            .structure(body)
            .interface(Yielding::new(1.2 * weight / 36.0, 0.0).unwrap())
            .load(Load::new(0, move |_| across))
            .load(Load::new(2, move |_| -down * weight))
            .load(Load::new(5, move |_| torque))
            .build()
    };
    let cause = |load: [f64; 3]| match build(load) {
        Err(Error::Stability(cause)) => *cause,
        other => panic!("{:?}", other.err()),
    };
    for (across, torque) in [(0.0, 1e-20), (1e-20, 0.0), (1e-20, 1e-20)] {
        assert!(build([across, 0.1, torque]).is_ok());
        let cause = cause([across, 0.3, torque]);
        assert!(matches!(cause, StabilityError::BearingFailure { .. }), "{cause}");
    }
    let twisted = cause([0.0, 0.1, 100.0]);
    assert!(matches!(twisted, StabilityError::Twisting { .. }), "{twisted}");
    let pushed = cause([100.0, 0.1, 0.0]);
    assert!(matches!(pushed, StabilityError::Sliding { .. }), "{pushed}");
}

/// A rigid body of 200 t on a convex face with these corners from its `center`, m.
fn on_face(corners: &[[f64; 2]], center: [f64; 2]) -> MatrixModel {
    let masses = [2e5, 2e5, 2e5, 1e6, 1e6, 1e6];
    let mass = Triplets::from_entries(6, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
    let face = BaseNode::rigid_face(corners, center, [0, 1, 2, 3, 4, 5]);
    MatrixModel::new(mass, Triplets::new(6), Base::Faces(vec![face])).unwrap()
}

/// Site coordinates are as good as others: the static state and its moments are those at the origin.
#[test]
fn mats_stand_anywhere() {
    for (side, place) in
        [(2.0, [128.0, -64.0]), (6.0, [500.0, 350.0]), (20.0, [4500.0, 3150.0]), (9.0, [5e5, 4e6])]
    {
        let half = 0.5 * side;
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        let pressures = |center: [f64; 2]| {
            let body = on_face(&corners, center);
            let simulation = Simulation::builder(0.01)
                .ground(SpringGround::under(&body, 4, 4e7, 3e7).unwrap())
                .structure(body)
                .interface(Coulomb::new(0.5).unwrap())
                .build();
            let simulation = simulation.unwrap_or_else(|error| panic!("{center:?}: {error}"));
            simulation.state().contact.iter().map(|own| own.pressure).collect::<Vec<_>>()
        };
        let (there, here) = (pressures(place), pressures([0.0; 2]));
        assert_eq!(there.len(), 16);
        for (there, here) in there.iter().zip(&here) {
            assert!((there / here - 1.0).abs() < 1e-6, "{place:?}: {there} {here}");
        }
    }
}

/// Any convex quadrilateral carries a rigid body, whether or not bilinear displacements have a continuation beyond it.
#[test]
fn all_convex_quadrilaterals_carry_a_rigid_body() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut built = 0;
    for _ in 0..300 {
        let square = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]];
        let corners = square.map(|[x, y]| [x + 6.0 * random() - 3.0, y + 6.0 * random() - 3.0]);
        let body = on_face(&corners, [0.0; 2]);
        // Narrow corners, and faces that are not convex, are refused for other reasons.
        let Ok(ground) = SpringGround::under(&body, 8, 4e7, 3e7) else { continue };
        let simulation =
            Simulation::builder(0.01).ground(ground).structure(body).interface(Bonded).build();
        match simulation {
            Ok(_) => built += 1,
            Err(error) => assert!(!error.to_string().contains("distance"), "{corners:?}: {error}"),
        }
    }
    assert!(built > 150, "{built}");
}
