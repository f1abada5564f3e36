//! GOAL: contact does not chatter with the default scheme, and slip converges with the time step.
//! SCENE: rigid and flexible blocks that rock and slide under El Centro × 2; steps of 4, 2 and 1
//! ms.
//! REFERENCE: the finer runs. The schemes are compared in the example `contact_chatter`.

use basemat::interface::UnilateralCondition;

use basemat_problems::chatter::{Outcome, Scene, Scheme};

/// A block that rocks and slides through the first strong seconds of El Centro × 2.
fn run(friction: f64, time_step: f64, young: Option<f64>) -> Outcome {
    let scene = Scene {
        friction,
        scheme: Scheme::Midpoint,
        activation: UnilateralCondition::Position,
        shear_speed: 250.0,
        elements: 8,
        time_step,
        duration: 3.5,
        height: 8.0,
        young,
    };
    let outcome = scene.run().unwrap();
    println!("friction {friction}, Δt = {time_step}: {outcome:?}");
    outcome
}

/// Differences of the first two and the last two of three runs, of a value that `of` picks.
fn differences(runs: &[Outcome; 3], of: impl Fn(&Outcome) -> f64) -> [f64; 2] {
    [of(&runs[0]) - of(&runs[1]), of(&runs[1]) - of(&runs[2])].map(f64::abs)
}

#[test]
fn sliding_block_is_smooth_and_slip_converges() {
    let runs = [4e-3, 2e-3, 1e-3].map(|time_step| run(0.3, time_step, None));
    let finest = runs[2];
    for o in &runs {
        assert!(o.penetration < 1e-12 && o.energy_error < 1e-11);
    }
    // Landings are real: their content above 20 Hz does not grow when steps are halved, and what
    // alternates from step to step, which is what chatter does, fades.
    assert!(finest.rms_above < 0.02, "{finest:?}");
    let [_, change] = differences(&runs, |o| o.rms_above);
    assert!(change < 0.05 * finest.rms_above, "{change}");
    assert!(finest.alternating < 0.8 * runs[1].alternating, "{finest:?}");
    for (name, of) in
        [("peak", (|o| o.peak_slip) as fn(&Outcome) -> f64), ("residual", |o| o.residual_slip)]
    {
        let [coarse, fine] = differences(&runs, of);
        println!("{name} slip: {coarse:e}, then {fine:e}");
        assert!(fine < 0.6 * coarse && fine < 0.02 * of(&finest).abs(), "{name}: {coarse} {fine}");
    }
}

#[test]
fn flexible_block_does_not_chatter() {
    let runs = [4e-3, 2e-3, 1e-3].map(|time_step| run(0.3, time_step, Some(1e9)));
    assert!(runs[2].alternating < 0.8 * runs[1].alternating, "{runs:?}");
    let [_, change] = differences(&runs, |o| o.rms_above);
    assert!(change < 0.1 * runs[2].rms_above, "{change}");
}

/// Landings of a block of fine elements excite vibrations that the step does not resolve: the
/// dissipative rule takes them out of the accelerations and leaves the base shear as it is.
#[test]
fn dissipation_clears_accelerations_and_keeps_the_shear() {
    let run = |scheme, time_step| {
        let scene = Scene {
            friction: 0.6,
            scheme,
            activation: UnilateralCondition::Position,
            shear_speed: 250.0,
            elements: 8,
            time_step,
            duration: 3.5,
            height: 8.0,
            young: Some(1e9),
        };
        scene.run().unwrap()
    };
    let [midpoint, finer] = [2e-3, 5e-4].map(|step| run(Scheme::Midpoint, step));
    let error = (midpoint.shear - finer.shear).abs();
    for (gamma, left) in [(0.8, 0.35), (1.0, 0.15)] {
        let damped = run(Scheme::Dissipative(gamma), 2e-3);
        println!("γ = {gamma}: {damped:?}, midpoint {midpoint:?}, finer {finer:?}");
        assert!(damped.acceleration_alternating < left * midpoint.acceleration_alternating);
        assert!((damped.shear - midpoint.shear).abs() < error, "{error}");
        assert!(damped.algorithmic > 0.0 && damped.algorithmic < 0.01);
        assert!((damped.rotation / midpoint.rotation - 1.0).abs() < 0.01);
        assert!(damped.energy_error < 1e-11);
    }
}

#[test]
fn rocking_block_does_not_chatter() {
    let runs = [4e-3, 2e-3, 1e-3].map(|time_step| run(0.6, time_step, None));
    // Landings put more above 20 Hz than sliding does; what alternates is halved with the step.
    assert!(runs.iter().all(|o| o.uplift > 0.5 && o.rms_above < 0.06), "{runs:?}");
    assert!(runs[2].alternating < 0.6 * runs[1].alternating, "{runs:?}");
    let [_, change] = differences(&runs, |o| o.rms_above);
    assert!(change < 0.1 * runs[2].rms_above, "{change}");
    let [_, change] = differences(&runs, |o| o.rotation);
    assert!(change < 0.02 * runs[2].rotation, "{change}");
}
