//! GOAL: convolution weights of layered ground are right, and their bits depend on nothing but the lag.
//! SCENE: a damped layer on rock; a half-plane; uniform and graded strips, two and three stages.
//! REFERENCE: a table of another program, the closed form of the half-plane, a finer tolerance.

use basemat::bem::layered::Stages;
use basemat::bem::{Grading, InfluenceKernel, Strip};
use basemat::history::ConvolutionWeights;
use basemat::soil::SoilProfile;
use basemat::{Soil, unobserved};

use basemat_problems::dense::largest;
use basemat_problems::profiles::{gmb, p1, two_stages};

/// Weights zz, xx and zx of a class at `count` lags from `first_lag`.
fn weights_of_class(
    kernel: &dyn ConvolutionWeights,
    class: usize,
    first_lag: usize,
    count: usize,
) -> [Vec<f64>; 3] {
    let mut weights = [(); 3].map(|()| vec![f64::NAN; count]);
    let mut lists = weights.each_mut().map(|list| &mut list[..]);
    kernel.coefficients(class, first_lag, &mut lists).unwrap();
    weights
}

/// GOAL: weights of a damped layer on rock, of two stages and at lags 1 to 64, agree with a table.
/// REFERENCE: `G_r2_P1_gmb_Q3_dt0.2.csv` by another program.
#[test]
fn coefficients_agree_with_the_table_of_a_damped_layer_on_rock() {
    let strip = Strip::uniform(-1.0..1.0, 3).unwrap();
    let kernel = two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.2).unwrap();
    let count = kernel.classes().count();
    let weights: Vec<[Vec<f64>; 3]> =
        (0..count).map(|class| weights_of_class(kernel.as_ref(), class, 1, 64)).collect();
    let table = include_str!("../data/layered/G_r2_P1_gmb_Q3_dt0.2.csv");
    let mut largest_error = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    let mut rows = 0;
    for line in table.lines().skip(2) {
        let fields: Vec<&str> = line.split(',').collect();
        let lag: usize = fields[0].parse().unwrap();
        let row: usize = fields[1].parse().unwrap();
        let column: usize = fields[2].parse().unwrap();
        let pair = kernel.classes().pairs()[row % 3 * 3 + column % 3];
        let pair_weights = &weights[pair.class];
        let computed = match (row / 3, column / 3) {
            (0, 0) => pair_weights[0][lag - 1],
            (1, 1) => pair_weights[1][lag - 1],
            (0, 1) => pair.sign * pair_weights[2][lag - 1],
            _ => -pair.sign * pair_weights[2][lag - 1],
        };
        let expected: f64 = fields[3].parse().unwrap();
        max_magnitude = max_magnitude.max(expected.abs());
        largest_error = largest_error.max((computed - expected).abs());
        rows += 1;
    }
    println!("{rows} rows, {:e} of the largest", largest_error / max_magnitude);
    assert!(rows > 600);
    assert!(largest_error < 1e-7 * max_magnitude);
}

/// GOAL: weights of a half-plane as layered ground tend to its closed form at late lags.
///
/// The closed form is exact in time; the layered weights have the error of Radau IIA.
#[test]
fn homogeneous_ground_tends_to_the_closed_form() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let time_step = 0.1 / soil.shear_wave_speed();
    let closed_form = InfluenceKernel::new(soil, time_step).unwrap();
    for stages in [Stages::Two, Stages::Three] {
        let profile = SoilProfile::on_half_plane(soil);
        let kernel = two_stages(profile, &strip).with_stages(stages).weights(time_step).unwrap();
        let mut errors = [0.0_f64; 3];
        for class in 0..kernel.classes().count() {
            let [source, receiver] = kernel.classes().representative(class).unwrap();
            for (lag, error) in [30, 100, 400].into_iter().zip(&mut errors) {
                let [zz, xx, zx] =
                    weights_of_class(kernel.as_ref(), class, lag, 1).map(|list| list[0]);
                let expected = closed_form.coefficients(receiver, source, lag).unwrap();
                let length = receiver.length();
                for (computed, expected) in [(zz, expected.zz), (xx, expected.xx)] {
                    *error = error.max((computed / (expected * length) - 1.0).abs());
                }
                // The coupling ends with the Rayleigh wave: its error is relative to zz.
                if lag > 30 {
                    *error = error.max((zx / length - expected.zx).abs() / expected.zz);
                }
            }
        }
        println!("{stages:?}: lags 30, 100, 400: {errors:?}");
        assert!(errors[0] < 1e-3, "{stages:?} {errors:?}");
        assert!(errors[1] < 1e-6, "{stages:?} {errors:?}");
        assert!(errors[2] < 1e-6, "{stages:?} {errors:?}");
    }
}

/// GOAL: the bits of a lag's weights do not depend on the order or the number of lags requested.
#[test]
fn bits_of_a_lag_depend_on_nothing_else() {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let by_pieces = two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.3).unwrap();
    let at_once = two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.3).unwrap();
    at_once.prepare(1000, &mut unobserved).unwrap();
    let all_lags = weights_of_class(at_once.as_ref(), 1, 1, 600);
    for (first_lag, count) in [(500, 101), (1, 3), (120, 20), (256, 1), (257, 100)] {
        let piece = weights_of_class(by_pieces.as_ref(), 1, first_lag, count);
        for (piece, all_lags) in piece.iter().zip(&all_lags) {
            for (a, b) in piece.iter().zip(&all_lags[first_lag - 1..]) {
                assert_eq!(a.to_bits(), b.to_bits());
            }
        }
    }
}

/// Lags of the weights at several tolerances.
const COMPARED_LAGS: usize = 1024;

/// Weights of the first element on itself.
fn weights_with_tolerance(tolerance: f64) -> [Vec<f64>; 3] {
    let strip = Strip::new(-1.0..1.0, 4, Grading::Cosine).unwrap();
    let ground = two_stages(p1(gmb(5), gmb(1)), &strip).with_tolerance(tolerance).unwrap();
    let kernel = ground.weights(0.1).unwrap();
    weights_of_class(kernel.as_ref(), 0, 1, COMPARED_LAGS)
}

/// GOAL: errors are of the order of the tolerance's power 2/3 of a lag's weight, also at the ends of blocks.
/// REFERENCE: the weights of a much smaller tolerance.
#[test]
fn tolerance_governs_the_latest_lags() {
    let reference = weights_with_tolerance(1e-13);
    for tolerance in [1e-8, 1e-10] {
        let computed = weights_with_tolerance(tolerance);
        let mut error_of_lag = 0.0_f64;
        let mut error_of_first = 0.0_f64;
        for (computed, reference) in computed.iter().zip(&reference).take(2) {
            for (lag, (a, b)) in computed.iter().zip(reference).enumerate() {
                // Where the weight passes through zero its neighbours give the scale.
                let neighbours = &reference[lag.saturating_sub(8)..(lag + 8).min(COMPARED_LAGS)];
                error_of_lag = error_of_lag.max((a - b).abs() / largest(neighbours));
                error_of_first = error_of_first.max((a - b).abs() / reference[0]);
            }
        }
        println!("{tolerance:e}: {error_of_lag:e} of the lag, {error_of_first:e} of the first");
        let limit = tolerance.powf(2.0 / 3.0);
        assert!(error_of_lag < 10.0 * limit, "{tolerance:e} {error_of_lag:e}");
        assert!(error_of_first < limit, "{tolerance:e} {error_of_first:e}");
    }
}
