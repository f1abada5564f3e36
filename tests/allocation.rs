//! GOAL: no step allocates after warm-up, whatever the scene, nor does recording once memory is reserved.
//! SCENE: bonded, sliding and uplifting blocks and towers, in modes and in degrees of freedom; both grounds.
//! REFERENCE: a global allocator that counts per thread, so tests on other threads do not disturb the count.
#![allow(unsafe_code, reason = "an allocator that counts has to be one")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::{Coordinates, Joint, Load, Probe, SimulationBuilder, Theta};
use basemat::fem::{
    BeamFormulation, DruckerPrager, Iwan, Material, Mesh, Quad4, QuadFormulation, SharedMaterial,
};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::interface::{Bonded, Cohesive, CyclicYielding, InPlane, InterfaceLaw, Yielding};
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::results::Recorder;
use basemat::structure::{
    FemModel, NonlinearForce, RayleighDamping, RigidBlock, RigidBody, Structure, StructureGroup,
    Triplets,
};
use basemat::{Simulation, unobserved};

use basemat_problems::fiber_tables::FiberTable;
use basemat_problems::laws_with_memory::{SlipWeakening, SofteningPads};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene, soil, tower};
use basemat_problems::yielding_blocks::grid_lines;
use basemat_problems::yielding_springs::spring_column;
use basemat_problems::{needed_from, own_force};

/// The system's allocator, with a count for each thread.
struct CountingAllocator;

