//! GOAL: Craig–Bampton reduction.
//! SCENE: a damped tower reduced to a few modes, with springs on kept degrees of freedom.
//! REFERENCE: the full model, closed-form cantilever modes, the ratios on a fixed base.

use basemat::Error;
use basemat::coupled::{Coordinates, Probe};
use basemat::fem::Direction;
use basemat::structure::StructureError;
use basemat::structure::{
    BaseNode, Bilinear, CraigBampton, FemModel, MatrixModel, ModalDamping, RayleighDamping,
    Recovery, ReducedModel, Structure, StructureGroup, Triplets, WithSprings,
};

use super::model::{on_soil, tower};
use basemat_problems::dense::{self, largest};

fn damped() -> FemModel {
    tower(6, 12).with_rayleigh(RayleighDamping::from_ratios([1.0, 8.0], [0.03; 2]).unwrap())
}

fn top(model: &FemModel) -> usize {
    model.dof(model.mesh().node_at(0.0, 15.0).unwrap(), Direction::X).unwrap()
}

/// A structure's matrix times a vector.
fn product(
    structure: &dyn Structure,
    fill: fn(&dyn Structure, &mut Triplets) -> basemat::Result<()>,
    x: &[f64],
) -> Vec<f64> {
    let mut matrix = Triplets::new(structure.dofs());
    fill(structure, &mut matrix).unwrap();
    dense::product(&matrix, x)
}

/// Reduced degrees of freedom of a motion of the full model that is a combination of static shapes.
fn static_motion(recovery: &Recovery, order: usize, full: &[f64]) -> Vec<f64> {
    let mut reduced: Vec<f64> = recovery.kept().iter().map(|&dof| full[dof]).collect();
    reduced.resize(order, 0.0);
    reduced
}

#[test]
fn rigid_motions_and_their_inertia_are_exact() {
    let model = damped();
    let rigid_motions = [Direction::X, Direction::Y, Direction::Rotation]
        .map(|direction| model.rigid_motion(direction, [0.0; 3]));
    let inertia: Vec<Vec<f64>> =
        rigid_motions.iter().map(|motion| product(&model, Structure::mass, motion)).collect();
    let reduced_structure = CraigBampton::new(5).reduce(model).unwrap();
    let recovery = reduced_structure.recovery();
    let order = reduced_structure.dofs();
    for (motion, momentum) in rigid_motions.iter().zip(&inertia) {
        let q = static_motion(&recovery, order, motion);
        let recovered_motion = recovery.full(&q).unwrap();
        let difference: Vec<f64> =
            recovered_motion.iter().zip(motion).map(|(a, b)| a - b).collect();
        assert!(largest(&difference) < 1e-9 * largest(motion), "{:e}", largest(&difference));
        let force = product(&reduced_structure, Structure::stiffness, &q);
        assert!(largest(&force) < 1e-11 * 2.0e9 * largest(motion), "{:e}", largest(&force));
        for other_motion in &rigid_motions {
            let expected: f64 = other_motion.iter().zip(momentum).map(|(a, b)| a * b).sum();
            let other_q = static_motion(&recovery, order, other_motion);
            let momentum = product(&reduced_structure, Structure::mass, &q);
            let computed: f64 = momentum.iter().zip(&other_q).map(|(a, b)| a * b).sum();
            let scale = 15.0_f64.powi(2) * 180e3;
            assert!((computed - expected).abs() < 1e-9 * scale, "{computed} {expected}");
        }
    }
}

/// Five seconds of the full model: displacement of the top and base moment in all steps, and the last displacement.
struct FullRun {
    series: Vec<[f64; 2]>,
    displacement: Vec<f64>,
}

impl FullRun {
    fn new(steps: usize) -> Self {
        let model = damped();
        let row = top(&model);
        let mut simulation = on_soil(model)
            .probe(Probe::displacement("top", row))
            .coordinates(Coordinates::Physical)
            .build()
            .unwrap();
        let mut series = Vec::new();
        simulation
            .run(steps, |state| series.push([state.probes[0], state.base_moment]))
            .unwrap();
        Self { series, displacement: simulation.state().displacement().to_vec() }
    }

