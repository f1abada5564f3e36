//! GOAL: layered soil operators never give energy away.
//! SCENE: layers on rock and on a rigid base, damped or not; three time steps cΔt/l from 0.02 to 50
//! for each (HEAVY_TESTS: six); tractions that take out all they can.
//! REFERENCE: zero work.

use basemat::Soil;
use basemat::bem::layered::Stages;
use basemat::bem::{Grading, Strip};
use basemat::history::ConvolutionWeights;
use basemat::soil::{Elastic, SoilProfile};

use basemat_problems::dense::solve;
use basemat_problems::heavy;
use basemat_problems::profiles::{gmb, p1, p3, two_stages};

const STEPS: usize = 256;

/// Work-form coefficients of all lags, 2Q × 2Q each.
fn matrices(kernel: &dyn ConvolutionWeights) -> Vec<Vec<f64>> {
    let classes = kernel.classes();
    let count = classes.elements().len();
    let lists: Vec<[Vec<f64>; 3]> = (0..classes.count())
        .map(|class| {
            let mut lists = [vec![0.0; STEPS], vec![0.0; STEPS], vec![0.0; STEPS]];
            let [zz, xx, zx] = &mut lists;
            kernel.coefficients(class, 1, &mut [zz, xx, zx]).unwrap();
            lists
        })
        .collect();
    (0..STEPS)
        .map(|lag| {
            let mut matrix = vec![0.0; 4 * count * count];
            for (index, pair) in classes.pairs().iter().enumerate() {
                let (p, q) = (index / count, index % count);
                let [zz, xx, zx] = lists[pair.class].each_ref().map(|list| list[lag]);
                matrix[p * 2 * count + q] = zz;
                matrix[(count + p) * 2 * count + count + q] = xx;
                matrix[p * 2 * count + count + q] = pair.sign * zx;
                matrix[(count + p) * 2 * count + q] = -pair.sign * zx;
            }
            matrix
        })
        .collect()
}

/// Least work over what ten steps of noise gave: −½ G¹⁻¹(h − s) takes out the most in each step.
fn least_work(matrices: &[Vec<f64>]) -> f64 {
    let n = matrices[0].len().isqrt();
    let mut seed = 12345_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / f64::from(1 << 23) - 1.0
    };
    let mut tractions: Vec<Vec<f64>> = vec![];
    let mut before = vec![0.0; n];
    let (mut work, mut given, mut least) = (0.0, 0.0, f64::INFINITY);
    for step in 0..STEPS {
        let mut history = vec![0.0; n];
        for (m, traction) in tractions.iter().enumerate() {
            let matrix = &matrices[step - m];
            for (row, h) in matrix.chunks_exact(n).zip(&mut history) {
                *h += row.iter().zip(traction).map(|(g, t)| g * t).sum::<f64>();
            }
        }
        let traction = if step < 10 {
            (0..n).map(|_| noise()).collect()
        } else {
            let change: Vec<f64> =
                history.iter().zip(&before).map(|(h, s)| -0.5 * (h - s)).collect();
            solve(&matrices[0].chunks_exact(n).map(<[_]>::to_vec).collect(), &change)
        };
        let mut now = history;
        for (row, s) in matrices[0].chunks_exact(n).zip(&mut now) {
            *s += row.iter().zip(&traction).map(|(g, t)| g * t).sum::<f64>();
        }
        work += traction.iter().zip(&now).zip(&before).map(|((t, s), b)| t * (s - b)).sum::<f64>();
        if step == 9 {
            given = work;
        }
        if step >= 9 || work < 0.0 {
            least = least.min(work);
        }
        tractions.push(traction);
        before = now;
    }
    least / given
}

#[test]
fn an_adversary_extracts_no_energy() {
    let soft_middle =
        SoilProfile::on_half_plane(Soil::from_shear_wave_speed(3.0, 0.3, 1.2).unwrap())
            .with_layer(Soil::from_shear_wave_speed(1.0, 0.3, 1.0).unwrap(), 1.0)
            .unwrap()
            .with_layer(Soil::from_shear_wave_speed(0.5, 0.45, 0.9).unwrap(), 1.0)
            .unwrap();
    let mut worst = f64::INFINITY;
    for (name, profile) in [
        ("elastic layer on rock", p1(Elastic, Elastic)),
        ("damped layer on rock", p1(gmb(5), gmb(1))),
        ("soft layer in the middle", soft_middle),
        ("elastic layer on rigid base", p3(Elastic)),
        ("damped layer on rigid base", p3(gmb(5))),
    ] {
        // Each profile has every ratio, by one of two gradings, or by both.
        for (first, grading, stages) in
            [(0, Grading::Uniform, Stages::Two), (1, Grading::Cosine, Stages::Three)]
        {
            let ratios = [0.02, 0.1, 0.5, 2.0, 10.0, 50.0].into_iter();
            let [first, every] = if heavy() { [0, 1] } else { [first, 2] };
            for ratio in ratios.skip(first).step_by(every) {
                let strip = Strip::new(-1.0..1.0, 5, grading).unwrap();
                let ground = two_stages(profile.clone(), &strip).with_stages(stages);
                let least = least_work(&matrices(&*ground.weights(ratio * 0.4).unwrap()));
                if least < 1e-4 {
                    println!("{name}, {grading:?}, {stages:?}, {ratio}: {least:e}");
                }
                assert!(least >= 0.0, "{name}, {grading:?}, {stages:?}, {ratio}: {least:e}");
                worst = worst.min(least);
            }
        }
    }
    println!("least work over that of ten steps: {worst:e}");
}
