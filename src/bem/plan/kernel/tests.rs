//! Tests of the weights of cells against a table, static compliances, and other ways to compute them.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::Error;
use crate::bem::layered::test_profiles::{gmb, p1};
use crate::history::ConvolutionWeights;
use crate::soil::{GeneralizedMaxwell, Relaxation, Soil};
use crate::unobserved;

const TIME_STEP: f64 = 0.2;

fn cells(counts: [usize; 2]) -> Vec<[usize; 2]> {
    (0..counts[0] * counts[1]).map(|n| [n % counts[0], n / counts[0]]).collect()
}

fn kernel(profile: SoilProfile, lattice: &Lattice, stages: Stages) -> LatticeKernel {
    let counts = lattice.counts;
    let mask = vec![true; counts[0] * counts[1]];
    let plan = Plan::masked([0.0; 2], lattice.pitch, counts[0], &mask).unwrap();
    LatticeKernel::in_plan(profile, &plan, stages, TIME_STEP, 1e-10, None).unwrap()
}

fn half_space() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap())
}

fn square() -> Lattice {
    Lattice { pitch: [0.5; 2], counts: [4, 4] }
}

/// Weights of each class and series, for all lags up to `lag_count`.
fn weights(kernel: &LatticeKernel, lag_count: usize) -> Vec<[Vec<f64>; COMPLIANCES_PER_OFFSET]> {
    let classes = 0..kernel.classes.count();
    classes
        .map(|class| {
            let mut values = [(); COMPLIANCES_PER_OFFSET].map(|()| vec![0.0; lag_count]);
            let mut slices = values.each_mut().map(Vec::as_mut_slice);
            kernel.coefficients(class, 1, &mut slices).unwrap();
            values
        })
        .collect()
}

/// `weights_4x4.csv` is from another program. Sums of weights equal the static compliance; Herm[(1−z) Ĝ] is positive.
#[test]
fn weights_match_the_table_and_sum_up_to_statics() {
    let table = include_str!("../../../../tests/data/plan/weights_4x4.csv");
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for profile_rows in rows.chunk_by(|a, b| a[0] == b[0]) {
        let is_layered = profile_rows[0][0] == "layer_rock";
        let profile = if is_layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let kernel = kernel(profile.clone(), &square(), Stages::Two);
        kernel.prepare(256, &mut unobserved).unwrap();
        let quadrature = &kernel.quadrature;
        let mut work = CellWorkspace::default();
        let mut values = vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; kernel.classes.count()];
        let mut scratch = values.clone();
        for point in 0..20 {
            let angle = std::f64::consts::PI * (f64::from(point) + 0.5) / 20.0;
            quadrature.mobility([-1e-3, angle], &mut work, &mut scratch, &mut values).unwrap();
            let margin = crate::bem::layered::margin(&kernel.classes, &values);
            assert!(margin > 0.0, "{angle} {margin:e}");
        }
        let computed = weights(&kernel, 256);
        let max_weight = computed[0][1][0];
        let mut max_error = 0.0_f64;
        for row in profile_rows {
            let lag: usize = row[1].parse().unwrap();
            let offset = [row[3].parse().unwrap(), row[4].parse().unwrap()];
            let mut components = row[2].chars().map(|letter| "zxy".find(letter).unwrap());
            let receiver = components.next().unwrap();
            let source = components.next().unwrap();
            let weights: Vec<[f64; COMPLIANCES_PER_OFFSET]> =
                computed.iter().map(|series| series.each_ref().map(|lags| lags[lag - 1])).collect();
            let computed_weight = square().block(&weights, offset)[receiver][source];
            max_error = max_error
                .max((computed_weight - row[5].parse::<f64>().unwrap()).abs() / max_weight);
        }
        let mut static_values = values.clone();
        let s = Complex::default();
        quadrature.integrals.compliance(&profile, s, &mut work, &mut static_values).unwrap();
        let even_error = largest_sum_error(&computed, &static_values, 256, 0..4);
        let odd_error = largest_sum_error(&computed, &static_values, 256, 4..6);
        let earlier_odd_error = largest_sum_error(&computed, &static_values, 128, 4..6);
        println!(
            "{}: lags {max_error:.1e}, sum {even_error:.1e}, {odd_error:.1e} (128: {earlier_odd_error:.1e})",
            profile_rows[0][0]
        );
        assert!(max_error < 1e-6, "{max_error:e}");
        let tolerances = if is_layered { [5e-5, 5e-5] } else { [1e-7, 2e-5] };
        assert!(
            even_error < tolerances[0] && odd_error < tolerances[1],
            "{even_error:e} {odd_error:e}"
        );
        // The coupling of shear and pressure decays like n⁻³.
        assert!(
            is_layered || (2.0..8.0).contains(&(earlier_odd_error / odd_error)),
            "{earlier_odd_error:e} {odd_error:e}"
        );
    }
}

