//! GOAL: modal damping gives each mode its ratio and rigid-body modes none.
//! SCENE: towers, shear buildings, a free bar of 400 beams, structures with two footings.
//! REFERENCE: eigenvalues of C, closed-form bending modes, the march in degrees of freedom.

use basemat::bem::SpringGround;
use basemat::coupled::Coordinates;
use basemat::fem::{Beam, Direction, Layer, LumpedMass, Material, Mesh};
use basemat::interface::Bonded;
use basemat::motion::el_centro_1940;
use basemat::structure::{
    Base, BaseNode, FemModel, ModalDamping, RayleighDamping, RigidBlock, ShearBuilding, Storey,
    Structure, Triplets,
};
use basemat::{Error, Simulation};
use basemat_problems::dense::{damping, eigenvalues, form, largest, mass, multiply, stiffness};

fn tower() -> FemModel {
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let mesh = Mesh::layered_block(-2.0..2.0, 2, &[Layer::new(12.0, 4, material)]).unwrap();
    FemModel::on_base(mesh).unwrap()
}

/// C φ = 2 ζ ω M φ: the eigenvalues of C are 2 ζ √λ, with λ the eigenvalues of K.
#[test]
fn every_mode_has_its_ratio() {
    let model = tower();
    let squares = eigenvalues(&stiffness(&model), &mass(&model));
    let damped_structure = ModalDamping::new(&[0.05]).unwrap().on(tower()).unwrap();
    let computed = eigenvalues(&damping(&damped_structure), &mass(&model));
    let top = squares[squares.len() - 1].sqrt();
    for (rate, square) in computed.iter().zip(&squares).skip(3) {
        assert!((rate - 2.0 * 0.05 * square.sqrt()).abs() < 1e-9 * top, "{rate} {square}");
    }
    for (frequency, square) in damped_structure.frequencies().iter().zip(&squares[3..]) {
        let expected = square.sqrt() / std::f64::consts::TAU;
        assert!((frequency / expected - 1.0).abs() < 1e-9);
    }
    for direction in [Direction::X, Direction::Y, Direction::Rotation] {
        let shift = model.rigid_motion(direction, [0.0; 3]);
        let force = largest(&multiply(&damping(&damped_structure), &shift));
        assert!(force < 1e-9 * top * 2000.0, "{direction:?} {force}");
    }
}

fn three_storeys() -> ShearBuilding {
    ShearBuilding::new(10.0, 5.0e4, 4.0e5, &[Storey::new(3.0, 2.0e4, 4.0e7); 3]).unwrap()
}

