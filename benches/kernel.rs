//! Kernel evaluations: closed forms, step coefficients early and late, the full plane.

use basemat::Soil;
use basemat::bem::{ContactElement, InfluenceKernel};
use basemat::fundamental::{FullPlane, FundamentalSolution, HalfPlane, LoadHistory};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

fn kernels(criterion: &mut Criterion) {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).expect("valid soil");
    let plane = HalfPlane::new(soil);
    criterion.bench_function("half-plane impulse", |b| b.iter(|| plane.impulse(black_box(1.3))));
    criterion.bench_function("half-plane step", |b| b.iter(|| plane.heaviside(black_box(1.3))));
    // c_P Δt = half an element, twenty elements: fronts are inside until lag 120.
    let kernel = InfluenceKernel::new(&soil, 0.25).expect("valid step");
    let element = |i: u32| ContactElement { left: f64::from(i), right: f64::from(i + 1) };
    let mut group = criterion.benchmark_group("step coefficients");
    let mut slices = [[0.0; 120]; 3];
    group.throughput(Throughput::Elements(120));
    for distance in [0, 1, 5, 19] {
        let pair = kernel.pair(element(distance), element(0)).expect("valid elements");
        let [zz, xx, zx] = &mut slices;
        group.bench_function(format!("early, {distance} elements apart"), |b| {
            b.iter(|| pair.fill(black_box(1), zz, xx, zx));
        });
    }
    let pair = kernel.pair(element(19), element(0)).expect("valid elements");
    for first in [300, 3000, 1_000_000] {
        let [zz, xx, zx] = &mut slices;
        group.bench_function(format!("late, lag {first}"), |b| {
            b.iter(|| pair.fill(black_box(first), zz, xx, zx));
        });
    }
    group.throughput(Throughput::Elements(1));
    group.bench_function("pair", |b| b.iter(|| kernel.pair(element(19), element(0))));
    group.finish();
    let full = FullPlane::new(soil);
    criterion.bench_function("full-plane displacement", |b| {
        b.iter(|| full.displacement(black_box([0.7, 0.4]), 2.0, LoadHistory::Step));
    });
    criterion.bench_function("full-plane traction", |b| {
        b.iter(|| full.traction(black_box([0.7, 0.4]), [0.0, 1.0], 2.0, LoadHistory::Step));
    });
}

criterion_group!(benches, kernels);
criterion_main!(benches);