/// Largest difference between sums of the first weights and static compliances, relative to the largest compliance.
fn largest_sum_error(
    weights: &[[Vec<f64>; COMPLIANCES_PER_OFFSET]],
    static_values: &[[Complex; COMPLIANCES_PER_OFFSET]],
    lag_count: usize,
    series_range: std::ops::Range<usize>,
) -> f64 {
    let mut max_error = 0.0_f64;
    for (class_weights, class_values) in weights.iter().zip(static_values) {
        for series in series_range.clone() {
            let sum = class_weights[series][..lag_count].iter().sum::<f64>();
            max_error = max_error.max((sum - class_values[series].re).abs());
        }
    }
    max_error / static_values[0][1].re
}

/// Weights are equal on a larger lattice and with another order of blocks, for oblong cells, with two and three stages.
#[test]
fn weights_depend_on_the_offset_alone() {
    for stages in [Stages::Two, Stages::Three] {
        let small_kernel =
            kernel(p1(gmb(5), gmb(1)), &Lattice { pitch: [0.5, 0.4], counts: [2, 3] }, stages);
        let large_kernel =
            kernel(p1(gmb(5), gmb(1)), &Lattice { pitch: [0.5, 0.4], counts: [4, 3] }, stages);
        large_kernel.prepare(200, &mut unobserved).unwrap();
        let small_weights = weights(&small_kernel, 100);
        let large_weights = weights(&large_kernel, 200);
        let max_weight = small_weights[0][1][0];
        let mut max_error = 0.0_f64;
        let large_offsets = large_kernel.classes.plan().unwrap().0.classes();
        for (class, offset) in
            small_kernel.classes.plan().unwrap().0.classes().into_iter().enumerate()
        {
            let large_class =
                large_offsets.iter().position(|large_offset| *large_offset == offset).unwrap();
            for (small_weight, large_weight) in small_weights[class]
                .iter()
                .flatten()
                .zip(large_weights[large_class].iter().flat_map(|lags| &lags[..100]))
            {
                max_error = max_error.max((small_weight - large_weight).abs() / max_weight);
            }
        }
        println!("{stages:?} {max_error:e}");
        assert!(0.0 < max_error && max_error < 1e-8, "{max_error:e}");
    }
}

/// For steps much shorter than the travel time across a cell, sums over directions yield the same weights as corner waves.
#[test]
fn weights_of_short_steps_are_sums_over_directions() {
    for (profile, step) in [(half_space(), 0.02), (p1(gmb(5), gmb(1)), 0.03)] {
        let plan = Plan::masked([0.0; 2], [0.5, 0.4], 3, &[true; 6]).unwrap();
        let wave_kernel =
            LatticeKernel::in_plan(profile.clone(), &plan, Stages::Two, step, 1e-10, None).unwrap();
        let mut sum_kernel =
            LatticeKernel::in_plan(profile, &plan, Stages::Two, step, 1e-10, None).unwrap();
        sum_kernel.quadrature.integrals.table.direct_panel_count = usize::MAX;
        let wave_weights = weights(&wave_kernel, 128);
        let sum_weights = weights(&sum_kernel, 128);
        let max_weight = wave_weights[0][1][0];
        let pairs =
            wave_weights.iter().flatten().flatten().zip(sum_weights.iter().flatten().flatten());
        let max_error =
            pairs.fold(0.0_f64, |max_error, (wave, sum)| max_error.max((wave - sum).abs()));
        println!("{step} {:e}", max_error / max_weight);
        assert!(
            0.0 < max_error && max_error < 1e-12 * max_weight,
            "{step} {:e}",
            max_error / max_weight
        );
    }
}

