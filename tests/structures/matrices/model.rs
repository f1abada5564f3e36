//! GOAL: a structure by its matrices moves as the structure that they came from; invalid
//! matrices are errors.
//! SCENE: a tower on the half-plane that uplifts and slides.
//! REFERENCE: the finite-element model; typed errors.

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::StructureError;
use basemat::structure::{
    Base, BaseNode, Bilinear, FemModel, MatrixModel, RayleighDamping, RigidBlock, Structure,
    Triplets, WithSprings,
};
use basemat::{Error, Simulation, Soil};

pub(crate) fn tower(columns: usize, rows: usize) -> FemModel {
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let mesh = Mesh::layered_block(-3.0..3.0, columns, &[Layer::new(15.0, rows, material)]);
    FemModel::on_base(mesh.unwrap()).unwrap()
}

pub(crate) fn on_soil(structure: impl Structure + 'static) -> SimulationBuilder {
    let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(0.01)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-3.0..3.0, 6).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
}

/// The matrix of the entries that `fill` adds.
fn filled(order: usize, fill: impl Fn(&mut Triplets) -> basemat::Result<()>) -> Triplets {
    let mut matrix = Triplets::new(order);
    fill(&mut matrix).unwrap();
    matrix
}

/// Largest base moment of four seconds in a run whose energy balance closes.
fn largest_moment(structure: impl Structure + 'static) -> f64 {
    let mut simulation = on_soil(structure).build().unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9);
    run.whole.base_moment.largest().value
}

#[test]
fn matrices_move_as_the_model_they_came_from() {
    let rayleigh = RayleighDamping::from_ratios([1.0, 8.0], [0.05; 2]).unwrap();
    let model = tower(6, 10).with_rayleigh(rayleigh);
    let mass = filled(model.dofs(), |matrix| model.mass(matrix));
    let damping = filled(model.dofs(), |matrix| model.damping(matrix));
    let stiffness = filled(model.dofs(), |matrix| model.stiffness(matrix));
    let undamped_model = MatrixModel::new(mass, stiffness, model.base()).unwrap();
    let with_rayleigh = undamped_model.clone().with_rayleigh(rayleigh);
    let with_matrix = undamped_model.with_damping(damping).unwrap();
    let expected = largest_moment(model);
    for computed in [largest_moment(with_matrix), largest_moment(with_rayleigh)] {
        assert!((computed / expected - 1.0).abs() < 1e-9, "{computed} {expected}");
    }
}

fn diagonal_matrix(order: usize, value: f64) -> Triplets {
    let mut matrix = Triplets::new(order);
    (0..order).for_each(|i| matrix.add(i, i, value));
    matrix
}

/// The model of these matrices on a rigid base.
fn model_of(mass: Triplets, stiffness: Triplets) -> basemat::Result<MatrixModel> {
    MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-1.0, 1.0, [0, 1, 2]))
}

fn is_input<T>(result: &basemat::Result<T>) -> bool {
    matches!(result, Err(Error::Input { .. }))
}

fn is_size<T>(result: &basemat::Result<T>) -> bool {
    matches!(result, Err(Error::Size { .. }))
}

#[test]
fn invalid_matrices_are_errors() {
    let unit = diagonal_matrix(3, 1.0);
    assert!(model_of(unit.clone(), Triplets::new(3)).is_ok());
    let huge_matrix = Triplets::new(usize::MAX);
    assert!(matches!(model_of(huge_matrix.clone(), huge_matrix), Err(Error::Memory(_))));
    assert!(is_size(&model_of(Triplets::new(0), unit.clone())));
    assert!(is_size(&model_of(unit.clone(), diagonal_matrix(4, 1.0))));
    assert!(is_size(&MatrixModel::new(unit.clone(), unit.clone(), vec![])));
    let small_matrix = diagonal_matrix(2, 1.0);
    assert!(matches!(
        model_of(small_matrix.clone(), small_matrix.clone()),
        Err(Error::Index { .. })
    ));
    assert!(is_input(&model_of(diagonal_matrix(3, f64::NAN), unit.clone())));
    assert!(is_input(&model_of(unit.clone(), diagonal_matrix(3, f64::INFINITY))));
    let mut asymmetric_matrix = unit.clone();
    asymmetric_matrix.add(0, 1, 0.5);
    assert!(matches!(
        model_of(asymmetric_matrix, unit.clone()),
        Err(Error::Unsymmetric { row: 0, column: 1, entries: [0.5, 0.0], .. })
    ));
    let mut matrix_beyond_the_order = unit.clone();
    matrix_beyond_the_order.add(0, 3, 0.5);
    assert!(matches!(model_of(unit.clone(), matrix_beyond_the_order), Err(Error::Index { .. })));
    let invalid_base = BaseNode::rigid_base(f64::NAN, 1.0, [0, 1, 2]);
    assert!(is_input(&MatrixModel::new(unit.clone(), unit.clone(), invalid_base)));
    let model = model_of(unit.clone(), unit).unwrap();
    assert!(is_size(&model.clone().with_damping(small_matrix)));
    assert!(is_input(&model.with_damping(diagonal_matrix(3, f64::NAN))));
}

#[track_caller]
fn assert_restrained(structure: impl Structure + 'static) {
    let error = on_soil(structure).build().err();
    assert!(
        matches!(error, Some(Error::Structure(StructureError::Restrained { .. }))),
        "{error:?}"
    );
}

