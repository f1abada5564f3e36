//! Damping matrices that would add energy are errors, unless the damping is active.

use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Direction, Element, MassKind};
use basemat::motion::el_centro_1940;
use basemat::structure::{
    BaseNode, CraigBampton, FemModel, MatrixModel, ModalDamping, RayleighDamping, RigidBlock,
    ShearBuilding, Storey, Structure, StructureGroup, Triplets,
};
use basemat::{Error, Result, Simulation, Soil, interface::Bonded};

use super::model::{on_soil, tower};

use basemat_problems::needed_from;

/// A rigid base with a mass on a spring of 4 MN/m, 5 m up.
fn floor() -> MatrixModel {
    let mut mass = Triplets::new(4);
    let mut stiffness = Triplets::new(4);
    [2.0e4, 3.0e4, 6.0e4, 1.0e4]
        .into_iter()
        .enumerate()
        .for_each(|(i, m)| mass.add(i, i, m));
    stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4.0e6);
    MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2])).unwrap()
}

fn matrix(entries: &[(usize, usize, f64)]) -> Triplets {
    let mut matrix = Triplets::new(4);
    for &(i, j, value) in entries {
        matrix.add(i, j, value);
    }
    matrix
}

fn dashpot(coefficient: f64) -> Triplets {
    let mut matrix = Triplets::new(4);
    matrix.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], coefficient);
    matrix
}

/// A structure with another damping matrix.
struct Damped(MatrixModel, Triplets);

impl Structure for Damped {
    needed_from!(0);

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        for &(i, j, value) in self.1.entries() {
            matrix.add(i, j, value);
        }
        Ok(())
    }
}

fn indefinite(row: usize, diagonal: f64) -> Error {
    Error::Indefinite { matrix: "damping matrix", row, diagonal }
}

/// Whether both errors are equal but for the row of an indefinite matrix.
fn is_same_error(error: &Error, expected: &Error) -> bool {
    match (error, expected) {
        (Error::Indefinite { matrix, .. }, Error::Indefinite { .. }) => *matrix == "damping matrix",
        _ => error == expected,
    }
}

fn actively_damped(damping: Triplets) -> MatrixModel {
    floor().with_active_damping(damping).unwrap()
}

/// GOAL: a matrix that is not symmetric or not positive semi-definite is an error, by the model
/// of matrices and for any other structure.
#[test]
fn damping_that_adds_energy_is_an_error() {
    let name = "damping matrix";
    for (damping, expected) in [
        (dashpot(-4.0e4), indefinite(2, -1.0e6)),
        (matrix(&[(3, 3, -1.0)]), indefinite(3, -1.0)),
        (matrix(&[(3, 3, 1e4), (0, 0, 1e4), (0, 3, 2e4), (3, 0, 2e4)]), indefinite(3, 1e4)),
        (matrix(&[(0, 3, 2e4), (3, 0, 2e4)]), indefinite(3, 0.0)),
        (
            matrix(&[(0, 3, 2e4), (3, 0, -2e4)]),
            Error::Unsymmetric { matrix: name, row: 0, column: 3, entries: [2e4, -2e4] },
        ),
        (
            matrix(&[(3, 3, 1e4), (0, 0, 1e4), (0, 3, -1e4)]),
            Error::Unsymmetric { matrix: name, row: 0, column: 3, entries: [-1e4, 0.0] },
        ),
    ] {
        let result = floor().with_damping(damping.clone()).unwrap_err();
        assert!(is_same_error(&result, &expected), "{result} instead of {expected}");
        let result = on_soil(Damped(floor(), damping.clone())).build().err().unwrap();
        assert!(is_same_error(&result, &expected), "{result:?} instead of {expected}");
        // As active damping it is accepted, also in a group.
        let active = actively_damped(damping.clone());
        assert!(active.has_active_damping() && on_soil(active).build().is_ok());
        let group = StructureGroup::new().with(actively_damped(damping), 0.0).unwrap();
        assert!(on_soil(group).build().is_ok());
    }
}

/// GOAL: damping that replaces active damping is checked again; a reduction keeps active damping.
#[test]
fn active_damping_belongs_to_its_matrix() {
    let rayleigh = RayleighDamping::new(0.1, 0.01).unwrap();
    assert!(!actively_damped(dashpot(-1e4)).with_rayleigh(rayleigh).has_active_damping());
    let damped_model = actively_damped(dashpot(-1e4)).with_damping(dashpot(1e4)).unwrap();
    assert!(!damped_model.has_active_damping());
    let invalid = matrix(&[(0, 0, f64::NAN)]);
    assert!(actively_damped(dashpot(-1e4)).with_active_damping(invalid).is_err());
    let too_small = Triplets::new(3);
    assert!(actively_damped(dashpot(-1e4)).with_active_damping(too_small).is_err());
    let reduced_structure = CraigBampton::new(1).reduce(actively_damped(dashpot(-1e4))).unwrap();
    assert!(reduced_structure.has_active_damping() && on_soil(reduced_structure).build().is_ok());
    let reduced_structure = CraigBampton::new(1).reduce(actively_damped(dashpot(-1e4))).unwrap();
    let reduced_structure = reduced_structure.with_damping_ratio(0.1).unwrap();
    assert!(!reduced_structure.has_active_damping());
}

