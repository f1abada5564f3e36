//! GOAL: no step allocates after warm-up, whatever the scene, nor does recording once memory is
//! reserved.
//! SCENE: bonded, sliding and uplifting blocks and towers, in modes and in degrees of freedom; both grounds.
//! REFERENCE: a global allocator that counts per thread, so tests on other threads do not disturb the count.
#![allow(unsafe_code, reason = "an allocator that counts has to be one")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround, Strip};
use basemat::coupled::{Coordinates, Load, Probe, SimulationBuilder, Theta};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::interface::{Bonded, Cohesive, InPlane, InterfaceLaw, Yielding};
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::Recorder;
use basemat::structure::{
    NonlinearForce, RayleighDamping, RigidBlock, RigidBody, Structure, Triplets,
};
use basemat::{Simulation, unobserved};

use basemat_problems::laws_with_memory::{SlipWeakening, SofteningPads};
use basemat_problems::scenes::{SI, block, friction, scene, soil, tower};
use basemat_problems::{needed_from, own_force};

/// The system's allocator, with a count for each thread.
struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends may allocate after its count is gone.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as for the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as for the caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as for the caller.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A block with a damper that pulls back with −(1 + u₀²) f₀: its force is nonlinear, its tangent is
/// written as a constant.
struct Quadratic(RigidBlock);

impl Structure for Quadratic {
    needed_from!(0);

    own_force!();
}

