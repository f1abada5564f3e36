//! GOAL: contact does not chatter with the default scheme, and slip converges with the time step.
//! SCENE: rigid and flexible blocks that rock and slide under El Centro × 2; steps of 4 to 0.5 ms.
//! REFERENCE: the runs with shorter steps. `cargo study contact-chatter` compares more schemes.

use basemat::interface::UnilateralCondition;

use basemat_problems::chatter::{ChatterResult, ChatterScene, ChatterScheme};

/// Runs a block through the first strong seconds of El Centro × 2.
///
/// `young`: Young's modulus of a flexible block, Pa.
fn run(friction: f64, scheme: ChatterScheme, time_step: f64, young: Option<f64>) -> ChatterResult {
    let scene = ChatterScene {
        friction,
        scheme,
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

/// Runs with steps of 4, 2 and 1 ms.
fn refined_runs(friction: f64, young: Option<f64>) -> [ChatterResult; 3] {
    [4e-3, 2e-3, 1e-3].map(|time_step| run(friction, ChatterScheme::Midpoint, time_step, young))
}

/// Changes of a value between the runs with the two longer and with the two shorter steps.
struct Changes {
    coarse: f64,
    fine: f64,
}

fn changes(runs: &[ChatterResult; 3], value: impl Fn(&ChatterResult) -> f64) -> Changes {
    Changes {
        coarse: (value(&runs[0]) - value(&runs[1])).abs(),
        fine: (value(&runs[1]) - value(&runs[2])).abs(),
    }
}

#[test]
fn sliding_block_is_smooth_and_slip_converges() {
    type NamedSlip = (&'static str, fn(&ChatterResult) -> f64);
    let runs = refined_runs(0.3, None);
    let finest_run = runs[2];
    for outcome in &runs {
        assert!(outcome.penetration < 1e-12 && outcome.energy_error < 1e-11);
    }
    // Content of landings above 20 Hz does not grow when steps are halved; chatter, which alternates from step to
    // step, decreases.
    assert!(finest_run.rms_above < 0.02, "{finest_run:?}");
    let change = changes(&runs, |outcome| outcome.rms_above).fine;
    assert!(change < 0.05 * finest_run.rms_above, "{change}");
    assert!(finest_run.alternating < 0.8 * runs[1].alternating, "{finest_run:?}");
    let slips: [NamedSlip; 2] =
        [("peak", |outcome| outcome.peak_slip), ("residual", |outcome| outcome.residual_slip)];
    for (name, slip) in slips {
        let Changes { coarse, fine } = changes(&runs, slip);
        println!("{name} slip: {coarse:e}, then {fine:e}");
        assert!(fine < 0.6 * coarse, "{name}: {coarse} {fine}");
        assert!(fine < 0.02 * slip(&finest_run).abs(), "{name}: {fine}");
    }
}

#[test]
fn flexible_block_does_not_chatter() {
    let runs = refined_runs(0.3, Some(1e9));
    assert!(runs[2].alternating < 0.8 * runs[1].alternating, "{runs:?}");
    let change = changes(&runs, |outcome| outcome.rms_above).fine;
    assert!(change < 0.1 * runs[2].rms_above, "{change}");
}

/// The dissipative rule damps vibrations that the step does not resolve and keeps the base shear.
///
/// Landings of a block of fine elements excite these vibrations, which appear in the accelerations.
#[test]
fn dissipation_smooths_accelerations_and_keeps_the_shear() {
    let midpoint = run(0.6, ChatterScheme::Midpoint, 2e-3, Some(1e9));
    let refined_run = run(0.6, ChatterScheme::Midpoint, 5e-4, Some(1e9));
    let error = (midpoint.shear - refined_run.shear).abs();
    for (gamma, max_ratio) in [(0.8, 0.35), (1.0, 0.15)] {
        let dissipative_run = run(0.6, ChatterScheme::Dissipative(gamma), 2e-3, Some(1e9));
        let limit = max_ratio * midpoint.acceleration_alternating;
        assert!(dissipative_run.acceleration_alternating < limit, "γ = {gamma}");
        assert!((dissipative_run.shear - midpoint.shear).abs() < error, "{error}");
        assert!(
            dissipative_run.algorithmic_energy > 0.0 && dissipative_run.algorithmic_energy < 0.01
        );
        assert!((dissipative_run.rotation / midpoint.rotation - 1.0).abs() < 0.01);
        assert!(dissipative_run.energy_error < 1e-11);
    }
}

#[test]
fn rocking_block_does_not_chatter() {
    let runs = refined_runs(0.6, None);
    // Landings have more content above 20 Hz than sliding; the alternating part is halved with the step.
    for outcome in &runs {
        assert!(outcome.uplift > 0.5 && outcome.rms_above < 0.06, "{runs:?}");
    }
    assert!(runs[2].alternating < 0.6 * runs[1].alternating, "{runs:?}");
    let change = changes(&runs, |outcome| outcome.rms_above).fine;
    assert!(change < 0.1 * runs[2].rms_above, "{change}");
    let change = changes(&runs, |outcome| outcome.rotation).fine;
    assert!(change < 0.02 * runs[2].rotation, "{change}");
}
