//! Invalid scenes in space, each with an error that names the fault.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Ground, SpringGround};
use basemat::coupled::{Load, StabilityError};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{
    Base, BaseNode, MatrixModel, RigidBlock, RigidBody, Structure, StructureGroup, Triplets,
};
use basemat::{Error, Result, Simulation};

use super::cells::{BED_PROPERTIES, SpringCells};

/// The error of a scene that cannot be built.
fn build_error(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
    law: impl InterfaceLaw + 'static,
) -> Error {
    let result =
        Simulation::builder(0.01).structure(structure).ground(ground).interface(law).build();
    result.expect_err("an error")
}

fn cube() -> RigidBody {
    RigidBody::cuboid([4.0; 3], 2000.0).unwrap()
}

/// Cells under the cube.
fn cells() -> SpringCells {
    SpringCells::under([4.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES)
}

/// A body of 6 m × 6 m × 3 m.
fn flat_body() -> RigidBody {
    RigidBody::cuboid([6.0, 6.0, 3.0], 2000.0).unwrap()
}

const FLAT_BODY_WEIGHT: f64 = 9.80665 * 2000.0 * 108.0;

#[test]
fn bases_of_another_dimension_are_errors() {
    let error = build_error(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), cells(), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("faces"), "{error}");
    let strip_bed = SpringGround::new(-2.0..2.0, 4, 1e7, 1e7).unwrap();
    let error = build_error(cube(), strip_bed, Bonded);
    assert!(matches!(error, Error::Scene { quantity: "structure", .. }), "{error}");
    assert!(error.to_string().contains("contact nodes"), "{error}");
    let group = StructureGroup::new().with(cube(), 0.0).unwrap();
    let error = group.with(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), 9.0).err().unwrap();
    assert!(matches!(error, Error::Scene { quantity: "structure of a group", .. }), "{error}");
}

#[test]
fn cells_that_no_face_covers_are_errors() {
    let wide_cells = SpringCells::under([7.0, 4.0], [0.0; 2], [7, 4], BED_PROPERTIES);
    let error = build_error(cube(), wide_cells, Bonded);
    let Error::Item { ref item, ref source } = error else { panic!("{error}") };
    assert_eq!(item, "contact element 0");
    let Error::Input { quantity, value, .. } = **source else { panic!("{error}") };
    assert_eq!(quantity, "distance of a contact element from the faces of the base, m");
    // Gauss points of the outer cells, from the edge at 2 m.
    let pitch = 7.0 / 6.8;
    let expected = pitch * (3.0 + 0.5 / 3.0_f64.sqrt()) - 2.0;
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    // A base may reach up to half a cell beyond its cells.
    let ground = SpringCells::under([4.8, 4.0], [0.0; 2], [4, 4], BED_PROPERTIES);
    let builder = Simulation::builder(0.01).structure(cube()).ground(ground).interface(Bonded);
    assert!(builder.build().is_ok());
}

/// The stability error of a cube under a load at its top along an axis.
fn fall(axis: usize, eccentricity: f64) -> StabilityError {
    let row = cube().displacement_at([0.0, 0.0, 4.0])[axis].clone();
    let weight = STANDARD_GRAVITY * cube().total_mass();
    let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 4).unwrap();
    let error = Simulation::builder(0.01)
        .structure(cube())
        .ground(SpringGround::in_plan(plan, [1e7; 3]).unwrap())
        .interface(Coulomb::new(9.0).unwrap())
        .load(Load::constant(row, weight * eccentricity / 4.0))
        .build()
        .expect_err("no equilibrium");
    let Error::Stability(cause) = error else { panic!("{error}") };
    *cause
}

