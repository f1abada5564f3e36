//! Time per step of whole scenes, and of the histories alone.

use std::hint::black_box;
use std::sync::Arc;

use basemat::bem::{ContactElement, PatchKernel, Strip};
use basemat::history::{ConvolutionHistory, ConvolutionWeights, DirectHistory, RelaxedFftHistory};
use basemat::{Soil, unobserved};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

fn soil() -> Soil {
    Soil::new(80.0e6, 1.0 / 3.0, 1900.0).expect("a valid soil")
}

/// Time of a step in each kind of scene.
fn kinds(criterion: &mut Criterion) {
    let steps = 2_000;
    let mut group = criterion.benchmark_group("2000 steps of the headline run");
    group.throughput(Throughput::Elements(2_000)).sample_size(10);
    for row in &basemat_problems::headline::TIMED_SCENES {
        group.bench_function(row.name, |bencher| {
            bencher.iter_batched(
                // With fewer expected steps, the simulation would use degrees of freedom instead of modes.
                || row.build(10_000).expect("a valid scene"),
                |mut simulation| {
                    black_box(row.march(&mut simulation, steps).expect("every step is solved"))
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

fn direct_history(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("direct history, one evaluation");
    for past_steps in [1_000, 10_000] {
        let elements: Vec<ContactElement> =
            Strip::uniform(-5.0..5.0, 10).expect("a valid strip").elements();
        let kernel = PatchKernel::new(soil(), elements, 2.0e-3).expect("a valid patch");
        let mut history = DirectHistory::new(Arc::new(kernel));
        history.prepare(past_steps + 1, &mut unobserved).expect("kernels");
        for step in 0..past_steps {
            let traction: Vec<f64> = (0..20).map(|i| ((step * 7 + i) as f64).sin()).collect();
            history.push(&traction);
        }
        let mut displacement = vec![0.0; 20];
        // Pressure on settlement and shear on sway, for each pair of elements.
        group.throughput(Throughput::Elements(2 * 100 * past_steps as u64));
        group.bench_function(BenchmarkId::new("10 elements", past_steps), |bencher| {
            bencher.iter(|| history.evaluate(black_box(&mut displacement)));
        });
    }
    group.finish();
}

/// Times of all steps of a history, without its preparation.
fn whole_march(criterion: &mut Criterion) {
    const STEP_COUNT: usize = 10_000;
    let elements = Strip::uniform(-5.0..5.0, 10).expect("a valid strip").elements();
    let kernel: Arc<dyn ConvolutionWeights> =
        Arc::new(PatchKernel::new(soil(), elements, 2.0e-3).expect("a valid patch"));
    let mut group = criterion.benchmark_group("history, 10 000 steps, 10 elements");
    group.throughput(Throughput::Elements(STEP_COUNT as u64)).sample_size(10);
    for (name, relaxed) in [("direct", false), ("relaxed FFT", true)] {
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || {
                    let kernel = Arc::clone(&kernel);
                    let mut history: Box<dyn ConvolutionHistory> = if relaxed {
                        Box::new(RelaxedFftHistory::new(kernel))
                    } else {
                        Box::new(DirectHistory::new(kernel))
                    };
                    history.prepare(STEP_COUNT, &mut unobserved).expect("kernels");
                    history
                },
                |mut history| {
                    let mut displacement = [0.0; 20];
                    let mut traction = [0.0; 20];
                    for step in 0..STEP_COUNT {
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

criterion_group!(benches, kinds, direct_history, whole_march);
criterion_main!(benches);