    fn peak(&self, k: usize) -> f64 {
        self.series.iter().fold(0.0_f64, |m, pair| m.max(pair[k].abs()))
    }
}

/// Displacement of the top and base moment of the reduced model against the full model, uplift and sliding included:
/// the errors fall with the number of modes, to none with all modes.
#[test]
fn reduced_models_converge_to_the_full_model() {
    let steps = 500;
    let full_run = FullRun::new(steps);
    let peaks = [full_run.peak(0), full_run.peak(1)];
    let interior = damped().dofs() - 14;
    let mut previous_error = f64::INFINITY;
    for (modes, limit) in [(1, 0.2), (4, 0.04), (16, 0.004), (interior, 1e-7)] {
        let model = damped();
        let dof = top(&model);
        let reduced_structure = CraigBampton::new(modes).reduce(model).unwrap();
        assert_eq!(reduced_structure.dofs(), 14 + modes);
        let recovery = reduced_structure.recovery();
        let probe = recovery.probe(Probe::displacement("top", dof)).unwrap();
        assert!(probe.velocity.is_empty() && probe.acceleration.is_empty());
        let mut simulation = on_soil(reduced_structure).probe(probe).build().unwrap();
        let mut errors = [0.0_f64; 2];
        let mut step = 0;
        let run = simulation
            .run(steps, |state| {
                for (k, value) in [state.probes[0], state.base_moment].into_iter().enumerate() {
                    errors[k] = errors[k].max((value - full_run.series[step][k]).abs() / peaks[k]);
                }
                step += 1;
            })
            .unwrap();
        println!(
            "{modes} modes: error of the sway {:.1e}, of the moment {:.1e}",
            errors[0], errors[1]
        );
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        assert!(errors[0] < limit && errors[0] < previous_error, "{modes} modes: {errors:?}");
        previous_error = errors[0];
        let recovered_displacement = recovery.full(simulation.state().displacement()).unwrap();
        assert!((recovered_displacement[dof] - simulation.state().probes[0]).abs() < 1e-12);
        if modes == interior {
            let difference: Vec<f64> = recovered_displacement
                .iter()
                .zip(&full_run.displacement)
                .map(|(a, b)| a - b)
                .collect();
            assert!(largest(&difference) < 1e-6 * peaks[0], "{:e}", largest(&difference));
        }
    }
}

fn yielding_law() -> Bilinear {
    Bilinear::new(3.0e7, 2.0e4, 0.05).unwrap()
}

/// Hysteretic energy and largest base shear of three seconds.
fn march_with_springs(structure: WithSprings) -> [f64; 2] {
    let mut simulation = on_soil(structure).build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    [run.energy_balance.hysteresis, run.whole.base_shear.largest().value]
}

/// Kept degrees of freedom are those of the full model, and springs on them act as on the full model.
#[test]
fn springs_on_kept_dofs_are_those_of_the_full_model() {
    let model = damped();
    let dof = top(&model);
    let corner = model.dof(0, Direction::X).unwrap();
    let brace = vec![(dof, 1.0), (corner, -1.0)];
    let full_structure = WithSprings::new(damped()).spring(brace.clone(), yielding_law()).unwrap();
    let expected = march_with_springs(full_structure);
    let reduced_structure = CraigBampton::new(60).keep(&[dof]).reduce(model).unwrap();
    let recovery = reduced_structure.recovery();
    let place = recovery.kept().iter().position(|kept| *kept == dof).unwrap();
    let row = recovery.row(&brace[..]).unwrap();
    for (index, weight) in &row {
        let is_end = *index == place || recovery.kept().get(*index) == Some(&corner);
        assert_eq!(weight.abs(), f64::from(u8::from(is_end)), "{index}");
    }
    let computed = march_with_springs(
        WithSprings::new(reduced_structure).spring(row, yielding_law()).unwrap(),
    );
    assert!(expected[0] > 100.0, "no yielding");
    assert!((computed[0] / expected[0] - 1.0).abs() < 0.01, "{computed:?} {expected:?}");
    assert!((computed[1] / expected[1] - 1.0).abs() < 0.02, "{computed:?} {expected:?}");
}

