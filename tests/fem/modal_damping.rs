//! Modal damping: its eigenvalues, its rigid motions, and the march in modes.

use crate::dense::{damping, eigenvalues, largest, mass, multiply, stiffness};
use basemat::bem::SpringGround;
use basemat::coupled::Coordinates;
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    FemModel, ModalDamping, RayleighDamping, RigidBlock, ShearBuilding, Storey, Structure, Triplets,
};
use basemat::{Error, Simulation};

fn tower() -> FemModel {
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let mesh = Mesh::layered_block(-2.0..2.0, 2, &[Layer::new(12.0, 4, material)]).unwrap();
    FemModel::on_base(mesh).unwrap()
}

/// C φ = 2 ζ ω M φ: the eigenvalues of C are those of K by 2 ζ √λ.
#[test]
fn every_mode_has_its_ratio() {
    let model = tower();
    let squares = eigenvalues(&stiffness(&model), &mass(&model));
    let damped = ModalDamping::new(&[0.05]).unwrap().on(tower()).unwrap();
    let found = eigenvalues(&damping(&damped), &mass(&model));
    let top = squares[squares.len() - 1].sqrt();
    for (rate, square) in found.iter().zip(&squares).skip(3) {
        assert!((rate - 2.0 * 0.05 * square.sqrt()).abs() < 1e-9 * top, "{rate} {square}");
    }
    for (frequency, square) in damped.frequencies().iter().zip(&squares[3..]) {
        let expected = square.sqrt() / std::f64::consts::TAU;
        assert!((frequency / expected - 1.0).abs() < 1e-9);
    }
    for direction in [Direction::X, Direction::Y, Direction::Rotation] {
        let ride = model.rigid_motion(direction, [0.0; 2]);
        let force = largest(&multiply(&damping(&damped), &ride));
        assert!(force < 1e-9 * top * 2000.0, "{direction:?} {force}");
    }
}

/// Different ratios: the sum of C's eigenvalues is Σ 2 ζ ω, and a structure's own damping stays.
#[test]
fn ratios_go_from_the_lowest_mode_and_the_last_one_stays() {
    let storeys = [Storey::new(3.0, 2.0e4, 4.0e7); 3];
    let building = || ShearBuilding::new(10.0, 5.0e4, 4.0e5, &storeys).unwrap();
    let squares = eigenvalues(&stiffness(&building()), &mass(&building()));
    let damped = ModalDamping::new(&[0.05, 0.02]).unwrap().on(building()).unwrap();
    let mut expected: Vec<f64> = squares[3..]
        .iter()
        .zip([0.05, 0.02, 0.02])
        .map(|(square, ratio)| 2.0 * ratio * square.sqrt())
        .collect();
    expected.sort_by(f64::total_cmp);
    let found = eigenvalues(&damping(&damped), &mass(&building()));
    for (a, b) in found[3..].iter().zip(&expected) {
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
    let rayleigh = RayleighDamping::new(0.3, 0.0).unwrap();
    let both = ModalDamping::new(&[0.0]).unwrap().on(tower().with_rayleigh(rayleigh)).unwrap();
    assert_eq!(damping(&both), damping(&tower().with_rayleigh(rayleigh)));
}

#[test]
fn modes_and_unknowns_march_alike() {
    let march = |coordinates| {
        let structure = ModalDamping::new(&[0.05, 0.03]).unwrap().on(tower()).unwrap();
        let mut simulation = Simulation::builder(0.005)
            .structure(structure)
            .ground(SpringGround::new(-2.0..2.0, 4, 5e7, 4e7).unwrap())
            .interface(Bonded)
            .motion(el_centro_1940())
            .coordinates(coordinates)
            .build()
            .unwrap();
        let run = simulation.run(600, |_| {}).unwrap();
        assert!(run.ledger_residual < 1e-9 && run.ledger.damping > 0.0);
        (run.base_shear.value, run.ledger.damping)
    };
    let (modes, unknowns) = (march(Coordinates::Modes), march(Coordinates::Unknowns));
    assert!((modes.0 / unknowns.0 - 1.0).abs() < 1e-8, "{modes:?} {unknowns:?}");
    assert!((modes.1 / unknowns.1 - 1.0).abs() < 1e-8, "{modes:?} {unknowns:?}");
}

/// A structure whose mass matrix has a zero.
struct Massless(RigidBlock);

impl Structure for Massless {
    fn unknowns(&self) -> usize {
        4
    }
    fn contact_nodes(&self) -> Vec<basemat::structure::ContactNode> {
        self.0.contact_nodes()
    }
    fn mass(&self, matrix: &mut Triplets) {
        (0..3).for_each(|i| matrix.add(i, i, 1.0));
    }
    fn stiffness(&self, matrix: &mut Triplets) {
        matrix.add_spring(0, 3, 1.0);
    }
}

#[test]
fn bad_ratios_and_structures_are_refused() {
    assert!(matches!(ModalDamping::new(&[]), Err(Error::Size { .. })));
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(ModalDamping::new(&[0.05, bad]), Err(Error::Input { .. })));
    }
    let damping = ModalDamping::new(&[0.05]).unwrap();
    let massless = Massless(RigidBlock::new(2.0, 2.0, 2.0).unwrap());
    assert!(matches!(damping.on(massless), Err(Error::Scene { .. })));
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let large = Mesh::layered_block(0.0..1.0, 40, &[Layer::new(1.0, 40, material)]).unwrap();
    let large = damping.on(FemModel::on_base(large).unwrap());
    assert!(matches!(large, Err(Error::Input { value: 3362.0, .. })));
}
