//! Kernel evaluations: closed forms, convolution weights early and late, layered ground, the full plane.

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, InfluenceKernel, PatchKernel, Strip};
use basemat::fundamental::{FullPlane, FundamentalSolution, HalfPlane, LoadHistory};
use basemat::history::{ConvolutionHistory, ConvolutionWeights, RelaxedFftHistory};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Soil, unobserved};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;

fn kernels(criterion: &mut Criterion) {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).expect("valid soil");
    let plane = HalfPlane::new(soil);
    criterion.bench_function("half-plane impulse", |b| b.iter(|| plane.impulse(black_box(1.3))));
    criterion.bench_function("half-plane step", |b| b.iter(|| plane.heaviside(black_box(1.3))));
    // c_P Δt = half an element, twenty elements: the slowest front, that of the Rayleigh wave, leaves at lag 86.
    let kernel = InfluenceKernel::new(soil, 0.25).expect("valid step");
    let strip = Strip::uniform(0.0..20.0, 20).expect("a valid strip").elements();
    let patch = PatchKernel::new(soil, strip.clone(), 0.25).expect("a valid patch");
    let mut group = criterion.benchmark_group("convolution weights");
    let mut zz = [0.0; 120];
    let mut xx = [0.0; 120];
    let mut zx = [0.0; 120];
    group.throughput(Throughput::Elements(120));
    for distance in [0, 1, 5, 19] {
        let class = patch.classes().pairs()[distance].class;
        group.bench_function(format!("early, {distance} elements apart"), |b| {
            b.iter(|| patch.coefficients(class, black_box(1), &mut [&mut zz, &mut xx, &mut zx]));
        });
    }
    let farthest_class = patch.classes().pairs()[19].class;
    for first_lag in [300, 3000, 1_000_000] {
        group.bench_function(format!("late, lag {first_lag}"), |b| {
            b.iter(|| {
                patch.coefficients(
                    farthest_class,
                    black_box(first_lag),
                    &mut [&mut zz, &mut xx, &mut zx],
                )
            });
        });
    }
    group.throughput(Throughput::Elements(1));
    group.bench_function("weights of a pair of elements, one lag", |b| {
        b.iter(|| kernel.coefficients(strip[19], strip[0], black_box(300)));
    });
    group.finish();
    let full_plane = FullPlane::new(soil);
    criterion.bench_function("full-plane displacement", |b| {
        b.iter(|| full_plane.displacement(black_box([0.7, 0.4]), 2.0, LoadHistory::Step));
    });
    criterion.bench_function("full-plane traction", |b| {
        b.iter(|| full_plane.traction(black_box([0.7, 0.4]), [0.0, 1.0], 2.0, LoadHistory::Step));
    });
}

/// All convolution weights that a history of 1000 steps uses of a uniform patch.
fn patches(criterion: &mut Criterion) {
    const LAG_COUNT: usize = 1_000;
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).expect("valid soil");
    let mut group = criterion.benchmark_group("weights of a patch, 1000 lags");
    group.sample_size(20);
    let mut slices = [(); 3].map(|()| vec![0.0; LAG_COUNT]);
    for count in [10_u32, 40, 200] {
        let elements = Strip::uniform(0.0..f64::from(count), count as usize)
            .expect("a valid strip")
            .elements();
        let kernel = PatchKernel::new(soil, elements, 0.25).expect("a valid patch");
        let [zz, xx, zx] = &mut slices;
        group.throughput(Throughput::Elements(u64::from(count) * LAG_COUNT as u64));
        group.bench_function(format!("{count} elements"), |b| {
            b.iter(|| {
                (0..kernel.classes().count()).try_for_each(|class| {
                    kernel.coefficients(class, black_box(1), &mut [zz, xx, zx])
                })
            });
        });
    }
    group.finish();
}

fn soil(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).expect("valid soil")
}

fn damping(ratio: f64) -> GeneralizedMaxwell {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0).expect("a fit")
}

/// Setup of a layered ground: two damped layers on rock, 12 graded elements.
fn layered(criterion: &mut Criterion) {
    const STEP_COUNT: usize = 500;
    let profile = SoilProfile::on_half_plane(soil(500.0))
        .with_bedrock_damping(damping(0.01))
        .with_layer(soil(150.0), 6.0)
        .and_then(|profile| profile.with_damping(damping(0.05)).with_layer(soil(300.0), 8.0))
        .expect("a valid profile")
        .with_damping(damping(0.03));
    let strip = Strip::graded(-3.0..3.0, 12).expect("a valid strip");
    let ground = ElasticGround::new(profile, strip).expect("a ground").with_stages(Stages::Two);
    let mut group = criterion.benchmark_group("setup of layered ground, 500 steps");
    group.throughput(Throughput::Elements(STEP_COUNT as u64)).sample_size(10);
    group.bench_function("two layers, 12 elements", |b| {
        b.iter_batched(
            || ground.weights(0.005).expect("weights"),
            |kernel| kernel.prepare(black_box(STEP_COUNT), &mut unobserved),
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

/// Steps of the relaxed history: by pairs, and by wavenumbers.
fn relaxed_history(criterion: &mut Criterion) {
    const STEP_COUNT: usize = 2_048;
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).expect("valid soil");
    let mut group = criterion.benchmark_group("relaxed history, 2048 steps");
    group.throughput(Throughput::Elements(STEP_COUNT as u64)).sample_size(10);
    for (count, waves) in [(10_u32, false), (10, true), (40, false), (40, true), (200, true)] {
        let elements = Strip::uniform(0.0..f64::from(count), count as usize)
            .expect("a valid strip")
            .elements();
        let kernel: Arc<dyn ConvolutionWeights> =
            Arc::new(PatchKernel::new(soil, elements, 0.25).expect("a valid patch"));
        let mut displacement = vec![0.0; 2 * count as usize];
        let traction: Vec<f64> = (0..2 * count).map(|i| f64::from(i).sin()).collect();
        let kind = if waves { "wavenumbers" } else { "pairs" };
        group.bench_function(format!("{count} elements by {kind}"), |b| {
            b.iter_batched(
                || {
                    let mut history =
                        RelaxedFftHistory::new(Arc::clone(&kernel)).with_surface_transform(waves);
                    history.prepare(STEP_COUNT, &mut unobserved).expect("kernels");
                    history
                },
                |mut history| {
                    for _ in 0..STEP_COUNT {
                        history.evaluate(&mut displacement).expect("a valid history");
                        history.push(black_box(&traction));
                    }
                    displacement[0]
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, kernels, patches, layered, relaxed_history);
criterion_main!(benches);
