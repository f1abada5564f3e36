//! Weights of cells against a table, statics, and themselves.

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

/// Weights of each class and series, all lags up to `lags`.
fn weights(kernel: &LatticeKernel, lags: usize) -> Vec<[Vec<f64>; SERIES_PER_OFFSET]> {
    let all = 0..kernel.classes.count();
    all.map(|class| {
        let mut values = [(); SERIES_PER_OFFSET].map(|()| vec![0.0; lags]);
        let mut slices = values.each_mut().map(Vec::as_mut_slice);
        kernel.coefficients(class, 1, &mut slices).unwrap();
        values
    })
    .collect()
}

/// `weights_4x4.csv` is from another program. Sums equal the static compliance; (1−z) Ĝ is positive on circles.
#[test]
fn weights_match_the_table_and_sum_up_to_statics() {
    let table = include_str!("../../../../tests/data/plan/weights_4x4.csv");
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|l| l.split(',').collect()).collect();
    for rows in rows.chunk_by(|a, b| a[0] == b[0]) {
        let layered = rows[0][0] == "layer_rock";
        let profile = if layered { p1(gmb(5), gmb(1)) } else { half_space() };
        let kernel = kernel(profile.clone(), &square(), Stages::Two);
        kernel.prepare(256, &mut unobserved).unwrap();
        let quadrature = &kernel.quadrature;
        let mut work = CellWorkspace::default();
        let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; kernel.classes.count()];
        let mut scratch = values.clone();
        for point in 0..20 {
            let angle = std::f64::consts::PI * (f64::from(point) + 0.5) / 20.0;
            quadrature.mobility([-1e-3, angle], &mut work, &mut scratch, &mut values).unwrap();
            let margin = crate::bem::layered::margin(&kernel.classes, &values);
            assert!(margin > 0.0, "{angle} {margin:e}");
        }
        let found = weights(&kernel, 256);
        let largest = found[0][1][0];
        let mut worst = 0.0_f64;
        for row in rows {
            let lag: usize = row[1].parse().unwrap();
            let offset = [row[3].parse().unwrap(), row[4].parse().unwrap()];
            let mut components = row[2].chars().map(|letter| "zxy".find(letter).unwrap());
            let receiver = components.next().unwrap();
            let source = components.next().unwrap();
            let weights: Vec<[f64; SERIES_PER_OFFSET]> =
                found.iter().map(|kinds| kinds.each_ref().map(|lags| lags[lag - 1])).collect();
            let value = square().block(&weights, offset)[receiver][source];
            worst = worst.max((value - row[5].parse::<f64>().unwrap()).abs() / largest);
        }
        let mut at_rest = values.clone();
        let s = Complex::default();
        quadrature.integrals.compliance(&profile, s, &mut work, &mut at_rest).unwrap();
        let even = largest_sum_error(&found, &at_rest, 256, 0..4);
        let odd = largest_sum_error(&found, &at_rest, 256, 4..6);
        let before = largest_sum_error(&found, &at_rest, 128, 4..6);
        println!("{}: lags {worst:.1e}, sum {even:.1e}, {odd:.1e} (128: {before:.1e})", rows[0][0]);
        assert!(worst < 1e-6, "{worst:e}");
        let gates = if layered { [5e-5, 5e-5] } else { [1e-7, 2e-5] };
        assert!(even < gates[0] && odd < gates[1], "{even:e} {odd:e}");
        // The coupling of shear and pressure decays like n⁻³.
        assert!(layered || (2.0..8.0).contains(&(before / odd)), "{before:e} {odd:e}");
    }
}

/// Largest difference between sums of the first lags and static compliances, relative to the largest compliance.
fn largest_sum_error(
    weights: &[[Vec<f64>; SERIES_PER_OFFSET]],
    at_rest: &[[Complex; SERIES_PER_OFFSET]],
    lags: usize,
    kinds: std::ops::Range<usize>,
) -> f64 {
    let mut largest = 0.0_f64;
    for (weights, at_rest) in weights.iter().zip(at_rest) {
        for kind in kinds.clone() {
            let sum = weights[kind][..lags].iter().sum::<f64>();
            largest = largest.max((sum - at_rest[kind].re).abs());
        }
    }
    largest / at_rest[0][1].re
}

/// Cells of a larger lattice, in another order of blocks, oblong, and with three stages.
#[test]
fn weights_depend_on_the_offset_alone() {
    for stages in [Stages::Two, Stages::Three] {
        let small =
            kernel(p1(gmb(5), gmb(1)), &Lattice { pitch: [0.5, 0.4], counts: [2, 3] }, stages);
        let large =
            kernel(p1(gmb(5), gmb(1)), &Lattice { pitch: [0.5, 0.4], counts: [4, 3] }, stages);
        large.prepare(200, &mut unobserved).unwrap();
        let one = weights(&small, 100);
        let two = weights(&large, 200);
        let largest = one[0][1][0];
        let mut worst = 0.0_f64;
        let large_offsets = large.classes.plan().unwrap().0.classes();
        for (class, offset) in small.classes.plan().unwrap().0.classes().into_iter().enumerate() {
            let other = large_offsets.iter().position(|it| *it == offset).unwrap();
            for (one, two) in
                one[class].iter().flatten().zip(two[other].iter().flat_map(|lags| &lags[..100]))
            {
                worst = worst.max((one - two).abs() / largest);
            }
        }
        println!("{stages:?} {worst:e}");
        assert!(0.0 < worst && worst < 1e-8, "{worst:e}");
    }
}