/// The matrices of the modes on a fixed base: stiffness ω², mass 1, damping 2 ζ ω.
#[test]
fn damping_ratios_are_those_of_the_modes_on_a_fixed_base() {
    let reduced_structure =
        CraigBampton::new(3).reduce(tower(6, 12)).unwrap().with_damping_ratio(0.04).unwrap();
    let order = reduced_structure.dofs();
    for (k, frequency) in reduced_structure.frequencies().iter().enumerate() {
        let mut q = vec![0.0; order];
        q[order - 3 + k] = 1.0;
        let place = order - 3 + k;
        let w = std::f64::consts::TAU * frequency;
        let stiffness = product(&reduced_structure, Structure::stiffness, &q)[place];
        assert!((stiffness / (w * w) - 1.0).abs() < 1e-12);
        let mass = product(&reduced_structure, Structure::mass, &q)[place];
        assert!((mass - 1.0).abs() < 1e-10);
        let damping = product(&reduced_structure, Structure::damping, &q)[place];
        assert!((damping / (2.0 * 0.04 * w) - 1.0).abs() < 1e-12);
    }
}

/// The first mode of a slender cantilever: 1.8751² √(EI/(m L⁴)), with E/(1−ν²) in plane strain.
#[test]
fn modes_on_a_fixed_base_are_those_of_a_cantilever() {
    use basemat::fem::{Layer, Material, Mesh};
    let material = Material::new(2.0e9, 0.2, 2000.0).unwrap();
    let mesh = Mesh::layered_block(-0.5..0.5, 4, &[Layer::new(40.0, 160, material)]).unwrap();
    let reduced_structure = CraigBampton::new(2).reduce(FemModel::on_base(mesh).unwrap()).unwrap();
    let stiffness = 2.0e9 / (1.0 - 0.04) / 12.0;
    let speed = (stiffness / 2000.0_f64).sqrt() / 40.0_f64.powi(2) / std::f64::consts::TAU;
    for (frequency, root) in reduced_structure.frequencies().iter().zip([1.875_104, 4.694_091_f64])
    {
        let expected = root * root * speed;
        assert!((frequency / expected - 1.0).abs() < 5e-3, "{frequency} {expected}");
    }
}

/// The error of a reduction that must fail.
fn reduction_error(result: basemat::Result<ReducedModel>) -> Error {
    result.err().unwrap()
}

