//! GOAL: operators of layered soil never generate energy.
//! SCENE: layers on rock and on a rigid base, damped or not; three time steps cΔt/l from 0.02 to 50
//! for each (HEAVY_TESTS: six); tractions that extract the largest energy in each step.
//! REFERENCE: zero work.

use basemat::Soil;
use basemat::bem::layered::Stages;
use basemat::bem::{Grading, Strip};
use basemat::history::ConvolutionWeights;
use basemat::soil::{Elastic, SoilProfile};

use basemat_problems::dense::{dot, solve};
use basemat_problems::heavy;
use basemat_problems::profiles::{gmb, p1, p3, two_stages};

const MARCH_STEPS: usize = 256;

/// Weights in the form of work at all lags, 2Q × 2Q each.
fn weight_matrices(kernel: &dyn ConvolutionWeights) -> Vec<Vec<f64>> {
    let classes = kernel.classes();
    let count = classes.elements().len();
    let weights: Vec<[Vec<f64>; 3]> = (0..classes.count())
        .map(|class| {
            let mut weights = [(); 3].map(|()| vec![0.0; MARCH_STEPS]);
            kernel
                .coefficients(class, 1, &mut weights.each_mut().map(Vec::as_mut_slice))
                .unwrap();
            weights
        })
        .collect();
    (0..MARCH_STEPS)
        .map(|lag| {
            let mut matrix = vec![0.0; 4 * count * count];
            for (index, pair) in classes.pairs().iter().enumerate() {
                let p = index / count;
                let q = index % count;
                let pair_weights = &weights[pair.class];
                let coupling = pair.sign * pair_weights[2][lag];
                matrix[p * 2 * count + q] = pair_weights[0][lag];
                matrix[(count + p) * 2 * count + count + q] = pair_weights[1][lag];
                matrix[p * 2 * count + count + q] = coupling;
                matrix[(count + p) * 2 * count + q] = -coupling;
            }
            matrix
        })
        .collect()
}

/// Next random number between −1 and 1 of a linear congruential generator.
fn next_noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    (*seed >> 40) as f64 / f64::from(1 << 23) - 1.0
}

/// Smallest work of a march, over the work of its ten first steps of noise.
///
/// Tractions −½ G¹⁻¹(h − s) then extract the largest energy in each step.
fn smallest_work(matrices: &[Vec<f64>]) -> f64 {
    let n = matrices[0].len().isqrt();
    let mut seed = 12345_u64;
    let mut tractions: Vec<Vec<f64>> = vec![];
    let mut displacement = vec![0.0; n];
    let mut work = 0.0;
    let mut noise_work = 0.0;
    let mut min_work = f64::INFINITY;
    for step in 0..MARCH_STEPS {
        let mut history = vec![0.0; n];
        for (m, traction) in tractions.iter().enumerate() {
            for (row, h) in matrices[step - m].chunks_exact(n).zip(&mut history) {
                *h += dot(row, traction);
            }
        }
        let traction = if step < 10 {
            (0..n).map(|_| next_noise(&mut seed)).collect()
        } else {
            let change: Vec<f64> =
                history.iter().zip(&displacement).map(|(h, s)| -0.5 * (h - s)).collect();
            solve(&matrices[0].chunks_exact(n).map(<[_]>::to_vec).collect(), &change)
        };
        let mut end = history;
        for (row, s) in matrices[0].chunks_exact(n).zip(&mut end) {
            *s += dot(row, &traction);
        }
        let increments: Vec<f64> = end.iter().zip(&displacement).map(|(s, b)| s - b).collect();
        work += dot(&traction, &increments);
        if step == 9 {
            noise_work = work;
        }
        if step >= 9 || work < 0.0 {
            min_work = min_work.min(work);
        }
        tractions.push(traction);
        displacement = end;
    }
    min_work / noise_work
}

/// GOAL: tractions that extract the largest energy in each step never extract energy in sum.
#[test]
fn an_adversary_extracts_no_energy() {
    let soft_middle =
        SoilProfile::on_half_plane(Soil::from_shear_wave_speed(3.0, 0.3, 1.2).unwrap())
            .with_layer(Soil::from_shear_wave_speed(1.0, 0.3, 1.0).unwrap(), 1.0)
            .unwrap()
            .with_layer(Soil::from_shear_wave_speed(0.5, 0.45, 0.9).unwrap(), 1.0)
            .unwrap();
    let mut min_work = f64::INFINITY;
    for (name, profile) in [
        ("elastic layer on rock", p1(Elastic, Elastic)),
        ("damped layer on rock", p1(gmb(5), gmb(1))),
        ("soft layer in the middle", soft_middle),
        ("elastic layer on rigid base", p3(Elastic)),
        ("damped layer on rigid base", p3(gmb(5))),
    ] {
        // Each profile has every ratio, with one of two gradings, or with both.
        for (parity, grading, stages) in
            [(0, Grading::Uniform, Stages::Two), (1, Grading::Cosine, Stages::Three)]
        {
            for (k, ratio) in [0.02, 0.1, 0.5, 2.0, 10.0, 50.0].into_iter().enumerate() {
                if !heavy() && k % 2 != parity {
                    continue;
                }
                let strip = Strip::new(-1.0..1.0, 5, grading).unwrap();
                let ground = two_stages(profile.clone(), &strip).with_stages(stages);
                let weights = ground.weights(ratio * 0.4).unwrap();
                let work = smallest_work(&weight_matrices(&*weights));
                if work < 1e-4 {
                    println!("{name}, {grading:?}, {stages:?}, {ratio}: {work:e}");
                }
                assert!(work >= 0.0, "{name}, {grading:?}, {stages:?}, {ratio}: {work:e}");
                min_work = min_work.min(work);
            }
        }
    }
    println!("smallest work over that of ten steps: {min_work:e}");
}
