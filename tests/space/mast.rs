//! A mass on horizontal springs above a rigid body: wrapped, reduced, and in all coordinates; bodies by their matrices.

use std::f64::consts::TAU;

use basemat::coupled::Coordinates;
use basemat::interface::Bonded;
use basemat::structure::{
    Base, CraigBampton, DofCombination, MatrixModel, ModalDamping, PlanStorey, RigidBody,
    StoreyBuilding, Structure, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation};

use super::cells::{BED_PROPERTIES, CrossingPulses, SpringCells};
use super::storeys;

const BODY_SIDES: [f64; 3] = [8.0, 6.0, 3.0];
const BODY_CENTER: [f64; 2] = [3.0, 1.0];
const BODY_DENSITY: f64 = 2000.0;
/// Mass above the middle of the base, kg.
const TOP_MASS: f64 = 1.2e5;
const TOP_HEIGHT: f64 = 11.0;
/// Stiffness along x and y, N/m.
const SPRING_STIFFNESS: [f64; 2] = [9.0e7, 5.0e7];

/// The body, with the mass on springs as its seventh and eighth degree of freedom.
struct Mast(RigidBody);

fn body(density: f64) -> RigidBody {
    RigidBody::cuboid(BODY_SIDES, density).unwrap().centered_at(BODY_CENTER).unwrap()
}

fn mast() -> Mast {
    Mast(body(BODY_DENSITY))
}

impl Structure for Mast {
    fn dofs(&self) -> usize {
        8
    }
    fn base(&self) -> Base {
        self.0.base()
    }
    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.mass(matrix)?;
        // The mass moves vertically with the body.
        for i in [2, 6, 7] {
            matrix.add(i, i, TOP_MASS);
        }
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        let body_motions = self.0.displacement_at([0.0, 0.0, TOP_HEIGHT]);
        for axis in 0..2 {
            let drift = DofCombination::from(6 + axis) - body_motions[axis].clone();
            matrix.add_outer(&drift, SPRING_STIFFNESS[axis]);
        }
        Ok(())
    }
}

/// Frequencies of the free structure, Hz: ω² = k (1/m + 1/M + (h − c)²/J).
fn free_frequencies() -> [f64; 2] {
    let [l, b, h] = BODY_SIDES;
    let body_mass = l * b * h * BODY_DENSITY;
    [(SPRING_STIFFNESS[0], l), (SPRING_STIFFNESS[1], b)].map(|(spring, side)| {
        let inertia = body_mass * (side * side + h * h) / 12.0;
        let lever = TOP_HEIGHT - 0.5 * h;
        let square = spring * (1.0 / TOP_MASS + 1.0 / body_mass + lever * lever / inertia);
        square.sqrt() / TAU
    })
}

#[test]
fn rigid_motions_in_space_have_no_modal_damping() {
    let damped_structure = ModalDamping::new(&[0.05]).unwrap().on(mast()).unwrap();
    let mut expected = free_frequencies();
    expected.sort_by(f64::total_cmp);
    assert_eq!(damped_structure.frequencies().len(), 2, "{:?}", damped_structure.frequencies());
    for (computed, expected) in damped_structure.frequencies().iter().zip(expected) {
        assert!((computed / expected - 1.0).abs() < 1e-9, "{computed} {expected}");
    }
    let fixed = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(mast()).unwrap();
    let expected = [SPRING_STIFFNESS[1], SPRING_STIFFNESS[0]]
        .map(|spring: f64| (spring / TOP_MASS).sqrt() / TAU);
    assert_eq!(fixed.frequencies().len(), 2, "{:?}", fixed.frequencies());
    for (computed, expected) in fixed.frequencies().iter().zip(expected) {
        assert!((computed / expected - 1.0).abs() < 1e-6, "{computed} {expected}");
    }
}

/// Absolute displacement after 400 steps.
fn march(structure: impl Structure + 'static, coordinates: Coordinates) -> Vec<f64> {
    let sides = [BODY_SIDES[0], BODY_SIDES[1]];
    let mut simulation = Simulation::builder(2e-3)
        .structure(structure)
        .ground(SpringCells::under(sides, BODY_CENTER, [5, 4], BED_PROPERTIES))
        .interface(Bonded)
        .motion(CrossingPulses { quarter_turns: 0 })
        .coordinates(coordinates)
        .expected_steps(400)
        .build()
        .unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    simulation.state().absolute_displacement().to_vec()
}