/// A load at the top, along x or along y, in the positive or negative direction: both axes have the same errors.
#[test]
fn errors_of_stability_name_the_axis_and_the_edge() {
    for (axis, name, edges) in [(0, 'x', ["left", "right"]), (1, 'y', ["front", "back"])] {
        for (sign, edge) in [-1.0, 1.0].into_iter().zip(edges) {
            let cause = fall(axis, 2.2 * sign);
            let text = cause.to_string();
            let StabilityError::Overturning {
                axis: named_axis, eccentricity, ratio, across, ..
            } = cause
            else {
                panic!("{text}")
            };
            assert_eq!(named_axis, Some(name));
            assert_eq!(across, Some([-2.0, 2.0]));
            assert!((eccentricity - 2.2 * sign).abs() < 1e-6 && (ratio - 1.1).abs() < 1e-6);
            assert!(text.contains(&format!("over its {edge} edge")), "{text}");
            assert!(text.contains(&format!("along {name}")) && !text.contains("/m"), "{text}");
            // Beyond the middle of the last row, 1.5 m.
            let cause = fall(axis, 1.8 * sign);
            let text = cause.to_string();
            let StabilityError::Beyond { axis: named_axis, resultant, reach, .. } = cause else {
                panic!("{text}")
            };
            assert_eq!(named_axis, Some(name));
            assert_eq!(reach, [-1.5, 1.5]);
            assert!((resultant - 1.8 * sign).abs() < 1e-6);
            assert!(text.contains(&format!("passes at {name} = ")), "{text}");
        }
    }
}

/// The quantity that the error of a cube on these cells names.
fn invalid_quantity(cells: SpringCells) -> &'static str {
    match build_error(cube(), cells, Bonded) {
        Error::Input { quantity, .. } => quantity,
        error => panic!("{error}"),
    }
}

/// The cells of the cube with one of them replaced.
fn with_element(index: usize, element: ContactElement) -> SpringCells {
    let mut cells = cells();
    cells.elements[index] = element;
    cells
}

#[test]
fn elements_that_are_no_cells_are_errors() {
    // An element without a place in plan, unlike the others.
    let error = build_error(cube(), with_element(3, ContactElement::new(-1.0, 1.0)), Bonded);
    assert!(matches!(error, Error::Scene { quantity: "contact elements of the ground", .. }));
    let element_without_depth = ContactElement::in_plan([0.0, 1.0], [1.0, 1.0]);
    assert_eq!(
        invalid_quantity(with_element(3, element_without_depth)),
        "depth of a contact element"
    );
    // Shifts of the right, front and back end of an element, m.
    for (right, front, back, expected) in [
        (0.0, 0.0, f64::NAN, "back end of a contact element"),
        (0.1, 0.0, 0.0, "left end of a contact element"),
        (0.0, -0.1, 0.0, "left end of a contact element"),
    ] {
        let element = &cells().elements[5];
        let [low, high] = element.depth();
        let ends = [element.left(), element.right() + right];
        let stretched_element = ContactElement::in_plan(ends, [low + front, high + back]);
        assert_eq!(invalid_quantity(with_element(5, stretched_element)), expected);
    }
    // In the plane the elements of these rows overlap.
    let mut lines = cells();
    for element in &mut lines.elements {
        *element = ContactElement::new(element.left(), element.right());
    }
    assert_eq!(invalid_quantity(lines), "left end of a contact element");
    let too_far_inside = cells().elements[0].with_fraction_inside(1.5);
    assert_eq!(
        invalid_quantity(with_element(0, too_far_inside)),
        "fraction of an element inside the outline"
    );
}

/// A body of 10 t on an outline.
fn body_on(outline: &[[f64; 2]], inertia: [[f64; 3]; 3]) -> Result<RigidBody> {
    RigidBody::from_mass(outline.to_vec(), 1e4, inertia, [0.0, 0.0, 1.0])
}