impl NonlinearForce for Quadratic {
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
const WARM: usize = 128;
const STEPS: usize = 640;

fn allocations(builder: SimulationBuilder) -> (usize, usize) {
    let builder = builder.probe(Probe::displacement("u", vec![(0, 1.0)]));
    let mut simulation = builder.expected_steps(WARM + STEPS).build().unwrap();
    for _ in 0..WARM {
        simulation.step().unwrap();
    }
    let (before, mut changes) = (COUNT.get(), 0);
    for _ in 0..STEPS {
        let state = simulation.step().unwrap();
        assert_eq!(state.probe("u"), Ok(state.probes[0]));
        changes += state.transitions.len();
    }
    (COUNT.get() - before, changes)
}

/// A block on a square of cells, shaken along a diagonal.
fn in_plan(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = RigidBody::cuboid([4.0, 4.0, 6.0], 1500.0).unwrap();
    let ground = ElasticGround::under(soil(SI), &body, 6).unwrap();
    let shake = || Some(el_centro_1940().scaled(2.0).unwrap());
    let motion = Triaxial { x: shake(), y: shake(), up: None };
    let builder = Simulation::builder(2.5e-3).ground(ground).structure(body);
    builder.interface(law).motion(motion)
}

/// The same on a mat of 100 cells or more, for which W is stored in blocks.
fn on_many_cells(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = RigidBody::cuboid([4.0, 4.0, 6.0], 1500.0).unwrap();
    let ground = ElasticGround::under(soil(SI), &body, 12).unwrap();
    let shake = || Some(el_centro_1940().scaled(60.0).unwrap());
    let motion = Triaxial { x: shake(), y: shake(), up: None };
    Simulation::builder(5e-4).ground(ground).structure(body).interface(law).motion(motion)
}

/// The same on a bed of many springs, which needs no matrices between its elements.
fn on_a_bed(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let body = RigidBody::cuboid([4.0, 4.0, 6.0], 1500.0).unwrap();
    let ground = SpringGround::under(&body, 12, 5e7, 4e7).unwrap();
    let shake = || Some(el_centro_1940().scaled(2.0).unwrap());
    let motion = Triaxial { x: shake(), y: shake(), up: None };
    let ground = ground.with_dashpots(5e5, 5e5).unwrap();
    Simulation::builder(5e-3).ground(ground).structure(body).interface(law).motion(motion)
}

#[test]
fn steps_do_not_allocate() {
    // The counter counts.
    let before = COUNT.get();
    drop(std::hint::black_box(vec![0_u8; 100]));
    assert_eq!(COUNT.get() - before, 1);

    let base = || scene(SI, 0.6);
    let damped = || tower(SI, Some(RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()));
    let direct = || {
        let ground = ElasticGround::new(soil(SI), Strip::uniform(-2.0..2.0, 8).unwrap()).unwrap();
        base().ground(ground.with_history(HistoryMethod::Direct).unwrap())
    };
    let bed = || SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap();
    let modes = Coordinates::Modes;
    let few = Coordinates::Reduced { tolerance: 1e-3 };
    let weakening = SlipWeakening { first: 0.3, residual: 0.1, distance: 0.1 };
    let pads = SofteningPads { stiffness: [5e7, 4e7], softening: 1e5 };
    let theta = Theta::new(0.6).unwrap();
    let scenes = [
        ("bonded", base().structure(tower(SI, None)).interface(Bonded)),
        ("bonded, modes", base().structure(tower(SI, None)).interface(Bonded).coordinates(modes)),
        ("sliding", base().structure(damped()).interface(friction(0.2)).scheme(theta)),
        ("sliding, modes", base().structure(damped()).interface(friction(0.2)).coordinates(modes)),
        ("sliding, reduced", base().structure(damped()).interface(friction(0.2)).coordinates(few)),
        ("uplift", base().structure(block(SI)).interface(friction(f64::INFINITY))),
        ("smooth", base().structure(block(SI)).interface(friction(0.0))),
        ("direct history", direct().structure(block(SI)).interface(friction(0.3))),
        ("spring bed", base().ground(bed()).structure(block(SI)).interface(friction(0.3))),
        ("memory", base().ground(bed()).structure(block(SI)).interface(weakening)),
        (
            "bonded pads with memory",
            base().ground(bed()).structure(block(SI)).interface(InPlane(pads)),
        ),
        (
            "loads, yielding",
            base()
                .structure(block(SI))
                .interface(Yielding::new(2.5e5, 0.3).unwrap())
                .load(Load::new(0, |t: f64| 3e4 * (40.0 * t).sin()))
                .load(Load::table([(1, 2.0)], &[0.0, 0.5, 9.0], &[0.0, 1e4, 0.0]).unwrap()),
        ),
        ("loads, modes", {
            let push = Load::new(3, |t: f64| 3e4 * (40.0 * t).sin());
            base().structure(damped()).interface(friction(0.2)).coordinates(modes).load(push)
        }),
        ("plan, sliding", in_plan(friction(0.3))),
        ("plan, uplift", in_plan(friction(2.0))),
        ("plan, many cells", on_many_cells(friction(0.3))),
        ("plan, bed", on_a_bed(friction(0.3))),
        ("plan, bed, uplift", on_a_bed(friction(f64::INFINITY))),
        ("plan, yielding", in_plan(Yielding::new(2.5e5, 0.3).unwrap())),
        ("plan, bonds", in_plan(Cohesive::new(5e4, 5e4, 0.3).unwrap())),
        ("Newton", base().structure(Quadratic(block(SI))).interface(friction(0.3))),
    ];
    for (name, builder) in scenes {
        let (allocations, changes) = allocations(builder);
        println!("{name}: {allocations} allocations, {changes} changes of mode");
        assert_eq!(allocations, 0, "{name}");
        assert!(name.starts_with("bonded") || changes > 0, "{name}: the modes never changed");
    }
}

/// Transforms along the surface and in time, also where memory ends.
#[test]
fn histories_in_plan_do_not_allocate() {
    for tolerance in [1e-10, 1e-2] {
        let options = HistoryOptions { tolerance: Some(tolerance), ..HistoryOptions::default() };
        let plan = Plan::rectangle(-2.0..2.0, -3.0..3.0, 4).unwrap();
        let mut ground = ElasticGround::in_plan(soil(SI), plan).unwrap();
        ground = ground.with_history(options).unwrap();
        ground.prepare(0.01, Some(WARM + STEPS), &mut unobserved).unwrap();
        let size = 3 * ground.elements().len();
        let (mut displacement, traction) = (vec![0.0; size], vec![1.0; size]);
        let mut before = 0;
        for step in 0..WARM + STEPS {
            if step == WARM {
                before = COUNT.get();
            }
            ground.history(&mut displacement).unwrap();
            ground.commit(&traction);
        }
        assert_eq!(COUNT.get() - before, 0, "{tolerance}");
        assert_eq!(ground.increment_error_bound() > 0.0, tolerance > 1e-3);
    }
}

#[test]
fn recording_does_not_allocate_once_memory_is_reserved() {
    let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(0.3));
    // From modes, the state itself has to make the degrees of freedom of a frame.
    let builder = builder.coordinates(Coordinates::Physical);
    let mut simulation = builder.expected_steps(WARM + STEPS).build().unwrap();
    let recorder = Recorder::new().contact(2).motion(3);
    let mut time_series = recorder.start(&simulation).unwrap();
    for _ in 0..WARM {
        time_series.record(simulation.step().unwrap()).unwrap();
    }
    time_series.reserve(STEPS).unwrap();
    let before = COUNT.get();
    for _ in 0..STEPS {
        time_series.record(simulation.step().unwrap()).unwrap();
    }
    assert_eq!(COUNT.get() - before, 0);
    assert_eq!(time_series.times().len(), WARM + STEPS + 1);
}