/// Forms at large wavenumbers are waves from corners: sums over directions give the same weights, at steps much shorter
/// than the way across a cell.
#[test]
fn weights_of_short_steps_are_sums_over_directions() {
    for (profile, step) in [(half_space(), 0.02), (p1(gmb(5), gmb(1)), 0.03)] {
        let plan = Plan::masked([0.0; 2], [0.5, 0.4], 3, &[true; 6]).unwrap();
        let by_waves =
            LatticeKernel::in_plan(profile.clone(), &plan, Stages::Two, step, 1e-10, None).unwrap();
        let mut by_sums =
            LatticeKernel::in_plan(profile, &plan, Stages::Two, step, 1e-10, None).unwrap();
        by_sums.quadrature.integrals.table.direct_panels = usize::MAX;
        let one = weights(&by_waves, 128);
        let two = weights(&by_sums, 128);
        let largest = one[0][1][0];
        let pairs = one.iter().flatten().flatten().zip(two.iter().flatten().flatten());
        let worst = pairs.fold(0.0_f64, |worst, (one, two)| worst.max((one - two).abs()));
        println!("{step} {:e}", worst / largest);
        assert!(0.0 < worst && worst < 1e-12 * largest, "{step} {:e}", worst / largest);
    }
}

/// A damping law that counts the Laplace variables of its soil.
#[derive(Debug)]
struct Counted(GeneralizedMaxwell, Arc<AtomicUsize>);

impl Relaxation for Counted {
    fn modulus(&self, s: Complex) -> Complex {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.modulus(s)
    }
}

/// Integrals as coarse as the weights would halve panels of the contour by their errors: many more variables.
#[test]
fn errors_of_integrals_halve_no_panels() {
    let soil = Soil::new(60.0e6, 1.0 / 3.0, 1900.0).unwrap();
    let rock = Soil::new(600.0e6, 0.3, 2200.0).unwrap();
    let law = GeneralizedMaxwell::constant_q(0.05, [0.1, 50.0], 1.0).unwrap();
    let plan = Plan::rectangle(0.0..10.0, 0.0..10.0, 8).unwrap();
    let time_step = 0.24 * plan.pitch()[0] / soil.pressure_wave_speed();
    let weight_tolerance = 1e-10;
    let variables = [None, Some(weight_tolerance)].map(|tolerance| {
        let count = Arc::default();
        let layer = SoilProfile::on_half_plane(rock).with_layer(soil, 6.0).unwrap();
        let profile = layer.with_damping(Counted(law.clone(), Arc::clone(&count)));
        let mut kernel =
            LatticeKernel::in_plan(profile, &plan, Stages::Two, time_step, weight_tolerance, None)
                .unwrap();
        if let Some(tolerance) = tolerance {
            kernel.quadrature.integrals.tolerance = tolerance;
        }
        kernel.prepare(4096, &mut unobserved).unwrap();
        count.load(Ordering::Relaxed)
    });
    println!("{variables:?}");
    assert!(5 * variables[0] < 4 * variables[1], "{variables:?}");
}

/// The passivity check takes some of many cells, each once.
#[test]
fn passivity_is_checked_on_some_of_many_cells() {
    let all = cells([30, 20]);
    let mut some = random_sample(&all);
    assert_eq!(some.len(), SAMPLED_CELL_COUNT);
    assert!(some.iter().all(|cell| all.contains(cell)));
    some.sort_unstable();
    some.dedup();
    assert_eq!(some.len(), SAMPLED_CELL_COUNT);
}

#[test]
fn bad_requests_are_told() {
    let kernel = kernel(half_space(), &square(), Stages::Two);
    assert!(matches!(
        kernel.coefficients(0, 1, &mut [&mut [], &mut [], &mut []]),
        Err(Error::Size { found: 3, needed: 6, .. })
    ));
    let mut none = [(); SERIES_PER_OFFSET].map(|()| vec![]);
    let outcome = kernel.coefficients(99, 1, &mut none.each_mut().map(Vec::as_mut_slice));
    assert!(matches!(outcome, Err(Error::Index { index: 99, bound: 10, .. })));
    assert!(matches!(kernel.prepare(1 << 30, &mut unobserved), Err(Error::Memory(_))));
}

/// Tables of forms, the passivity check and blocks have the same bits on any number of threads.
#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_bit() {
    let alone = bits_on_threads(1);
    assert!(bits_on_threads(2) == alone && bits_on_threads(5) == alone);
}

/// Bits of the weights and of the passivity check.
#[cfg(feature = "rayon")]
fn bits_on_threads(threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let kernel = kernel(half_space(), &square(), Stages::Two);
        let fingerprint =
            kernel.check_passivity(&mut crate::error::ProgressReporter::unobserved()).unwrap();
        let weights = weights(&kernel, 200).into_iter().flatten().flatten();
        weights.map(f64::to_bits).chain([fingerprint]).collect()
    })
}