#[test]
fn invalid_reductions_are_errors() {
    let law = Bilinear::new(1e6, 1e3, 0.0).unwrap();
    let springs = WithSprings::new(tower(2, 2)).spring(vec![(0, 1.0)], law).unwrap();
    let error = reduction_error(CraigBampton::new(1).reduce(springs));
    assert!(matches!(error, Error::Scene { .. }));
    let error = reduction_error(CraigBampton::new(1).keep(&[1000]).reduce(tower(2, 2)));
    assert!(matches!(error, Error::Index { index: 1000, .. }));
    let error = reduction_error(CraigBampton::new(13).reduce(tower(2, 2)));
    assert!(matches!(error, Error::Size { found: 13, needed: 12, .. }));
    // A node without a connection.
    let mut mesh = basemat::fem::Mesh::layered_block(
        -1.0..1.0,
        2,
        &[basemat::fem::Layer::new(1.0, 1, basemat::fem::Material::new(1e9, 0.2, 2e3).unwrap())],
    )
    .unwrap();
    let free_node = mesh.add_node(0.0, 5.0).unwrap();
    mesh.add(basemat::fem::LumpedMass::new(free_node, 10.0).unwrap()).unwrap();
    let hanging = CraigBampton::new(1).reduce(FemModel::on_base(mesh).unwrap());
    let Error::Structure(StructureError::Detached { dofs, place }) = reduction_error(hanging)
    else {
        panic!()
    };
    assert_eq!((dofs, place.as_str()), (vec![12, 13], "node 6 at (0, 5)"));
    let reduced_structure = CraigBampton::new(2).reduce(tower(2, 2)).unwrap();
    for invalid_value in [-0.1, f64::NAN, f64::INFINITY] {
        let reduced_structure = CraigBampton::new(2).reduce(tower(2, 2)).unwrap();
        let error = reduction_error(reduced_structure.with_damping_ratio(invalid_value));
        assert!(matches!(error, Error::Input { .. }));
    }
    let recovery = reduced_structure.recovery();
    assert_eq!(recovery.full_dofs(), 18);
    assert!(matches!(recovery.row(18), Err(Error::Index { .. })));
    let probe = Probe::displacement("far", 18);
    assert!(
        matches!(recovery.probe(probe), Err(Error::Item { item, .. }) if item == "probe 'far'")
    );
    assert!(matches!(recovery.row((0, f64::NAN)), Err(Error::Input { .. })));
    assert!(matches!(recovery.full(&[0.0; 3]), Err(Error::Size { .. })));
    // Entries out of range of a matrix are an error where the matrix is used.
    reduced_structure.mass(&mut Triplets::new(0)).unwrap();
    // With all degrees of freedom kept it is the same structure.
    let all_dofs: Vec<usize> = (0..18).collect();
    let unreduced_structure = CraigBampton::new(0).keep(&all_dofs).reduce(tower(2, 2)).unwrap();
    assert_eq!(unreduced_structure.dofs(), 18);
}

/// A tower of 100 m on 12 × 200 quadrilaterals.
fn tall_tower() -> FemModel {
    use basemat::fem::{Layer, MassKind, Material, Mesh};
    let material = Material::new(5.0e9, 0.2, 600.0).unwrap();
    let mesh = Mesh::layered_block(-3.0..3.0, 12, &[Layer::new(100.0, 200, material)]).unwrap();
    FemModel::on_base(mesh).unwrap().with_mass(MassKind::Lumped)
}

/// The sums over a large stiffness matrix are not zero to the last bit, which must have no effect on the
/// static state.
#[test]
fn static_forces_of_tall_meshes_are_their_weight() {
    let weight = 6.0 * 100.0 * 600.0 * basemat::motion::STANDARD_GRAVITY;
    let reduced_simulation =
        on_soil(CraigBampton::new(4).reduce(tall_tower()).unwrap()).build().unwrap();
    let full_simulation = on_soil(tall_tower()).coordinates(Coordinates::Physical).build().unwrap();
    for simulation in [&full_simulation, &reduced_simulation] {
        assert!((simulation.state().normal_force / weight - 1.0).abs() < 1e-7);
    }
    for (a, b) in full_simulation.state().contact.iter().zip(&reduced_simulation.state().contact) {
        // Forces on the base act through static shapes, weight of the interior through the modes that are kept.
        assert!((a.pressure - b.pressure).abs() < 1e-2 * weight / 6.0, "{a:?} {b:?}");
    }
}

/// A weightless mast on a rigid base has no modes.
#[test]
fn without_mass_or_dofs_there_are_no_modes() {
    let mut mass = Triplets::new(4);
    (0..3).for_each(|dof| mass.add(dof, dof, 1e4));
    let mut stiffness = Triplets::new(4);
    stiffness.add_outer([(3, 1.0), (0, -1.0), (2, 5.0)], 4e6);
    let contact = BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]);
    let mast = MatrixModel::new(mass, stiffness, contact).unwrap();
    for modes in [0, 1] {
        let reduced_structure = CraigBampton::new(modes).reduce(mast.clone()).unwrap();
        assert_eq!(reduced_structure.dofs(), 3);
        assert!(reduced_structure.frequencies().is_empty());
    }
    let damping_of_no_structure =
        ModalDamping::new(&[0.05]).unwrap().on(StructureGroup::new()).unwrap();
    assert!(damping_of_no_structure.frequencies().is_empty());
}
