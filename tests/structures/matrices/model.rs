//! GOAL: a structure by its matrices is the structure that they came from; bad matrices are
//! refused.
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

#[test]
fn matrices_march_as_the_model_they_came_from() {
    let damping = RayleighDamping::from_ratios([1.0, 8.0], [0.05; 2]).unwrap();
    let model = tower(6, 10).with_rayleigh(damping);
    let filled = |fill: &dyn Fn(&mut Triplets) -> basemat::Result<()>| {
        let mut matrix = Triplets::new(model.dofs());
        fill(&mut matrix).unwrap();
        matrix
    };
    let [mass, damp, stiffness] = [
        filled(&|m| model.mass(m)),
        filled(&|m| model.damping(m)),
        filled(&|m| model.stiffness(m)),
    ];
    let given = MatrixModel::new(mass, stiffness, model.base()).unwrap();
    let rayleigh = given.clone().with_rayleigh(damping);
    let full = given.with_damping(damp).unwrap();
    let run = |builder: SimulationBuilder| {
        let mut simulation = builder.build().unwrap();
        let run = simulation.run(400, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9);
        run.whole.base_moment.largest().value
    };
    let expected = run(on_soil(model));
    for found in [run(on_soil(full)), run(on_soil(rayleigh))] {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn bad_matrices_are_refused() {
    let diagonal = |n: usize, value: f64| {
        let mut matrix = Triplets::new(n);
        (0..n).for_each(|i| matrix.add(i, i, value));
        matrix
    };
    let contact = || BaseNode::rigid_base(-1.0, 1.0, [0, 1, 2]);
    let one = || diagonal(3, 1.0);
    assert!(MatrixModel::new(one(), Triplets::new(3), contact()).is_ok());
    let new = MatrixModel::new;
    let huge = Triplets::new(usize::MAX);
    assert!(matches!(new(huge.clone(), huge, contact()), Err(Error::Memory(_))));
    assert!(matches!(new(Triplets::new(0), one(), contact()), Err(Error::Size { .. })));
    assert!(matches!(new(one(), diagonal(4, 1.0), contact()), Err(Error::Size { .. })));
    assert!(matches!(new(one(), one(), vec![]), Err(Error::Size { .. })));
    assert!(matches!(new(diagonal(2, 1.0), diagonal(2, 1.0), contact()), Err(Error::Index { .. })));
    assert!(matches!(new(diagonal(3, f64::NAN), one(), contact()), Err(Error::Input { .. })));
    assert!(matches!(new(one(), diagonal(3, f64::INFINITY), contact()), Err(Error::Input { .. })));
    let mut skew = one();
    skew.add(0, 1, 0.5);
    assert!(matches!(
        new(skew, one(), contact()),
        Err(Error::Unsymmetric { row: 0, column: 1, entries: [0.5, 0.0], .. })
    ));
    let mut outside = one();
    outside.add(0, 3, 0.5);
    assert!(matches!(new(one(), outside, contact()), Err(Error::Index { .. })));
    let far = BaseNode::rigid_base(f64::NAN, 1.0, [0, 1, 2]);
    assert!(matches!(new(one(), one(), far), Err(Error::Input { .. })));
    let model = new(one(), one(), contact()).unwrap();
    assert!(matches!(model.clone().with_damping(diagonal(2, 1.0)), Err(Error::Size { .. })));
    assert!(matches!(model.with_damping(diagonal(3, f64::NAN)), Err(Error::Input { .. })));
}

#[track_caller]
fn refused(structure: impl Structure + 'static) {
    let built = on_soil(structure).build();
    assert!(
        matches!(built, Err(Error::Structure(StructureError::Restrained { .. }))),
        "{:?}",
        built.err()
    );
}

/// An elastic support would carry part of the weight and distort the rigid motion by which the structure is weighed.
#[test]
fn stiffness_to_a_fixed_point_is_refused() {
    let block = || RigidBlock::new(6.0, 10.0, 80.0e3 / 60.0).unwrap();
    for (dof, stiffness) in [(1, 1e-3), (1, 1.0), (1, 1e9), (0, 1e-3), (0, 1e9)] {
        let [mut mass, mut spring] = [(); 2].map(|()| Triplets::new(3));
        block().mass(&mut mass).unwrap();
        spring.add(dof, dof, stiffness);
        refused(MatrixModel::new(mass, spring, block().base()).unwrap());
        let law = Bilinear::new(stiffness, 1.0, 0.1).unwrap();
        let held = WithSprings::new(block()).spring(vec![(dof, 1.0)], law).unwrap();
        refused(held);
    }
    let roof = tower(4, 6).dofs() - 1;
    let law = Bilinear::new(1e8, 1e5, 0.1).unwrap();
    refused(WithSprings::new(tower(4, 6)).spring(vec![(roof, 1.0)], law).unwrap());
}

/// However stiff, a structure without supports is free to translate.
#[test]
fn stiff_structures_are_free_to_translate() {
    for modulus in [1e3, 1e9, 1e15, 1e20] {
        let material = Material::new(modulus, 0.2, 2000.0).unwrap();
        let mesh = Mesh::layered_block(-3.0..3.0, 6, &[Layer::new(120.0, 60, material)]).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let built = on_soil(model).gravity(0.0).build();
        let fixed = matches!(built, Err(Error::Structure(StructureError::Restrained { .. })));
        assert!(!fixed, "{modulus:e}: {:?}", built.err());
    }
}

/// A rigid block with a negative mass on a spring.
struct Light(RigidBlock);
impl Structure for Light {
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

/// A mass below zero would let energy grow without end beside a closed energy balance.
#[test]
fn negative_masses_are_refused() {
    let of = |entries: &[(usize, usize, f64)]| {
        let mut mass = Triplets::new(4);
        (0..3).for_each(|dof| mass.add(dof, dof, 2.0e4));
        for &(i, j, value) in entries {
            mass.add(i, j, value);
        }
        let mut stiffness = Triplets::new(4);
        stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4.0e6);
        MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]))
    };
    let negative = of(&[(3, 3, -1000.0)]);
    let named = |row, diagonal| Error::Indefinite { matrix: "mass matrix", row, diagonal };
    assert_eq!(negative.unwrap_err(), named(3, -1000.0));
    // Positive on the diagonal, and negative for u_0 and u_3 in opposite ways.
    let skew = of(&[(3, 3, 1.0e4), (0, 3, 1.5e4), (3, 0, 1.5e4)]);
    assert_eq!(skew.unwrap_err(), named(3, 1.0e4));
    // A mass on a weighted sum of degrees of freedom, and none at all, are singular, not negative.
    for legal in [&[(3, 3, 2.0e4), (0, 3, 2.0e4), (3, 0, 2.0e4)][..], &[]] {
        assert!(on_soil(of(legal).unwrap()).build().is_ok());
    }
    let built = on_soil(Light(RigidBlock::new(6.0, 10.0, 2000.0).unwrap())).build();
    assert_eq!(built.err(), Some(named(3, -1000.0)));
}

/// Under more than its buckling load a mast of two hinged bars gives energy away, the base at rest.
/// A block's own P–Δ does so only where the base may turn, and is as it should be.
#[test]
fn negative_stiffness_on_a_held_base_is_refused() {
    let mast = |load: f64| {
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
    };
    assert!(mast(0.999 * 5.0e6).is_ok());
    let refused = mast(1.001 * 5.0e6).err();
    assert!(matches!(refused, Some(Error::Indefinite { .. })), "{refused:?}");
    let slender = RigidBlock::new(1.0, 4.0, 2000.0).unwrap().with_p_delta(9.81).unwrap();
    let built = Simulation::builder(0.01)
        .structure(slender)
        .ground(SpringGround::new(-0.5..0.5, 4, 1.0e9, 1.0e9).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .build();
    assert!(built.is_ok(), "{:?}", built.err());
}