/// Energy that damping dissipates in a run whose energy balance closes.
fn damping_energy(model: MatrixModel) -> f64 {
    let mut simulation = on_soil(model).gravity(0.0).interface(Bonded).build().unwrap();
    let run = simulation.run(500, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    simulation.state().energy_balance.damping
}

/// GOAL: the energy that active damping adds is in the energy balance, which closes.
#[test]
fn active_damping_is_in_the_energy_balance() {
    let active = damping_energy(floor().with_active_damping(dashpot(-4.0e3)).unwrap());
    let passive = damping_energy(floor().with_damping(dashpot(4.0e3)).unwrap());
    assert!(active < 0.0 && passive > 0.0, "{active} {passive}");
}

#[track_caller]
fn assert_builds(structure: impl Structure + 'static, name: &str) {
    let base = structure.base();
    let nodes: Vec<_> = base.nodes().collect();
    let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
    let strip = Strip::uniform(nodes[0].x..nodes[nodes.len() - 1].x, 6).unwrap();
    let result = Simulation::builder(0.01)
        .structure(structure)
        .ground(ElasticGround::new(soil, strip).unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .build();
    assert!(result.is_ok(), "{name}: {:?}", result.err());
}

/// GOAL: damping matrices in practical use are accepted: rounding, weighted sums, singular matrices, files of
/// eight digits, Rayleigh's of fine meshes and with P–Δ, modal and reduced ones.
#[test]
fn damping_in_use_is_accepted() {
    for damping in [dashpot(1e-9), dashpot(1e12), matrix(&[]), matrix(&[(3, 3, 0.0)])] {
        assert_builds(floor().with_damping(damping).unwrap(), "dashpot");
    }
    let rounded_matrix = matrix(&[(3, 3, 1e6), (2, 2, -1e-7), (0, 3, 1e-7), (3, 0, 1e-7)]);
    assert_builds(floor().with_damping(rounded_matrix).unwrap(), "rounding");
    let rayleigh = RayleighDamping::from_ratios([1.0, 8.0], [0.05; 2]).unwrap();
    for beta in [rayleigh, RayleighDamping::new(0.0, 0.05).unwrap()] {
        let model = tower(6, 40).with_rayleigh(beta);
        let mut digits = Triplets::new(model.dofs());
        let mut full_matrix = Triplets::new(model.dofs());
        model.damping(&mut full_matrix).unwrap();
        for &(i, j, value) in full_matrix.entries() {
            digits.add(i, j, format!("{value:.7e}").parse().unwrap());
        }
        let mut mass = Triplets::new(model.dofs());
        let mut stiffness = Triplets::new(model.dofs());
        model.mass(&mut mass).unwrap();
        model.stiffness(&mut stiffness).unwrap();
        let from_file = MatrixModel::new(mass, stiffness, model.base()).unwrap();
        assert_builds(from_file.with_damping(digits).unwrap(), "file");
        assert_builds(CraigBampton::new(20).reduce(model.clone()).unwrap(), "reduced");
        assert_builds(model, "Rayleigh");
    }
    assert_builds(ModalDamping::new(&[0.05]).unwrap().on(tower(4, 12)).unwrap(), "modal");
    let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
    let building = ShearBuilding::new(6.0, 50.0e3, 4.0e5, &storeys).unwrap();
    let building = building.with_p_delta(9.81).unwrap().with_stiffness_damping(0.01).unwrap();
    assert_builds(building, "P-delta");
    assert_builds(RigidBlock::new(4.0, 4.0, 2000.0).unwrap(), "block");
}

/// An element with a damper of negative coefficient.
struct Pusher([usize; 2]);

impl Element for Pusher {
    fn nodes(&self) -> &[usize] {
        &self.0
    }
    fn directions(&self) -> &[Direction] {
        &[Direction::X]
    }
    fn stiffness(&self, _: &[[f64; 3]], _: &mut [f64]) {}
    fn mass(&self, _: &[[f64; 3]], _: MassKind, _: &mut [f64]) {}
    fn damping(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        for (entry, c) in matrix.iter_mut().zip([-1e4, 1e4, 1e4, -1e4]) {
            *entry += c;
        }
    }
}

/// A tower with that element.
fn pushed_tower() -> Result<FemModel> {
    let mut mesh = tower(2, 4).mesh().clone();
    let top = mesh.node_at(0.0, 15.0)?;
    let below = mesh.node_at(0.0, 11.25)?;
    mesh.add(Pusher([below, top]))?;
    FemModel::on_base(mesh)
}

#[test]
fn elements_that_add_energy_are_errors_unless_active() {
    let result = on_soil(pushed_tower().unwrap()).build().err();
    assert!(matches!(result, Some(Error::Indefinite { matrix: "damping matrix", .. })));
    assert!(on_soil(pushed_tower().unwrap().with_active_damping()).build().is_ok());
}
