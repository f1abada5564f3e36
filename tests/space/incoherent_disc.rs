//! Rigid disc without mass under incoherent ground motion, against Luco and Mita's table.

use basemat_problems::heavy;
use basemat_problems::incoherent_disc::{
    DISC_COMPONENTS, DISC_FREQUENCIES, Disc, PUBLISHED_MEAN_SQUARES, SampledMean,
    sampled_mean_squares,
};

/// GOAL: the mean square of the disc's motion is the published one, by w* Γ w, and the mean over seeds is w* Γ w.
#[test]
fn disc_filters_incoherent_motion_as_published() {
    let disc = Disc::new(16).unwrap();
    let seed_count = if heavy() { 200 } else { 40 };
    for (component, published) in DISC_COMPONENTS.into_iter().zip(PUBLISHED_MEAN_SQUARES) {
        let weights = disc.weights(component).unwrap();
        let sampled_mean_squares =
            sampled_mean_squares(&disc, component, &weights, seed_count).unwrap();
        for (k, frequency) in DISC_FREQUENCIES.into_iter().enumerate() {
            let mean_square = disc.mean_square(&weights[k], frequency).unwrap();
            let SampledMean { mean, standard_error } = sampled_mean_squares[k];
            println!(
                "{component} a0 = {frequency}: published {}, direct {mean_square:.4} ({:+.2} %), sampled {mean:.4} ± {standard_error:.4}",
                published[k],
                100.0 * (mean_square / published[k] - 1.0)
            );
            assert!((mean_square / published[k] - 1.0).abs() < 0.015, "{component} {frequency}");
            assert!((mean - mean_square).abs() < 4.0 * standard_error, "{component} {frequency}");
        }
    }
}

/// GOAL: a run moves the disc by Σ wᵢuᵢ, at the same time step.
#[test]
fn run_has_the_motion_of_the_weights() {
    let disc = Disc::new(6).unwrap();
    for component in DISC_COMPONENTS {
        let weights = disc.weights(component).unwrap();
        let by_weights = disc.response(component, &weights, 3).unwrap();
        let by_run = disc.run(component, 3).unwrap();
        println!("{by_weights:?}\n{by_run:?}");
        for (a, b) in by_weights.iter().zip(&by_run) {
            assert!((*a - *b).abs() < 0.01 * a.abs(), "{a:?} {b:?}");
        }
    }
}
