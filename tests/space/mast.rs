//! A mass on horizontal springs above a rigid body: wrapped, reduced, and in all coordinates; bodies by their matrices.

use std::f64::consts::TAU;

use basemat::coupled::Coordinates;
use basemat::interface::Bonded;
use basemat::structure::{
    Base, CraigBampton, DofCombination, MatrixModel, ModalDamping, PlanStorey, RigidBody,
    StoreyBuilding, Structure, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation};

use super::cells::{BED, Cells, Waves};
use super::storeys;

const SIDES: [f64; 3] = [8.0, 6.0, 3.0];
const DENSITY: f64 = 2000.0;
/// Above the middle of the base.
const MASS: f64 = 1.2e5;
const HEIGHT: f64 = 11.0;
/// Along x and y.
const SPRINGS: [f64; 2] = [9.0e7, 5.0e7];

struct Mast(RigidBody);

fn mast() -> Mast {
    Mast(RigidBody::cuboid(SIDES, DENSITY).unwrap().centered_at([3.0, 1.0]).unwrap())
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
        // It rises with the body.
        for i in [2, 6, 7] {
            matrix.add(i, i, MASS);
        }
        Ok(())
    }
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        let [along, away, _] = self.0.displacement_at([0.0, 0.0, HEIGHT]);
        for (top, below, spring) in [(6, along, SPRINGS[0]), (7, away, SPRINGS[1])] {
            let drift = DofCombination::from(top) - below;
            matrix.add_outer(&drift, spring);
        }
        Ok(())
    }
}

/// Of the free structure: k (1/m + 1/M + (h − c)²/J), the compliance of a free body at the spring.
fn frequencies() -> [f64; 2] {
    let [l, b, h] = SIDES;
    let body = l * b * h * DENSITY;
    [(SPRINGS[0], l), (SPRINGS[1], b)].map(|(spring, side)| {
        let inertia = body * (side * side + h * h) / 12.0;
        let lever = HEIGHT - 0.5 * h;
        let square = spring * (1.0 / MASS + 1.0 / body + lever * lever / inertia);
        square.sqrt() / TAU
    })
}

#[test]
fn rigid_motions_in_plan_have_no_modal_damping() {
    let damped = ModalDamping::new(&[0.05]).unwrap().on(mast()).unwrap();
    let mut exact = frequencies();
    exact.sort_by(f64::total_cmp);
    assert_eq!(damped.frequencies().len(), 2, "{:?}", damped.frequencies());
    for (found, exact) in damped.frequencies().iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
    }
    let fixed = ModalDamping::new(&[0.05]).unwrap().on_fixed_base(mast()).unwrap();
    let exact = [SPRINGS[1], SPRINGS[0]].map(|spring: f64| (spring / MASS).sqrt() / TAU);
    assert_eq!(fixed.frequencies().len(), 2, "{:?}", fixed.frequencies());
    for (found, exact) in fixed.frequencies().iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    }
}

fn march(structure: impl Structure + 'static, coordinates: Coordinates) -> Vec<f64> {
    let mut simulation = Simulation::builder(2e-3)
        .structure(structure)
        .ground(Cells::under([SIDES[0], SIDES[1]], [3.0, 1.0], [5, 4], BED))
        .interface(Bonded)
        .motion(Waves { quarters: 0 })
        .coordinates(coordinates)
        .expected_steps(400)
        .build()
        .unwrap();
    let run = simulation.run(400, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    simulation.state().absolute_displacement().to_vec()
}

#[test]
fn all_coordinates_and_wrappers_march_alike() {
    let damping = ModalDamping::new(&[0.05]).unwrap();
    let damped = || damping.on(mast()).unwrap();
    let exact = march(damped(), Coordinates::Physical);
    let size = exact.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let reduce = |structure: Box<dyn Structure>| CraigBampton::new(2).reduce(structure).unwrap();
    let before = damping.on(reduce(Box::new(mast()))).unwrap();
    let after = reduce(Box::new(damped()));
    let top = [6, 7].map(|i| exact[i]);
    assert!(top.iter().all(|u| u.abs() > 1e-2 * size));
    for (found, tolerance) in [
        (march(damped(), Coordinates::Modes), 1e-9),
        (march(damped(), Coordinates::Reduced { tolerance: 1e-8 }), 1e-7),
        (march(WithSprings::new(damped()), Coordinates::Physical), 0.0),
    ] {
        for (found, exact) in found.iter().zip(&exact) {
            assert!((found - exact).abs() <= tolerance * size, "{found} {exact}");
        }
    }
    // The base is kept, the top is coordinates of modes.
    for found in [march(before, Coordinates::Physical), march(after, Coordinates::Physical)] {
        for (found, exact) in found[..6].iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-9 * size, "{found} {exact}");
        }
    }
}

/// The matrices of a body, and of a building that was reduced before or after, give the structure's own results.
#[test]
fn given_matrices_are_the_structure_that_has_them() {
    let model = |own: &dyn Structure| {
        let matrix = |fill: &dyn Fn(&mut Triplets)| {
            let mut matrix = Triplets::new(own.dofs());
            fill(&mut matrix);
            matrix
        };
        MatrixModel::new(
            matrix(&|m| own.mass(m).unwrap()),
            matrix(&|m| own.stiffness(m).unwrap()),
            own.base(),
        )
        .and_then(|model| model.with_damping(matrix(&|m| own.damping(m).unwrap())))
        .unwrap()
    };
    let ground = || Cells::under([SIDES[0], SIDES[1]], [3.0, 1.0], [4, 3], BED);
    let run = |structure: Box<dyn Structure>| {
        storeys::march(structure, ground(), Waves { quarters: 0 }, 200)
            .state()
            .displacement()
            .to_vec()
    };
    let body = || RigidBody::cuboid(SIDES, 2400.0).unwrap().centered_at([3.0, 1.0]).unwrap();
    assert_eq!(run(Box::new(body())), run(Box::new(model(&body()))));

    let storeys = [PlanStorey::new(3.0, 1e5, [9.0; 2], [2e8, 3e8, 4e9]); 4];
    let tall = StoreyBuilding::new(body(), &storeys).unwrap();
    let whole = run(Box::new(tall.clone()));
    assert_eq!(whole, run(Box::new(model(&tall))));
    let reduced = CraigBampton::new(12).reduce(model(&tall)).unwrap();
    let recovery = reduced.recovery();
    let found = recovery.full(&run(Box::new(reduced))).unwrap();
    for (found, exact) in found.iter().zip(&whole) {
        assert!((found - exact).abs() < 1e-12, "{found} {exact}");
    }
}

#[test]
fn matrices_that_are_none() {
    let unit = |n: usize| Triplets::from_entries(n, (0..n).map(|k| (k, k, 1.0)));
    let made = MatrixModel::new(unit(6), Triplets::new(6), Base::Faces(Vec::new()));
    assert!(matches!(made, Err(Error::Size { .. })));
    let made = MatrixModel::new(unit(5), Triplets::new(5), mast().base());
    assert!(matches!(made, Err(Error::Index { index: 5, bound: 5, .. })));
    let made = MatrixModel::new(unit(6), Triplets::new(5), mast().base());
    assert!(matches!(made, Err(Error::Size { .. })));
}
