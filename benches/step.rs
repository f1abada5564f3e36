//! Time per step of whole scenes, and of the histories alone.

use std::hint::black_box;
use std::sync::Arc;

use basemat::bem::{ContactElement, HalfPlaneGround, PatchKernel, Strip};
use basemat::coupled::{Coordinates, SimulationBuilder};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::{ConvolutionHistory, DirectHistory, RelaxedFftHistory};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::{STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Simulation, Soil};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Makes a scene, as often as it is called.
type Make<'a> = &'a dyn Fn() -> SimulationBuilder;

fn soil() -> Soil {
    Soil::new(80.0e6, 1.0 / 3.0, 1900.0).expect("a valid soil")
}

/// 500 steps of a rigid block under El Centro, from rest: the strong part of the record is not in
/// it, so that the mode search is the same at every run.
fn scene(bencher: &mut criterion::Bencher<'_>, law: &(impl InterfaceLaw + Clone + 'static)) {
    bencher.iter_batched(
        || {
            Simulation::builder(4.0e-3)
                .structure(RigidBlock::new(10.0, 20.0, 500.0).expect("a valid block"))
                .ground(HalfPlaneGround::strip(soil(), -5.0..5.0, 10).expect("a valid strip"))
                .interface(law.clone())
                .motion(el_centro_1940())
                .gravity(STANDARD_GRAVITY)
                .expected_steps(500)
                .build()
                .expect("a valid scene")
        },
        |mut simulation| {
            let run = simulation.run(500, |_| ());
            black_box(run.expect("every step is solved").base_shear)
        },
        criterion::BatchSize::LargeInput,
    );
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("500 steps, rigid block");
    group.throughput(Throughput::Elements(500)).sample_size(20);
    group.bench_function("bonded", |b| scene(b, &Bonded));
    group.bench_function("uplift only", |b| scene(b, &Coulomb::uplift_only()));
    group.bench_function("friction 0.2", |b| scene(b, &Coulomb::new(0.2).expect("a valid law")));
    group.finish();
}

/// The containment of the examples: 10 by 13 elements, 308 unknowns.
fn containment() -> FemModel {
    let solid = |density| Material::new(5.1e9, 1.0 / 3.0, density).expect("a valid material");
    let layers = [Layer::new(1.9, 1, solid(1568.0)), Layer::new(22.5, 12, solid(304.0))];
    let mesh = Mesh::layered_block(-5.2..5.2, 10, &layers).expect("a valid mesh");
    FemModel::on_base(mesh).expect("a valid model")
}

fn flexible(law: impl InterfaceLaw + 'static) -> SimulationBuilder {
    let motion = el_centro_1940();
    Simulation::builder(1.3e-3)
        .structure(containment())
        .ground(HalfPlaneGround::strip(soil(), -5.2..5.2, 10).expect("a valid strip"))
        .interface(law)
        .motion(motion)
        .gravity(STANDARD_GRAVITY)
        .coordinates(Coordinates::Modes)
        .expected_steps(1_000)
}

/// What each kind of scene pays for a step, and the same structure stepped in its unknowns.
fn kinds(criterion: &mut Criterion) {
    let friction = |f| Coulomb::new(f).expect("a valid law");
    let vertical =
        |law: SimulationBuilder| law.motion(VerticalIncidence::vertical(el_centro_1940()));
    let block = || RigidBlock::new(10.4, 24.4, 400.0).expect("a valid block");
    let scenes: [(&str, Make<'_>); 7] = [
        ("bonded", &|| flexible(Bonded)),
        ("bonded, symmetric load", &|| vertical(flexible(Bonded))),
        ("frictionless, vertical", &|| vertical(flexible(friction(0.0)))),
        ("uplift only", &|| flexible(Coulomb::uplift_only())),
        ("uplift and sliding", &|| flexible(friction(0.3))),
        ("rigid block", &|| flexible(friction(0.3)).structure(block())),
        ("in unknowns", &|| flexible(friction(0.3)).coordinates(Coordinates::Unknowns)),
    ];
    let mut group = criterion.benchmark_group("1000 steps, containment");
    group.throughput(Throughput::Elements(1_000)).sample_size(10);
    for (name, make) in scenes {
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || make().build().expect("a valid scene"),
                |mut simulation| {
                    for _ in 0..1_000 {
                        simulation.step().expect("every step is solved");
                    }
                    black_box(simulation.state().base_shear)
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

fn direct_history(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("direct history, one evaluation");
    for past in [1_000, 10_000] {
        let elements: Vec<ContactElement> =
            Strip::uniform(-5.0..5.0, 10).expect("a valid strip").elements();
        let kernel = PatchKernel::new(soil(), elements, 2.0e-3).expect("a valid patch");
        let mut history = DirectHistory::new(Arc::new(kernel));
        history.reserve(past + 1).expect("kernels");
        for step in 0..past {
            let traction: Vec<f64> = (0..20).map(|i| ((step * 7 + i) as f64).sin()).collect();
            history.push(&traction);
        }
        let mut displacement = vec![0.0; 20];
        // Pressure on settlement and shear on sway, for each pair of elements.
        group.throughput(Throughput::Elements(2 * 100 * past as u64));
        group.bench_function(BenchmarkId::new("10 elements", past), |bencher| {
            bencher.iter(|| history.evaluate(black_box(&mut displacement)));
        });
    }
    group.finish();
}

/// Whole marches, kernels and memory made ready before.
fn whole_march(criterion: &mut Criterion) {
    const STEPS: usize = 10_000;
    let elements = Strip::uniform(-5.0..5.0, 10).expect("a valid strip").elements();
    let kernel = Arc::new(PatchKernel::new(soil(), elements, 2.0e-3).expect("a valid patch"));
    let make = |relaxed: bool| -> Box<dyn ConvolutionHistory> {
        let kernel = Arc::clone(&kernel);
        if relaxed {
            Box::new(RelaxedFftHistory::new(kernel))
        } else {
            Box::new(DirectHistory::new(kernel))
        }
    };
    let mut group = criterion.benchmark_group("history, 10 000 steps, 10 elements");
    group.throughput(Throughput::Elements(STEPS as u64)).sample_size(10);
    for (name, relaxed) in [("direct", false), ("relaxed FFT", true)] {
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || {
                    let mut history = make(relaxed);
                    history.reserve(STEPS).expect("kernels");
                    history
                },
                |mut history| {
                    let (mut displacement, mut traction) = ([0.0; 20], [0.0; 20]);
                    for step in 0..STEPS {
                        history.evaluate(&mut displacement).expect("a valid history");
                        for (i, value) in traction.iter_mut().enumerate() {
                            *value = ((step * 7 + i) % 101) as f64;
                        }
                        history.push(&traction);
                    }
                    black_box(displacement)
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, kinds, steps, direct_history, whole_march);
criterion_main!(benches);
