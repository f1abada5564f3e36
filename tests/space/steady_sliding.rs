//! Steady sliding in space needs few iterations.

use basemat::Simulation;
use basemat::coupled::Load;
use basemat::interface::{Coulomb, InterfaceLaw};

use super::sliding::{BODY_WEIGHT, body, cells, thin_layer};

/// A push of `weights` times the weight that grows over 0.2 s.
fn growing_push(dof: usize, weights: f64) -> Load {
    Load::new(dof, move |time: f64| weights * BODY_WEIGHT * (time / 0.2).min(1.0))
}

/// Iterations of a late step under an oblique push beyond friction; the solution starts from the last step's forces.
fn steady_iterations(law: impl InterfaceLaw + 'static) -> usize {
    let mut simulation = Simulation::builder(4e-3)
        .structure(body())
        .ground(cells())
        .interface(law)
        .load(growing_push(0, 0.4))
        .load(growing_push(1, -0.2))
        .build()
        .unwrap();
    simulation.run(1500, |_| {}).unwrap();
    let state = simulation.step().unwrap();
    let pressures: Vec<f64> = state.contact.iter().map(|contact| contact.pressure).collect();
    let min_pressure = pressures.iter().copied().fold(f64::INFINITY, f64::min);
    let max_pressure = pressures.iter().copied().fold(0.0, f64::max);
    assert!(state.modes.iter().all(|mode| mode.is_slip()));
    assert!(max_pressure > 1.2 * min_pressure, "{min_pressure} {max_pressure}");
    println!("{} iterations, {:?}", state.trials, state.method);
    state.trials
}

#[test]
fn steady_sliding_needs_four_iterations_at_most() {
    assert!(steady_iterations(Coulomb::new(0.3).unwrap()) <= 4);
}

#[test]
fn steady_sliding_on_a_layer_needs_four_iterations_at_most() {
    assert!(steady_iterations(thin_layer(0.3)) <= 4);
}
