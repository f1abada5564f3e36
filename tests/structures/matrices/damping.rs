//! Damping matrices that would feed energy in are refused, unless they are meant to.

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
    let [mut mass, mut stiffness] = [(); 2].map(|()| Triplets::new(4));
    [2.0e4, 3.0e4, 6.0e4, 1.0e4].into_iter().enumerate().for_each(|(i, m)| mass.add(i, i, m));
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

/// GOAL: a matrix that is not symmetric or not positive semi-definite is refused, by the model that
/// is made of matrices and for any other structure.
#[test]
fn damping_that_feeds_energy_in_is_refused() {
    let name = "damping matrix";
    let indefinite = |row, diagonal| Error::Indefinite { matrix: name, row, diagonal };
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
        let same = |found: Error| match (&found, &expected) {
            (Error::Indefinite { matrix, .. }, Error::Indefinite { .. }) => *matrix == name,
            _ => found == expected,
        };
        let refused = floor().with_damping(damping.clone()).unwrap_err();
        assert!(same(refused.clone()), "{refused} instead of {expected}");
        let refused = on_soil(Damped(floor(), damping.clone())).build().err();
        assert!(refused.clone().is_some_and(same), "{refused:?} instead of {expected}");
        // Meant so, it is taken as it is, in a group too.
        let active = || floor().with_active_damping(damping.clone()).unwrap();
        assert!(active().has_active_damping() && on_soil(active()).build().is_ok());
        let group = StructureGroup::new().with(active(), 0.0).unwrap();
        assert!(on_soil(group).build().is_ok());
    }
}

/// GOAL: what is taken in place of active damping is checked again, and a reduction keeps it.
#[test]
fn active_damping_goes_with_its_matrix() {
    let active = || floor().with_active_damping(dashpot(-1e4)).unwrap();
    assert!(!active().with_rayleigh(RayleighDamping::new(0.1, 0.01).unwrap()).has_active_damping());
    assert!(!active().with_damping(dashpot(1e4)).unwrap().has_active_damping());
    assert!(active().with_active_damping(matrix(&[(0, 0, f64::NAN)])).is_err());
    assert!(active().with_active_damping(Triplets::new(3)).is_err());
    let reduced = CraigBampton::new(1).reduce(active()).unwrap();
    assert!(reduced.has_active_damping() && on_soil(reduced).build().is_ok());
    let reduced = CraigBampton::new(1).reduce(active()).unwrap().with_damping_ratio(0.1).unwrap();
    assert!(!reduced.has_active_damping());
}

/// GOAL: what active damping feeds in is in the energy balance, which closes.
#[test]
fn active_damping_is_booked() {
    let run = |model: MatrixModel| {
        let mut simulation = on_soil(model).gravity(0.0).interface(Bonded).build().unwrap();
        let run = simulation.run(500, |_| {}).unwrap();
        assert!(run.energy_error < 1e-9, "{}", run.energy_error);
        simulation.state().energy_balance.damping
    };
    let fed = run(floor().with_active_damping(dashpot(-4.0e3)).unwrap());
    let taken = run(floor().with_damping(dashpot(4.0e3)).unwrap());
    assert!(fed < 0.0 && taken > 0.0, "{fed} {taken}");
}

/// GOAL: dampings as they are in use pass: rounding, weighted sums, singular matrices, files of
/// eight digits, Rayleigh's of fine meshes and with P–Δ, modal and reduced ones.
#[test]
fn damping_in_use_passes() {
    let passes = |structure: Box<dyn Structure>, what: &str| {
        let base = structure.base();
        let nodes: Vec<_> = base.nodes().collect();
        let soil = Soil::new(60.0e6, 0.33, 1900.0).unwrap();
        let ground = ElasticGround::new(
            soil,
            Strip::uniform(nodes[0].x..nodes[nodes.len() - 1].x, 6).unwrap(),
        )
        .unwrap();
        let built = Simulation::builder(0.01)
            .structure(structure)
            .ground(ground)
            .interface(Bonded)
            .motion(el_centro_1940())
            .build();
        assert!(built.is_ok(), "{what}: {:?}", built.err());
    };
    for damping in [dashpot(1e-9), dashpot(1e12), matrix(&[]), matrix(&[(3, 3, 0.0)])] {
        passes(Box::new(floor().with_damping(damping).unwrap()), "dashpot");
    }
    let rounded = matrix(&[(3, 3, 1e6), (2, 2, -1e-7), (0, 3, 1e-7), (3, 0, 1e-7)]);
    passes(Box::new(floor().with_damping(rounded).unwrap()), "rounding");
    let rayleigh = RayleighDamping::from_ratios([1.0, 8.0], [0.05; 2]).unwrap();
    for beta in [rayleigh, RayleighDamping::new(0.0, 0.05).unwrap()] {
        let model = tower(6, 40).with_rayleigh(beta);
        let mut digits = Triplets::new(model.dofs());
        let mut full = Triplets::new(model.dofs());
        model.damping(&mut full).unwrap();
        for &(i, j, value) in full.entries() {
            digits.add(i, j, format!("{value:.7e}").parse().unwrap());
        }
        let [mut mass, mut stiffness] = [(); 2].map(|()| Triplets::new(model.dofs()));
        model.mass(&mut mass).unwrap();
        model.stiffness(&mut stiffness).unwrap();
        let given = MatrixModel::new(mass, stiffness, model.base()).unwrap();
        passes(Box::new(given.with_damping(digits).unwrap()), "file");
        passes(Box::new(CraigBampton::new(20).reduce(model.clone()).unwrap()), "reduced");
        passes(Box::new(model), "Rayleigh");
    }
    passes(Box::new(ModalDamping::new(&[0.05]).unwrap().on(tower(4, 12)).unwrap()), "modal");
    let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
    let building = ShearBuilding::new(6.0, 50.0e3, 4.0e5, &storeys).unwrap();
    let building = building.with_p_delta(9.81).unwrap().with_stiffness_damping(0.01).unwrap();
    passes(Box::new(building), "P-delta");
    passes(Box::new(RigidBlock::new(4.0, 4.0, 2000.0).unwrap()), "block");
}

/// A damper of elements that pushes instead of braking.
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

#[test]
fn elements_that_feed_energy_in_are_refused_unless_they_are_meant_to() {
    let model = || -> Result<FemModel> {
        let mut mesh = tower(2, 4).mesh().clone();
        let top = mesh.node_at(0.0, 15.0)?;
        let below = mesh.node_at(0.0, 11.25)?;
        mesh.add(Pusher([below, top]))?;
        FemModel::on_base(mesh)
    };
    let refused = on_soil(model().unwrap()).build().err();
    assert!(matches!(refused, Some(Error::Indefinite { matrix: "damping matrix", .. })));
    assert!(on_soil(model().unwrap().with_active_damping()).build().is_ok());
}