/// Different ratios: the sum of C's eigenvalues is Σ 2 ζ ω, and the structure's damping stays.
#[test]
fn ratios_go_from_the_lowest_mode_and_the_last_one_stays() {
    let squares = eigenvalues(&stiffness(&three_storeys()), &mass(&three_storeys()));
    let damped_structure = ModalDamping::new(&[0.05, 0.02]).unwrap().on(three_storeys()).unwrap();
    let mut expected: Vec<f64> = squares[3..]
        .iter()
        .zip([0.05, 0.02, 0.02])
        .map(|(square, ratio)| 2.0 * ratio * square.sqrt())
        .collect();
    expected.sort_by(f64::total_cmp);
    let computed = eigenvalues(&damping(&damped_structure), &mass(&three_storeys()));
    for (a, b) in computed[3..].iter().zip(&expected) {
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
    let rayleigh = RayleighDamping::new(0.3, 0.0).unwrap();
    let damped_twice =
        ModalDamping::new(&[0.0]).unwrap().on(tower().with_rayleigh(rayleigh)).unwrap();
    assert_eq!(damping(&damped_twice), damping(&tower().with_rayleigh(rayleigh)));
}

const FLOOR_COUNT: usize = 5;
const FLOOR_MASS: f64 = 30.0e3;
const STOREY_STIFFNESS: f64 = 60.0e6;

fn uniform_building() -> ShearBuilding {
    let storeys = [Storey::new(3.0, FLOOR_MASS, STOREY_STIFFNESS); FLOOR_COUNT];
    ShearBuilding::new(8.0, 60.0e3, 4.0e5, &storeys).unwrap()
}

/// The angle α of mode j, counted from zero.
fn mode_angle(j: usize) -> f64 {
    (2.0 * j as f64 + 1.0) * std::f64::consts::PI / 22.0
}

fn mode_shape(angle: f64) -> Vec<f64> {
    let building = uniform_building();
    let mut shape = vec![0.0; building.dofs()];
    for i in 0..FLOOR_COUNT {
        shape[building.floor(i).unwrap()] = (2.0 * (i as f64 + 1.0) * angle).sin();
    }
    shape
}

/// φⱼᵀ C φₖ.
fn modal_damping(c: &Vec<Vec<f64>>, j: usize, k: usize) -> f64 {
    form(&mode_shape(mode_angle(j)), c, &mode_shape(mode_angle(k)))
}

/// A uniform shear building on its fixed base: ω_j = 2 √(k/m) sin α_j with α_j = (2j − 1)π/(4n + 2), and floor i of
/// mode j moves by sin 2iα_j.
#[test]
fn modes_on_a_fixed_base_have_their_ratio() {
    let ratios = [0.05, 0.03, 0.02];
    let damped_structure =
        ModalDamping::new(&ratios).unwrap().on_fixed_base(uniform_building()).unwrap();
    assert_eq!(damped_structure.frequencies().len(), FLOOR_COUNT);
    let on_fixed_base = damping(&damped_structure);
    let free = damping(&ModalDamping::new(&[0.05]).unwrap().on(uniform_building()).unwrap());
    // Σ sin² 2iα is (2n + 1)/4.
    let modal_mass = FLOOR_MASS * 11.0 / 4.0;
    for j in 0..FLOOR_COUNT {
        let circular = 2.0 * (STOREY_STIFFNESS / FLOOR_MASS).sqrt() * mode_angle(j).sin();
        let ratio = modal_damping(&on_fixed_base, j, j) / (2.0 * circular * modal_mass);
        assert!((ratio / ratios[j.min(2)] - 1.0).abs() < 1e-4, "{j} {ratio}");
        let computed = damped_structure.frequencies()[j] * std::f64::consts::TAU;
        assert!((computed / circular - 1.0).abs() < 1e-5, "{j} {computed} {circular}");
        for k in 0..j {
            let damping_ratio = modal_damping(&on_fixed_base, j, k) / (2.0 * circular * modal_mass);
            assert!(damping_ratio.abs() < 1e-5, "{j} {k} {damping_ratio}");
        }
    }
    let first = 2.0 * (STOREY_STIFFNESS / FLOOR_MASS).sqrt() * mode_angle(0).sin();
    let ratio = modal_damping(&free, 0, 0) / (2.0 * first * modal_mass);
    assert!((ratio - 0.0086).abs() < 1e-4, "by itself: {ratio}");
}

/// Rigid motions are not damped, and a frame may have massless rotations.
#[test]
fn damping_on_a_fixed_base_leaves_rigid_motions_alone() {
    let model = tower();
    let damped_structure = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(tower()).unwrap();
    let matrix = damping(&damped_structure);
    for direction in [Direction::X, Direction::Y, Direction::Rotation] {
        let shift = model.rigid_motion(direction, [0.0; 3]);
        let force = largest(&multiply(&matrix, &shift));
        assert!(force < 1e-9 * largest(&matrix.concat()), "{direction:?} {force}");
    }
    assert!(eigenvalues(&matrix, &mass(&model)).iter().all(|rate| *rate > -1e-6));

    // A massless column with a heavy top: ω² = 3 E I/(h³ m) sideways, E A/(h m) upwards.
    let mut mesh = Mesh::new();
    let base = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    let top = mesh.add_node(0.0, 4.0).unwrap();
    for ends in [[base[0], base[1]], [base[1], base[2]]] {
        mesh.add(Beam::new(ends, 3e10, 1e3, 1e3, 1e-3).unwrap()).unwrap();
    }
    mesh.add(Beam::new([base[1], top], 3e10, 0.1, 1e-3, 0.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(top, 5.0e3).unwrap()).unwrap();
    let column = FemModel::on_base(mesh).unwrap();
    let ratios = ModalDamping::new(&[0.05]).unwrap();
    assert!(matches!(ratios.on(column.clone()), Err(Error::Scene { .. })));
    let damped_structure = ratios.on_fixed_base(column).unwrap();
    let squares = [3.0 * 3e10 * 1e-3 / (64.0 * 5e3), 3e10 * 0.1 / (4.0 * 5e3)];
    for (found, square) in damped_structure.frequencies().iter().zip(squares) {
        let expected = f64::sqrt(square) / std::f64::consts::TAU;
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
}

/// Largest base shear and energy of damping under El Centro.
fn march(coordinates: Coordinates) -> [f64; 2] {
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
    assert!(run.energy_error < 1e-9 && run.energy_balance.damping > 0.0);
    [run.whole.base_shear.largest().value, run.energy_balance.damping]
}

#[test]
fn modes_and_dofs_march_alike() {
    let modes = march(Coordinates::Modes);
    let dofs = march(Coordinates::Physical);
    for k in 0..2 {
        assert!((modes[k] / dofs[k] - 1.0).abs() < 1e-8, "{modes:?} {dofs:?}");
    }
}

const BAR_ELEMENTS: usize = 400;
const BAR_LENGTH: f64 = 30.0;
const BAR_MODULUS: f64 = 30.0e9;
const BAR_AREA: f64 = 0.5;
const BAR_SECOND_MOMENT: f64 = 0.01;
const BAR_DENSITY: f64 = 2400.0;

fn free_bar() -> FemModel {
    let mut mesh = Mesh::new();
    for k in 0..=BAR_ELEMENTS {
        mesh.add_node(BAR_LENGTH * k as f64 / BAR_ELEMENTS as f64, 0.0).unwrap();
    }
    for k in 0..BAR_ELEMENTS {
        let beam =
            Beam::new([k, k + 1], BAR_MODULUS, BAR_AREA, BAR_SECOND_MOMENT, BAR_DENSITY).unwrap();
        mesh.add(beam).unwrap();
    }
    FemModel::new(mesh, &[0, BAR_ELEMENTS]).unwrap()
}

/// Bending modes of a free bar are φ = cosh βx + cos βx − κ (sinh βx + sin βx) with cos βL cosh βL = 1
/// (Blevins 1979, table 8-1). In so fine a mesh their eigenvalues are 10⁻¹¹ of the highest or less.
#[test]
fn the_lowest_modes_of_a_fine_mesh_are_damped() {
    let ratios = [0.05, 0.04, 0.03, 0.02];
    let damped_structure = ModalDamping::new(&ratios).unwrap().on(free_bar()).unwrap();
    assert_eq!(damped_structure.frequencies().len(), 3 * (BAR_ELEMENTS + 1) - 3);
    let model = free_bar();
    let mass = mass(&model);
    let damping = damping(&damped_structure);
    let betas: [f64; 3] = [4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_671];
    for (k, beta) in betas.into_iter().enumerate() {
        let kappa = (beta.cosh() - beta.cos()) / (beta.sinh() - beta.sin());
        let mut mode = vec![0.0; 3 * (BAR_ELEMENTS + 1)];
        for (node, values) in mode.chunks_exact_mut(3).enumerate() {
            let z = beta * node as f64 / BAR_ELEMENTS as f64;
            values[1] = z.cosh() + z.cos() - kappa * (z.sinh() + z.sin());
            values[2] = beta / BAR_LENGTH * (z.sinh() - z.sin() - kappa * (z.cosh() + z.cos()));
        }
        let circular = (beta / BAR_LENGTH).powi(2)
            * f64::sqrt(BAR_MODULUS * BAR_SECOND_MOMENT / (BAR_DENSITY * BAR_AREA));
        let ratio = form(&mode, &damping, &mode) / (2.0 * circular * form(&mode, &mass, &mode));
        assert!((ratio / ratios[k] - 1.0).abs() < 1e-4, "mode {}: {ratio}", k + 1);
        let frequency = damped_structure.frequencies()[k] * std::f64::consts::TAU;
        assert!((frequency / circular - 1.0).abs() < 1e-5, "mode {}: {frequency}", k + 1);
    }
}

/// A structure with two footings and no stiffness between them has six rigid motions, a structure with P–Δ three.
#[test]
fn rigid_motions_are_counted_by_what_they_are() {
    use basemat::structure::StructureGroup;
    let frequency_count =
        ModalDamping::new(&[0.05]).unwrap().on(tower()).unwrap().frequencies().len();
    assert_eq!(frequency_count, tower().dofs() - 3);
    let block = RigidBlock::new(2.0, 2.0, 2000.0).unwrap();
    let group = StructureGroup::new().with(tower(), 0.0).unwrap().with(block, 9.0).unwrap();
    let two = ModalDamping::new(&[0.05]).unwrap().on(group).unwrap();
    assert_eq!(two.frequencies().len(), frequency_count);
    let building = three_storeys();
    let structure_with_p_delta =
        ModalDamping::new(&[0.05]).unwrap().on(building.with_p_delta(9.81).unwrap());
    assert_eq!(structure_with_p_delta.unwrap().frequencies().len(), 3);
}

/// A structure whose mass matrix has a zero.
struct Massless(RigidBlock);

impl Structure for Massless {
    fn dofs(&self) -> usize {
        4
    }
    fn base(&self) -> basemat::structure::Base {
        self.0.base()
    }
    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        (0..3).for_each(|i| matrix.add(i, i, 1.0));
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_spring(0, 3, 1.0);
        Ok(())
    }
}

#[test]
fn bad_ratios_and_structures_are_errors() {
    assert!(matches!(ModalDamping::new(&[]), Err(Error::Size { .. })));
    for invalid_value in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(ModalDamping::new(&[0.05, invalid_value]), Err(Error::Input { .. })));
    }
    let damping = ModalDamping::new(&[0.05]).unwrap();
    let massless_structure = Massless(RigidBlock::new(2.0, 2.0, 2.0).unwrap());
    assert!(matches!(damping.on(massless_structure), Err(Error::Scene { .. })));
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let result = Mesh::layered_block(0.0..1.0, 40, &[Layer::new(1.0, 40, material)]).unwrap();
    let result = damping.on(FemModel::on_base(result).unwrap());
    assert!(matches!(result, Err(Error::Input { value: 3362.0, .. })));
}

/// A structure whose base is not made of its degrees of freedom.
struct Astray;

impl Structure for Astray {
    fn dofs(&self) -> usize {
        2
    }
    fn base(&self) -> Base {
        [BaseNode::free(0.0, 0, 1), BaseNode::free(1.0, usize::MAX, 2)].into()
    }
    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(0, 0, 1.0);
        matrix.add(1, 1, 1.0);
        Ok(())
    }
    fn stiffness(&self, _: &mut Triplets) -> basemat::Result<()> {
        Ok(())
    }
}

#[test]
fn a_base_of_dofs_that_are_not_there_is_an_error() {
    let fault = ModalDamping::new(&[0.05]).unwrap().on(Astray).unwrap_err();
    assert!(matches!(fault, Error::Index { index: usize::MAX, bound: 2, .. }), "{fault}");
}