thread_local! {
    static ALLOCATION_COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count_allocation() {
    // A thread that ends may allocate after its count is gone.
    let _ = ALLOCATION_COUNT.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call is passed to the system's allocator unchanged.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_allocation();
        // SAFETY: as for the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as for the caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_allocation();
        // SAFETY: as for the caller.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// A block with a quadratic spring on its rotation, whose tangent is written as a constant.
struct QuadraticSpring(RigidBlock);

impl Structure for QuadraticSpring {
    needed_from!(0);

    own_force!();
}

impl NonlinearForce for QuadraticSpring {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        force[2] += 1e5 * u[2] + 1e3 * u[2] * u[2];
        Ok(())
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add(2, 2, 1e5);
        Ok(())
    }
}

/// Steps before counting: two leaves of the history's transforms, so that every path was taken.
const WARM_UP_STEPS: usize = 128;
const COUNTED_STEPS: usize = 640;
const ALL_STEPS: usize = WARM_UP_STEPS + COUNTED_STEPS;

/// What was counted in the steps of a scene.
struct StepCounts {
    allocations: usize,
    mode_changes: usize,
}

fn count_steps(builder: SimulationBuilder) -> StepCounts {
    let builder = builder.probe(Probe::displacement("u", vec![(0, 1.0)]));
    let mut simulation = builder.expected_steps(ALL_STEPS).build().unwrap();
    for _ in 0..WARM_UP_STEPS {
        simulation.step().unwrap();
    }
    let start_count = ALLOCATION_COUNT.get();
    let mut mode_changes = 0;
    for _ in 0..COUNTED_STEPS {
        let state = simulation.step().unwrap();
        assert_eq!(state.probe("u"), Ok(state.probes[0]));
        mode_changes += state.transitions.len();
        mode_changes += state.joints.iter().map(|joint| joint.transitions.len()).sum::<usize>();
    }
    StepCounts { allocations: ALLOCATION_COUNT.get() - start_count, mode_changes }
}

/// El Centro along a diagonal.
fn diagonal_motion(factor: f64) -> Triaxial {
    let record = el_centro_1940().scaled(factor).unwrap();
    Triaxial { x: Some(record.clone()), y: Some(record), up: None }
}

fn square_body() -> RigidBody {
    RigidBody::cuboid([4.0, 4.0, 6.0], 1500.0).unwrap()
}

/// A block on a square of cells, shaken along a diagonal.
fn in_plan(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = square_body();
    let ground = ElasticGround::under(soil(SI_UNITS), &body, 6).unwrap();
    let builder = Simulation::builder(2.5e-3).ground(ground).structure(body);
    builder.interface(law).motion(diagonal_motion(2.0))
}

/// The same on a mat of 100 cells or more, for which W is stored in blocks.
fn on_many_cells(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = square_body();
    let ground = ElasticGround::under(soil(SI_UNITS), &body, 12).unwrap();
    let builder = Simulation::builder(5e-4).ground(ground).structure(body);
    builder.interface(law).motion(diagonal_motion(60.0))
}

/// The same on a bed of many springs, which needs no matrices between its elements.
fn on_a_bed(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = square_body();
    let ground = SpringGround::under(&body, 12, 5e7, 4e7).unwrap();
    let ground = ground.with_dashpots(5e5, 5e5).unwrap();
    let builder = Simulation::builder(5e-3).ground(ground).structure(body);
    builder.interface(law).motion(diagonal_motion(2.0))
}

/// Samples of El Centro before its strong part.
const WEAK_SAMPLES: usize = 70;

/// A table on columns of fibres that yields, lifts off and slides.
fn table(formulation: BeamFormulation) -> SimulationBuilder {
    let table = FiberTable::of_steel(formulation).unwrap();
    let model = table.model().unwrap().model.with_p_delta(9.81).unwrap();
    let ground = SpringGround::under(&model, 8, 6e7, 5e7).unwrap();
    let builder = Simulation::builder(5e-3).ground(ground).structure(model);
    builder.interface(friction(0.6)).motion(strong_motion())
}

/// El Centro along both axes from its strong part on: what yields does so before allocations are counted.
fn strong_motion() -> Triaxial {
    let record = el_centro_1940();
    let accelerations = record.accelerations().iter().skip(WEAK_SAMPLES).copied().collect();
    let strong_part = Record::new(record.time_step(), accelerations).unwrap();
    let [x, y] = [4.0, 2.4].map(|factor| Some(strong_part.scaled(factor).unwrap()));
    Triaxial { x, y, up: None }
}

/// The shaken strip without structure and law.
fn base() -> SimulationBuilder {
    scene(SI_UNITS, 0.6)
}

/// The same on springs.
fn base_on_springs() -> SimulationBuilder {
    base().ground(SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap())
}

/// The same with the history by its direct sum.
fn base_with_direct_history() -> SimulationBuilder {
    let strip = Strip::uniform(-2.0..2.0, 8).unwrap();
    let ground = ElasticGround::new(soil(SI_UNITS), strip).unwrap();
    base().ground(ground.with_history(HistoryMethod::Direct).unwrap())
}

/// A damped tower that slides.
fn sliding_tower() -> SimulationBuilder {
    let damping = RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap();
    base().structure(tower(SI_UNITS, Some(damping))).interface(friction(0.2))
}

/// A bonded tower without damping.
fn bonded_tower() -> SimulationBuilder {
    base().structure(tower(SI_UNITS, None)).interface(Bonded)
}

/// A block that slides and rocks on another one, which is bonded to the ground.
fn stacked_blocks() -> SimulationBuilder {
    let lower = RigidBlock::new(4.0, 1.0, 2000.0).unwrap();
    let upper = RigidBlock::new(2.0, 4.0, 2000.0).unwrap();
    let top = lower.contact_nodes(&[[-1.0, 1.0], [1.0, 1.0]]).unwrap();
    let bottom = upper.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]]).unwrap();
    let group = StructureGroup::new().with(lower, 0.0).unwrap();
    let group = group.with_above(upper, [0.0, 1.0]).unwrap();
    let upper_side = group.contact_nodes(1, bottom).unwrap();
    let lower_side = group.contact_nodes(0, top).unwrap();
    let joint = Joint::between(upper_side, lower_side, 6).unwrap();
    base().structure(group).interface(Bonded).joint(joint.with_law(friction(0.3)))
}

/// Soil that settles in every cycle.
fn cyclic_yielding() -> CyclicYielding {
    let law = CyclicYielding::new(4e5, 3e-3, 0.3).unwrap();
    law.with_elastic_range(0.1).unwrap().with_depth_gradient(1e6).unwrap()
}

/// Block of clay that yields, of columns × rows elements.
fn yielding_block(columns: usize, rows: usize) -> FemModel {
    let clay: SharedMaterial = Iwan::hyperbolic(40e6, 90e3, 0.45, 0.45, 1900.0).unwrap().into();
    let x_lines = grid_lines(-2.0, 4.0, columns);
    let y_lines = grid_lines(0.0, 5.0, rows);
    FemModel::on_base(Mesh::quad8_block(&x_lines, &y_lines, |_, _| clay.clone()).unwrap()).unwrap()
}