/// Damping law that counts its evaluations.
#[derive(Debug)]
struct CountedLaw {
    law: GeneralizedMaxwell,
    evaluation_count: Arc<AtomicUsize>,
}

impl Relaxation for CountedLaw {
    fn modulus(&self, s: Complex) -> Complex {
        self.evaluation_count.fetch_add(1, Ordering::Relaxed);
        self.law.modulus(s)
    }
}

/// Errors of integrals with the weights' tolerance would halve panels of the contour, with many more Laplace variables.
#[test]
fn errors_of_integrals_halve_no_panels() {
    let soil = Soil::new(60.0e6, 1.0 / 3.0, 1900.0).unwrap();
    let rock = Soil::new(600.0e6, 0.3, 2200.0).unwrap();
    let law = GeneralizedMaxwell::constant_q(0.05, [0.1, 50.0], 1.0).unwrap();
    let plan = Plan::rectangle(0.0..10.0, 0.0..10.0, 8).unwrap();
    let time_step = 0.24 * plan.pitch()[0] / soil.pressure_wave_speed();
    let weight_tolerance = 1e-10;
    let evaluations = [None, Some(weight_tolerance)].map(|integral_tolerance| {
        let evaluation_count = Arc::default();
        let layer = SoilProfile::on_half_plane(rock).with_layer(soil, 6.0).unwrap();
        let profile = layer.with_damping(CountedLaw {
            law: law.clone(),
            evaluation_count: Arc::clone(&evaluation_count),
        });
        let mut kernel =
            LatticeKernel::in_plan(profile, &plan, Stages::Two, time_step, weight_tolerance, None)
                .unwrap();
        if let Some(tolerance) = integral_tolerance {
            kernel.quadrature.integrals.tolerance = tolerance;
        }
        kernel.prepare(4096, &mut unobserved).unwrap();
        evaluation_count.load(Ordering::Relaxed)
    });
    println!("{evaluations:?}");
    assert!(5 * evaluations[0] < 4 * evaluations[1], "{evaluations:?}");
}

/// The passivity check of many cells uses a sample, each cell once.
#[test]
fn passivity_is_checked_on_some_of_many_cells() {
    let all_cells = cells([30, 20]);
    let mut sample = random_sample(&all_cells);
    assert_eq!(sample.len(), SAMPLED_CELL_COUNT);
    assert!(sample.iter().all(|cell| all_cells.contains(cell)));
    sample.sort_unstable();
    sample.dedup();
    assert_eq!(sample.len(), SAMPLED_CELL_COUNT);
}

#[test]
fn invalid_requests_return_errors() {
    let kernel = kernel(half_space(), &square(), Stages::Two);
    assert!(matches!(
        kernel.coefficients(0, 1, &mut [&mut [], &mut [], &mut []]),
        Err(Error::Size { found: 3, needed: 6, .. })
    ));
    let mut empty_series = [(); COMPLIANCES_PER_OFFSET].map(|()| vec![]);
    let outcome = kernel.coefficients(99, 1, &mut empty_series.each_mut().map(Vec::as_mut_slice));
    assert!(matches!(outcome, Err(Error::Index { index: 99, bound: 10, .. })));
    assert!(matches!(kernel.prepare(1 << 30, &mut unobserved), Err(Error::Memory(_))));
}

/// Tables of forms, the passivity check and blocks have the same bits on any number of threads.
#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_bit() {
    let single_thread_bits = bits_on_threads(1);
    assert!(bits_on_threads(2) == single_thread_bits);
    assert!(bits_on_threads(5) == single_thread_bits);
}

/// Bits of the weights and of the passivity check.
#[cfg(feature = "rayon")]
fn bits_on_threads(thread_count: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
    pool.install(|| {
        let kernel = kernel(half_space(), &square(), Stages::Two);
        let fingerprint =
            kernel.check_passivity(&mut crate::error::ProgressReporter::unobserved()).unwrap();
        let weights = weights(&kernel, 200).into_iter().flatten().flatten();
        weights.map(f64::to_bits).chain([fingerprint]).collect()
    })
}