#[test]
fn invalid_bodies_are_errors() {
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let sphere_inertia = [[1e4, 0.0, 0.0], [0.0, 1e4, 0.0], [0.0, 0.0, 1e4]];
    assert!(body_on(&square, sphere_inertia).is_ok());
    let mut inertia = sphere_inertia;
    inertia[0][1] = 1.0;
    let error = body_on(&square, inertia).err().unwrap();
    assert!(error.to_string().contains("symmetric"));
    inertia[0][1] = 1e4;
    inertia[1][0] = 1e4;
    let error = body_on(&square, inertia).err().unwrap();
    assert!(error.to_string().contains("positive definite"));
    assert!(matches!(
        body_on(&square[..2], sphere_inertia),
        Err(Error::Size { found: 2, needed: 3, .. })
    ));
    assert!(RigidBody::cuboid([4.0, 0.0, 4.0], 2000.0).is_err());
    assert!(RigidBody::cylinder(4.0, 4.0, f64::NAN).is_err());
    assert!(RigidBody::from_mass(square.to_vec(), 1e4, sphere_inertia, [0.0, 0.0, -1.0]).is_err());
    let crossed_outline = [square[0], square[2], square[1], square[3]];
    let error = build_error(body_on(&crossed_outline, sphere_inertia).unwrap(), cells(), Bonded);
    let Error::Item { item, source } = &error else { panic!("{error}") };
    assert!(item == "face 0" && matches!(**source, Error::Scene { .. }), "{error}");
}

/// The flat body on cells under a torque.
fn build_twisted(torque: f64) -> Result<Simulation> {
    Simulation::builder(4e-3)
        .structure(flat_body())
        .ground(SpringCells::under([6.0; 2], [0.0; 2], [4, 4], BED_PROPERTIES))
        .interface(Coulomb::new(0.5).unwrap())
        .load(Load::new(5, move |_| torque))
        .build()
}

/// The error of a torque beyond friction has the torque that friction resists under even pressure: µ N times the mean
/// distance of the cells from the middle.
#[test]
fn a_torque_beyond_friction_is_named() {
    // Cells of a bed reach a tenth of their side beyond the edge.
    let places = [-1.5_f64, -0.5, 0.5, 1.5].map(|k| k * 6.0 / 3.8);
    let arms = places.iter().flat_map(|x| places.iter().map(move |y| x.hypot(*y)));
    let friction_torque = 0.5 * FLAT_BODY_WEIGHT * arms.sum::<f64>() / 16.0;
    assert!(build_twisted(0.9 * friction_torque).is_ok());
    let Error::Stability(cause) = build_twisted(1.1 * friction_torque).unwrap_err() else {
        panic!("another error")
    };
    let StabilityError::Twisting { torque, resistance, ratio, .. } = *cause else {
        panic!("{cause}")
    };
    assert!((ratio - 1.1).abs() < 1e-6, "{ratio}");
    assert!((resistance / friction_torque - 1.0).abs() < 1e-9, "{resistance}");
    assert!((torque / (1.1 * friction_torque) - 1.0).abs() < 1e-9, "{torque}");
}

/// Constant loads on the flat body.
#[derive(Clone, Copy)]
struct SmallLoads {
    /// Horizontal load along x, N.
    push: f64,
    /// Downward load, relative to the weight.
    downward_load: f64,
    /// Torque, N·m.
    torque: f64,
}

impl SmallLoads {
    /// The flat body on a bed without friction, which bears 1.2 times its weight.
    fn build(self) -> Result<Simulation> {
        let body = flat_body();
        Simulation::builder(4e-3)
            .ground(SpringGround::under(&body, 4, 4e7, 3e7).unwrap())
            .structure(body)
            .interface(Yielding::new(1.2 * FLAT_BODY_WEIGHT / 36.0, 0.0).unwrap())
            .load(Load::new(0, move |_| self.push))
            .load(Load::new(2, move |_| -self.downward_load * FLAT_BODY_WEIGHT))
            .load(Load::new(5, move |_| self.torque))
            .build()
    }

    fn stability_error(self) -> StabilityError {
        match self.build() {
            Err(Error::Stability(cause)) => *cause,
            other => panic!("{:?}", other.err()),
        }
    }
}