/// Scenes in the plane.
fn plane_scenes() -> Vec<(&'static str, SimulationBuilder)> {
    let modes = Coordinates::Modes;
    let reduced = Coordinates::Reduced { tolerance: 1e-3 };
    let block = block(SI_UNITS);
    let weakening = SlipWeakening { first: 0.3, residual: 0.1, distance: 0.1 };
    let pads = SofteningPads { stiffness: [5e7, 4e7], softening: 1e5 };
    let theta = Theta::new(0.6).unwrap();
    vec![
        ("bonded", bonded_tower()),
        ("bonded, modes", bonded_tower().coordinates(modes)),
        ("sliding", sliding_tower().scheme(theta)),
        ("sliding, modes", sliding_tower().coordinates(modes)),
        ("sliding, reduced", sliding_tower().coordinates(reduced)),
        ("uplift", base().structure(block.clone()).interface(friction(f64::INFINITY))),
        ("frictionless", base().structure(block.clone()).interface(friction(0.0))),
        (
            "direct history",
            base_with_direct_history().structure(block.clone()).interface(friction(0.3)),
        ),
        ("spring bed", base_on_springs().structure(block.clone()).interface(friction(0.3))),
        ("state variables", base_on_springs().structure(block.clone()).interface(weakening)),
        ("bonded pads", base_on_springs().structure(block.clone()).interface(InPlane(pads))),
        (
            "loads, yielding",
            base()
                .structure(block.clone())
                .interface(Yielding::new(2.5e5, 0.3).unwrap())
                .load(Load::new(0, |t: f64| 3e4 * (40.0 * t).sin()))
                .load(Load::table([(1, 2.0)], &[0.0, 0.5, 9.0], &[0.0, 1e4, 0.0]).unwrap()),
        ),
        ("cyclic yielding", base().structure(block.clone()).interface(cyclic_yielding())),
        (
            "loads, modes",
            sliding_tower()
                .coordinates(modes)
                .load(Load::new(3, |t: f64| 3e4 * (40.0 * t).sin())),
        ),
        ("joint", stacked_blocks().scheme(Theta::new(1.0).unwrap())),
        ("Newton", base().structure(QuadraticSpring(block)).interface(friction(0.3))),
        ("yielding column", base().structure(spring_column(8)).interface(friction(0.3))),
        ("yielding block", base().structure(yielding_block(2, 3)).interface(friction(0.3))),
        ("large yielding block", base().structure(yielding_block(6, 10)).interface(friction(0.3))),
    ]
}

/// Scenes in plan.
fn plan_scenes() -> Vec<(&'static str, SimulationBuilder)> {
    vec![
        ("plan, sliding", in_plan(friction(0.3))),
        ("plan, uplift", in_plan(friction(2.0))),
        ("plan, many cells", on_many_cells(friction(0.3))),
        ("plan, bed", on_a_bed(friction(0.3))),
        ("plan, bed, uplift", on_a_bed(friction(f64::INFINITY))),
        ("plan, yielding", in_plan(Yielding::new(2.5e5, 0.3).unwrap())),
        ("plan, cyclic yielding", in_plan(cyclic_yielding())),
        ("plan, bed, cyclic yielding", on_a_bed(cyclic_yielding())),
        ("plan, many cells, cyclic yielding", on_many_cells(cyclic_yielding())),
        ("plan, fibres by displacements", table(BeamFormulation::DisplacementBased)),
        ("plan, fibres by forces", table(BeamFormulation::ForceBased)),
        ("plan, bonds", in_plan(Cohesive::new(5e4, 5e4, 0.3).unwrap())),
    ]
}

#[test]
fn steps_do_not_allocate() {
    // The counter counts.
    let start_count = ALLOCATION_COUNT.get();
    drop(std::hint::black_box(vec![0_u8; 100]));
    assert_eq!(ALLOCATION_COUNT.get() - start_count, 1);

    for (name, builder) in plane_scenes().into_iter().chain(plan_scenes()) {
        let StepCounts { allocations, mode_changes } = count_steps(builder);
        println!("{name}: {allocations} allocations, {mode_changes} changes of mode");
        assert_eq!(allocations, 0, "{name}");
        assert!(name.starts_with("bonded") || mode_changes > 0, "{name}: the modes never changed");
    }
}