/// An elastic support would carry part of the weight and resist the rigid motion by which the weight is computed.
#[test]
fn stiffness_to_a_fixed_point_is_an_error() {
    let block = RigidBlock::new(6.0, 10.0, 80.0e3 / 60.0).unwrap();
    for (dof, stiffness) in [(1, 1e-3), (1, 1.0), (1, 1e9), (0, 1e-3), (0, 1e9)] {
        let mass = filled(3, |matrix| block.mass(matrix));
        let mut spring = Triplets::new(3);
        spring.add(dof, dof, stiffness);
        assert_restrained(MatrixModel::new(mass, spring, block.base()).unwrap());
        let law = Bilinear::new(stiffness, 1.0, 0.1).unwrap();
        let block_on_spring =
            WithSprings::new(block.clone()).spring(vec![(dof, 1.0)], law).unwrap();
        assert_restrained(block_on_spring);
    }
    let roof = tower(4, 6).dofs() - 1;
    let law = Bilinear::new(1e8, 1e5, 0.1).unwrap();
    assert_restrained(WithSprings::new(tower(4, 6)).spring(vec![(roof, 1.0)], law).unwrap());
}

/// However stiff, a structure without supports is free to translate.
#[test]
fn stiff_structures_are_free_to_translate() {
    for modulus in [1e3, 1e9, 1e15, 1e20] {
        let material = Material::new(modulus, 0.2, 2000.0).unwrap();
        let mesh = Mesh::layered_block(-3.0..3.0, 6, &[Layer::new(120.0, 60, material)]).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let result = on_soil(model).gravity(0.0).build();
        let fixed = matches!(result, Err(Error::Structure(StructureError::Restrained { .. })));
        assert!(!fixed, "{modulus:e}: {:?}", result.err());
    }
}

/// A rigid block with a negative mass on a spring.
struct LightBlock(RigidBlock);
impl Structure for LightBlock {
    fn dofs(&self) -> usize {
        4
    }
    fn base(&self) -> Base {
        self.0.base()
    }
    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.0.mass(matrix)?;
        matrix.add(3, 3, -1000.0);
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(0, 3, 4.0e6);
        Ok(())
    }
}

/// A floor of these masses on a rigid base.
fn floor_of_masses(entries: &[(usize, usize, f64)]) -> basemat::Result<MatrixModel> {
    let mut mass = Triplets::new(4);
    (0..3).for_each(|dof| mass.add(dof, dof, 2.0e4));
    for &(i, j, value) in entries {
        mass.add(i, j, value);
    }
    let mut stiffness = Triplets::new(4);
    stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4.0e6);
    MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]))
}

/// Error of a mass matrix whose row 3 is negative.
fn negative_mass(diagonal: f64) -> Error {
    Error::Indefinite { matrix: "mass matrix", row: 3, diagonal }
}

/// With a negative mass energy would grow without bound although the energy balance closes.
#[test]
fn negative_masses_are_errors() {
    let negative_mass_error = floor_of_masses(&[(3, 3, -1000.0)]);
    assert_eq!(negative_mass_error.unwrap_err(), negative_mass(-1000.0));
    // Positive on the diagonal, and negative for opposite u_0 and u_3.
    let indefinite_mass_error = floor_of_masses(&[(3, 3, 1.0e4), (0, 3, 1.5e4), (3, 0, 1.5e4)]);
    assert_eq!(indefinite_mass_error.unwrap_err(), negative_mass(1.0e4));
    // A mass on a weighted sum of degrees of freedom, and no mass at all, are singular, not negative.
    for legal in [&[(3, 3, 2.0e4), (0, 3, 2.0e4), (3, 0, 2.0e4)][..], &[]] {
        assert!(on_soil(floor_of_masses(legal).unwrap()).build().is_ok());
    }
    let result = on_soil(LightBlock(RigidBlock::new(6.0, 10.0, 2000.0).unwrap())).build();
    assert_eq!(result.err(), Some(negative_mass(-1000.0)));
}

/// A mast of two hinged bars that carry `load`.
fn mast_under(load: f64) -> basemat::Result<Simulation> {
    let mut mass = Triplets::new(5);
    (0..5).for_each(|dof| mass.add(dof, dof, 1.0e4));
    let mut stiffness = Triplets::new(5);
    for (row, sway) in [
        ([(3, 1.0), (0, -1.0), (2, 5.0)], [(3, 1.0), (0, -1.0)]),
        ([(4, 1.0), (3, -1.0), (2, 5.0)], [(4, 1.0), (3, -1.0)]),
    ] {
        stiffness.add_outer(row, 1.0e6);
        stiffness.add_outer(sway, -load / 5.0);
    }
    let contact = BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]);
    on_soil(MatrixModel::new(mass, stiffness, contact).unwrap()).gravity(0.0).build()
}

/// Under more than its buckling load a mast of two hinged bars releases energy on a base at rest.
/// The P–Δ effect of a block does so only where the base can turn, and is accepted.
#[test]
fn negative_stiffness_on_a_fixed_base_is_an_error() {
    assert!(mast_under(0.999 * 5.0e6).is_ok());
    let result = mast_under(1.001 * 5.0e6).err();
    assert!(matches!(result, Some(Error::Indefinite { .. })), "{result:?}");
    let slender_block = RigidBlock::new(1.0, 4.0, 2000.0).unwrap().with_p_delta(9.81).unwrap();
    let built = Simulation::builder(0.01)
        .structure(slender_block)
        .ground(SpringGround::new(-0.5..0.5, 4, 1.0e9, 1.0e9).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .build();
    assert!(built.is_ok(), "{:?}", built.err());
}
