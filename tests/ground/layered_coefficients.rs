//! GOAL: convolution weights of layered ground are right, and their bits depend on nothing but the lag.
//! SCENE: a damped layer on rock; a half-plane; uniform and graded strips, two and three stages.
//! REFERENCE: a table of another program, the closed form of the half-plane, a finer tolerance.

use basemat::bem::layered::Stages;
use basemat::bem::{Grading, InfluenceKernel, Strip};
use basemat::soil::SoilProfile;
use basemat::{Soil, unobserved};

use basemat_problems::profiles::{gmb, p1, two_stages};

/// `G_r2_P1_gmb_Q3_dt0.2.csv`: another program, two stages, lags 1 … 64.
#[test]
fn agrees_with_the_table_of_a_damped_layer_on_rock() {
    let strip = Strip::uniform(-1.0..1.0, 3).unwrap();
    let kernel = two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.2).unwrap();
    let count = kernel.classes().count();
    let values: Vec<[Vec<f64>; 3]> = (0..count)
        .map(|class| {
            let mut lists = [vec![f64::NAN; 64], vec![f64::NAN; 64], vec![f64::NAN; 64]];
            let [zz, xx, zx] = &mut lists;
            kernel.coefficients(class, 1, &mut [zz, xx, zx]).unwrap();
            lists
        })
        .collect();
    let table = include_str!("../data/layered/G_r2_P1_gmb_Q3_dt0.2.csv");
    let (mut worst, mut largest, mut rows) = (0.0_f64, 0.0_f64, 0);
    for line in table.lines().skip(2) {
        let whole = |text: &str| -> usize { text.parse().unwrap() };
        let fields: Vec<&str> = line.split(',').collect();
        let [lag, row, column] = [0, 1, 2].map(|i| whole(fields[i]));
        let pair = kernel.classes().pairs()[row % 3 * 3 + column % 3];
        let [zz, xx, zx] = values[pair.class].each_ref().map(|list| list[lag - 1]);
        let found = match (row / 3, column / 3) {
            (0, 0) => zz,
            (1, 1) => xx,
            (0, 1) => pair.sign * zx,
            _ => -pair.sign * zx,
        };
        let wanted: f64 = fields[3].parse().unwrap();
        largest = largest.max(wanted.abs());
        worst = worst.max((found - wanted).abs());
        rows += 1;
    }
    println!("{rows} rows, {:e} of the largest", worst / largest);
    assert!(rows > 600);
    assert!(worst < 1e-7 * largest);
}

/// The closed form is exact in time, Radau IIA of higher order: late lags must agree.
#[test]
fn homogeneous_ground_tends_to_the_closed_form() {
    let soil = Soil::new(2.0, 0.3, 1.5).unwrap();
    let strip = Strip::uniform(-1.0..1.0, 4).unwrap();
    let dt = 0.1 / soil.shear_wave_speed();
    let closed = InfluenceKernel::new(soil, dt).unwrap();
    for stages in [Stages::Two, Stages::Three] {
        let profile = SoilProfile::on_half_plane(soil);
        let kernel = two_stages(profile, &strip).with_stages(stages).weights(dt).unwrap();
        let mut errors = [0.0_f64; 3];
        for class in 0..kernel.classes().count() {
            let [source, receiver] = kernel.classes().representative(class).unwrap();
            for (lag, error) in [30, 100, 400].into_iter().zip(&mut errors) {
                let [mut zz, mut xx, mut zx] = [[0.0]; 3];
                kernel.coefficients(class, lag, &mut [&mut zz, &mut xx, &mut zx]).unwrap();
                let wanted = closed.coefficients(receiver, source, lag).unwrap();
                let length = receiver.length();
                for (found, wanted) in [(zz, wanted.zz), (xx, wanted.xx)] {
                    *error = error.max((found[0] / (wanted * length) - 1.0).abs());
                }
                // The coupling ends with the Rayleigh wave; what is left is beside the others.
                if lag > 30 {
                    *error = error.max((zx[0] / length - wanted.zx).abs() / wanted.zz);
                }
            }
        }
        println!("{stages:?}: lags 30, 100, 400: {errors:?}");
        assert!(errors[0] < 1e-3, "{stages:?} {errors:?}");
        assert!(errors[1] < 1e-6, "{stages:?} {errors:?}");
        assert!(errors[2] < 1e-6, "{stages:?} {errors:?}");
    }
}

/// Same bits in any order and in any pieces.
#[test]
fn bits_of_a_lag_depend_on_nothing_else() {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let make = || two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.3).unwrap();
    let (one, two) = (make(), make());
    two.prepare(1000, &mut unobserved).unwrap();
    let mut whole = [vec![0.0; 600], vec![0.0; 600], vec![0.0; 600]];
    let [zz, xx, zx] = &mut whole;
    two.coefficients(1, 1, &mut [zz, xx, zx]).unwrap();
    for (first, count) in [(500, 101), (1, 3), (120, 20), (256, 1), (257, 100)] {
        let mut piece = [vec![f64::NAN; count], vec![f64::NAN; count], vec![f64::NAN; count]];
        let [zz, xx, zx] = &mut piece;
        one.coefficients(1, first, &mut [zz, xx, zx]).unwrap();
        for (piece, whole) in piece.iter().zip(&whole) {
            for (a, b) in piece.iter().zip(&whole[first - 1..]) {
                assert_eq!(a.to_bits(), b.to_bits());
            }
        }
    }
}

/// Errors are the tolerance's power 2/3 of the lag itself, also at the ends of blocks.
#[test]
fn tolerance_governs_the_latest_lags() {
    let strip = Strip::new(-1.0..1.0, 4, Grading::Cosine).unwrap();
    let lags = 1024;
    let values = |tolerance: f64| {
        let ground = two_stages(p1(gmb(5), gmb(1)), &strip).with_tolerance(tolerance).unwrap();
        let kernel = ground.weights(0.1).unwrap();
        let list = || vec![0.0; lags];
        let mut whole = [list(), list(), list()];
        let [zz, xx, zx] = &mut whole;
        kernel.coefficients(0, 1, &mut [zz, xx, zx]).unwrap();
        whole
    };
    let exact = values(1e-13);
    for tolerance in [1e-8, 1e-10] {
        let found = values(tolerance);
        let (mut own, mut first) = (0.0_f64, 0.0_f64);
        for (found, exact) in found.iter().zip(&exact).take(2) {
            for (lag, (a, b)) in found.iter().zip(exact).enumerate() {
                // Where the coefficient passes through zero its neighbours are the measure.
                let near = &exact[lag.saturating_sub(8)..(lag + 8).min(lags)];
                let size = near.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                own = own.max((a - b).abs() / size);
                first = first.max((a - b).abs() / exact[0]);
            }
        }
        println!("{tolerance:e}: {own:e} of the lag, {first:e} of the first");
        assert!(own < 10.0 * tolerance.powf(2.0 / 3.0), "{tolerance:e} {own:e}");
        assert!(first < tolerance.powf(2.0 / 3.0), "{tolerance:e} {first:e}");
    }
}