/// Transforms along the surface and in time, also where the history is truncated.
#[test]
fn histories_in_plan_do_not_allocate() {
    for tolerance in [1e-10, 1e-2] {
        let options = HistoryOptions { tolerance: Some(tolerance), ..HistoryOptions::default() };
        let plan = Plan::rectangle(-2.0..2.0, -3.0..3.0, 4).unwrap();
        let mut ground = ElasticGround::in_plan(soil(SI_UNITS), plan).unwrap();
        ground = ground.with_history(options).unwrap();
        ground.prepare(0.01, Some(ALL_STEPS), &mut unobserved).unwrap();
        let size = 3 * ground.elements().len();
        let mut displacement = vec![0.0; size];
        let traction = vec![1.0; size];
        let mut start_count = 0;
        for step in 0..ALL_STEPS {
            if step == WARM_UP_STEPS {
                start_count = ALLOCATION_COUNT.get();
            }
            ground.history(&mut displacement).unwrap();
            ground.commit(&traction);
        }
        assert_eq!(ALLOCATION_COUNT.get() - start_count, 0, "{tolerance}");
        assert_eq!(ground.increment_error_bound() > 0.0, tolerance > 1e-3);
    }
}

#[test]
fn recording_does_not_allocate_once_memory_is_reserved() {
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(friction(0.3));
    for builder in [builder, stacked_blocks()] {
        assert_eq!(allocations_of_recording(builder), 0);
    }
}

/// Number of allocations while steps are made and recorded.
fn allocations_of_recording(builder: SimulationBuilder) -> usize {
    // From modes, the state itself has to make the degrees of freedom of a frame.
    let builder = builder.coordinates(Coordinates::Physical);
    let mut simulation = builder.expected_steps(ALL_STEPS).build().unwrap();
    let recorder = Recorder::new().contact(2).motion(3).foundations();
    let mut time_series = recorder.start(&simulation).unwrap();
    for _ in 0..WARM_UP_STEPS {
        time_series.record(simulation.step().unwrap()).unwrap();
    }
    time_series.reserve(COUNTED_STEPS).unwrap();
    let start_count = ALLOCATION_COUNT.get();
    for _ in 0..COUNTED_STEPS {
        time_series.record(simulation.step().unwrap()).unwrap();
    }
    let allocations = ALLOCATION_COUNT.get() - start_count;
    assert_eq!(time_series.times().len(), ALL_STEPS + 1);
    allocations
}

/// Blocks of soil: eight-node quadrilaterals, and one with four nodes.
fn soil_blocks(soil: &SharedMaterial) -> [FemModel; 2] {
    let lines = [0.0, 1.0, 3.0, 4.0];
    let mesh = Mesh::quad8_block(&lines, &lines, |_, _| soil.clone()).unwrap();
    let mut small_mesh = Mesh::new();
    for [x, y] in [[0.0, 0.0], [1.2, 0.0], [1.0, 1.0], [0.0, 1.1]] {
        small_mesh.add_node(x, y).unwrap();
    }
    let quad = Quad4::new([0, 1, 2, 3], soil.clone(), QuadFormulation::MeanDilatation);
    small_mesh.add(quad).unwrap();
    [FemModel::on_base(mesh).unwrap(), FemModel::new(small_mesh, &[0, 1]).unwrap()]
}

#[test]
fn forces_of_yielding_elements_do_not_allocate() {
    let clay = Iwan::hyperbolic(20.0e6, 40.0e3, 0.4, 0.49, 1900.0).unwrap();
    let elastic = Material::new(50.0e6, 0.3, 1900.0).unwrap();
    let sand = DruckerPrager::new(elastic, 5.0e3, 0.6, 0.2).unwrap();
    for soil in [clay.into(), sand.into()] {
        for mut model in soil_blocks(&soil) {
            let n = model.dofs();
            let mut displacement = vec![0.0; n];
            let mut midstep = vec![0.0; n];
            let mut force = vec![0.0; n];
            let mut tangent = Triplets::new(n);
            let mut allocations = 0;
            let mut dissipated_energy = 0.0;
            for step in 0..20 {
                let start_count = ALLOCATION_COUNT.get();
                for (dof, value) in displacement.iter_mut().enumerate() {
                    midstep[dof] = *value;
                    *value = 5e-3 * ((dof * (step + 3)) as f64).sin();
                    midstep[dof] = 0.5 * (midstep[dof] + *value);
                }
                let nonlinear = model.nonlinear_mut().unwrap();
                nonlinear.force(&midstep, &mut force).unwrap();
                tangent.clear();
                nonlinear.tangent(&midstep, &mut tangent).unwrap();
                assert!(nonlinear.remainder(&midstep, &displacement).unwrap().is_finite());
                dissipated_energy = nonlinear.energy(&displacement).unwrap().dissipated;
                nonlinear.commit(&displacement);
                // The first tangent reserves its entries.
                if step > 0 {
                    allocations += ALLOCATION_COUNT.get() - start_count;
                }
            }
            assert_eq!(allocations, 0);
            assert!(dissipated_energy > 0.0);
        }
    }
}