#[test]
fn all_coordinates_and_wrappers_have_the_same_motion() {
    let damping = ModalDamping::new(&[0.05]).unwrap();
    let expected = march(damping.on(mast()).unwrap(), Coordinates::Physical);
    let max_displacement = expected.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
    assert!([6, 7].iter().all(|dof| expected[*dof].abs() > 1e-2 * max_displacement));
    for (coordinates, tolerance) in
        [(Coordinates::Modes, 1e-9), (Coordinates::Reduced { tolerance: 1e-8 }, 1e-7)]
    {
        let computed = march(damping.on(mast()).unwrap(), coordinates);
        assert_close(&computed, &expected, tolerance * max_displacement);
    }
    let wrapped_displacement =
        march(WithSprings::new(damping.on(mast()).unwrap()), Coordinates::Physical);
    assert_close(&wrapped_displacement, &expected, 0.0);
    // A reduced structure has the degrees of freedom of its base; modal coordinates replace those of the top.
    let reduction = CraigBampton::new(2);
    let damped_after = damping.on(reduction.reduce(mast()).unwrap()).unwrap();
    let computed = march(damped_after, Coordinates::Physical);
    assert_close(&computed[..6], &expected[..6], 1e-9 * max_displacement);
    let damped_before = reduction.reduce(damping.on(mast()).unwrap()).unwrap();
    let computed = march(damped_before, Coordinates::Physical);
    assert_close(&computed[..6], &expected[..6], 1e-9 * max_displacement);
}

fn assert_close(computed: &[f64], expected: &[f64], tolerance: f64) {
    for (computed, expected) in computed.iter().zip(expected) {
        assert!((computed - expected).abs() <= tolerance, "{computed} {expected}");
    }
}

/// A structure as its matrices.
fn matrix_model(structure: &dyn Structure) -> MatrixModel {
    let mut mass = Triplets::new(structure.dofs());
    structure.mass(&mut mass).unwrap();
    let mut stiffness = Triplets::new(structure.dofs());
    structure.stiffness(&mut stiffness).unwrap();
    let mut damping = Triplets::new(structure.dofs());
    structure.damping(&mut damping).unwrap();
    let model = MatrixModel::new(mass, stiffness, structure.base()).unwrap();
    model.with_damping(damping).unwrap()
}

/// Displacement relative to the free field after 200 steps.
fn relative_displacement(structure: impl Structure + 'static) -> Vec<f64> {
    let sides = [BODY_SIDES[0], BODY_SIDES[1]];
    let ground = SpringCells::under(sides, BODY_CENTER, [4, 3], BED_PROPERTIES);
    let simulation = storeys::march(structure, ground, CrossingPulses { quarter_turns: 0 }, 200);
    simulation.state().displacement().to_vec()
}

/// The matrices of a body, and of a building that was reduced before or after, give the structure's results.
#[test]
fn a_matrix_model_moves_like_the_structure_with_its_matrices() {
    let body = body(2400.0);
    let model = matrix_model(&body);
    assert_eq!(relative_displacement(body.clone()), relative_displacement(model));

    let storeys = [PlanStorey::new(3.0, 1e5, [9.0; 2], [2e8, 3e8, 4e9]); 4];
    let building = StoreyBuilding::new(body, &storeys).unwrap();
    let whole_displacement = relative_displacement(building.clone());
    assert_eq!(whole_displacement, relative_displacement(matrix_model(&building)));
    let reduced_structure = CraigBampton::new(12).reduce(matrix_model(&building)).unwrap();
    let recovery = reduced_structure.recovery();
    let recovered_displacement = recovery.full(&relative_displacement(reduced_structure)).unwrap();
    for (computed, expected) in recovered_displacement.iter().zip(&whole_displacement) {
        assert!((computed - expected).abs() < 1e-12, "{computed} {expected}");
    }
}

fn identity(order: usize) -> Triplets {
    Triplets::from_entries(order, (0..order).map(|k| (k, k, 1.0)))
}

#[test]
fn invalid_matrices_are_errors() {
    let without_faces = MatrixModel::new(identity(6), Triplets::new(6), Base::Faces(Vec::new()));
    assert!(matches!(without_faces, Err(Error::Size { .. })));
    let too_small = MatrixModel::new(identity(5), Triplets::new(5), mast().base());
    assert!(matches!(too_small, Err(Error::Index { index: 5, bound: 5, .. })));
    let result = MatrixModel::new(identity(6), Triplets::new(5), mast().base());
    assert!(matches!(result, Err(Error::Size { .. })));
}