/// Forces of the size of rounding are allowed on a base without friction.
#[test]
fn loads_of_the_size_of_rounding_are_allowed() {
    for (push, torque) in [(0.0, 1e-20), (1e-20, 0.0), (1e-20, 1e-20)] {
        assert!(SmallLoads { push, downward_load: 0.1, torque }.build().is_ok());
        let cause = SmallLoads { push, downward_load: 0.3, torque }.stability_error();
        assert!(matches!(cause, StabilityError::BearingFailure { .. }), "{cause}");
    }
    let torsion_error =
        SmallLoads { push: 0.0, downward_load: 0.1, torque: 100.0 }.stability_error();
    assert!(matches!(torsion_error, StabilityError::Twisting { .. }), "{torsion_error}");
    let sliding_error =
        SmallLoads { push: 100.0, downward_load: 0.1, torque: 0.0 }.stability_error();
    assert!(matches!(sliding_error, StabilityError::Sliding { .. }), "{sliding_error}");
}

/// A rigid body of 200 t on a convex face with these corners from its `center`, m.
fn on_face(corners: &[[f64; 2]], center: [f64; 2]) -> MatrixModel {
    let masses = [2e5, 2e5, 2e5, 1e6, 1e6, 1e6];
    let mass = Triplets::from_entries(6, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
    let face = BaseNode::rigid_face(corners, center, [0, 1, 2, 3, 4, 5]);
    MatrixModel::new(mass, Triplets::new(6), Base::Faces(vec![face])).unwrap()
}

/// Static pressures of a square body whose middle is at `center`.
fn pressures_at(center: [f64; 2], side: f64) -> Vec<f64> {
    let half = 0.5 * side;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let body = on_face(&corners, center);
    let simulation = Simulation::builder(0.01)
        .ground(SpringGround::under(&body, 4, 4e7, 3e7).unwrap())
        .structure(body)
        .interface(Coulomb::new(0.5).unwrap())
        .build();
    let simulation = simulation.unwrap_or_else(|error| panic!("{center:?}: {error}"));
    simulation.state().contact.iter().map(|contact| contact.pressure).collect()
}

/// Site coordinates have no effect: the static state and its moments are those at the origin.
#[test]
fn static_states_do_not_depend_on_the_place() {
    for (side, place) in
        [(2.0, [128.0, -64.0]), (6.0, [500.0, 350.0]), (20.0, [4500.0, 3150.0]), (9.0, [5e5, 4e6])]
    {
        let computed = pressures_at(place, side);
        let expected = pressures_at([0.0; 2], side);
        assert_eq!(computed.len(), 16);
        for (computed, expected) in computed.iter().zip(&expected) {
            assert!((computed / expected - 1.0).abs() < 1e-6, "{place:?}: {computed} {expected}");
        }
    }
}

/// Random numbers in [0, 1) by a linear congruential generator.
struct Congruential(u64);

impl Congruential {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Any convex quadrilateral carries a rigid body, whether or not bilinear displacements have a continuation beyond it.
#[test]
fn all_convex_quadrilaterals_carry_a_rigid_body() {
    let mut random = Congruential(7);
    let mut built_count = 0;
    for _ in 0..300 {
        let square = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]];
        let corners = square
            .map(|[x, y]| [x + 6.0 * random.uniform() - 3.0, y + 6.0 * random.uniform() - 3.0]);
        let body = on_face(&corners, [0.0; 2]);
        // Narrow corners, and faces that are not convex, cause other errors.
        let Ok(ground) = SpringGround::under(&body, 8, 4e7, 3e7) else { continue };
        let simulation =
            Simulation::builder(0.01).ground(ground).structure(body).interface(Bonded).build();
        match simulation {
            Ok(_) => built_count += 1,
            Err(error) => assert!(!error.to_string().contains("distance"), "{corners:?}: {error}"),
        }
    }
    assert!(built_count > 150, "{built_count}");
}
