//! GOAL: recorded series, peaks and envelopes are those of the states.
//! SCENE: the block of `results`, recorded in full and in every seventh step.
//! REFERENCE: the states, evaluated here.

use basemat::Error;
use basemat::coupled::{EnergyTerm, State};
use basemat::results::{Quantity, Recorder};

use super::{FRICTION_COEFFICIENT, Recorded, STEP_COUNT, recorded};

fn farthest_slip(state: &State) -> f64 {
    state.contact.iter().fold(0.0, |largest, contact| contact.slip.abs().max(largest))
}

fn largest(states: &[State], value: fn(&State) -> f64) -> f64 {
    states.iter().map(value).fold(f64::MIN, f64::max)
}

/// Checks the recorded series and the peaks.
fn assert_series(recorded: &Recorded) {
    let Recorded { states, time_series, run, .. } = recorded;
    let times: Vec<f64> = states.iter().map(|s| s.time).collect();
    assert_eq!(time_series.times(), times);
    let shear: Vec<f64> = states.iter().map(|s| s.base_shear).collect();
    assert_eq!(time_series.series(Quantity::BaseShear), shear);
    let rotation: Vec<f64> = states.iter().map(|s| s.base_rotation).collect();
    assert_eq!(time_series.series(Quantity::BaseRotation), rotation);
    let top: Vec<f64> = states.iter().map(|s| s.probes[0]).collect();
    assert_eq!(time_series.probe("top").unwrap(), top);
    assert_eq!(time_series.energy_balances()[STEP_COUNT], states[STEP_COUNT].energy_balance);

    let peak = (0..=STEP_COUNT).max_by(|&a, &b| shear[a].total_cmp(&shear[b])).unwrap();
    let computed = run.whole.base_shear.highest;
    assert_eq!((computed.value, computed.time), (shear[peak], times[peak]));
    let min_shear = shear.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!((run.whole.base_shear.lowest.value, min_shear < 0.0), (min_shear, true));
    let top_peak = top.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert_eq!(run.probe("top").unwrap().magnitude(), top_peak);

    assert_eq!(run.whole.base_moment.highest.value, largest(states, |s| s.base_moment));
    assert_eq!(run.whole.normal_force.highest.value, largest(states, |s| s.normal_force));
    assert_eq!(run.whole.base_rotation.highest.value, largest(states, |s| s.base_rotation));
    let uplifted = run.whole.uplifted_fraction.largest().value;
    assert_eq!(uplifted, largest(states, |s| s.uplifted_fraction));
    assert_eq!(run.whole.largest_slip.magnitude(), largest(states, farthest_slip));
    assert_eq!(run.whole.static_normal_force, states[0].normal_force);
    let changes: usize = states.iter().map(|s| s.transitions.len()).sum();
    assert_eq!(run.mode_changes, changes);
}

fn assert_envelopes(recorded: &Recorded) {
    let Recorded { simulation, states, run, .. } = recorded;
    let elements = simulation.ground().elements();
    for (e, envelope) in run.envelope.iter().enumerate() {
        let pressures: Vec<f64> = states.iter().map(|s| s.contact[e].pressure).collect();
        let max_pressure = pressures.iter().copied().fold(0.0, f64::max);
        assert_eq!(envelope.pressure.highest.value, max_pressure);
        let min_pressure = pressures.iter().copied().fold(1e99, f64::min);
        assert_eq!(envelope.pressure.lowest.value, min_pressure);
        assert_eq!(envelope.static_pressure, states[0].contact[e].pressure);
        let gap = states.iter().map(|s| s.contact[e].gap).fold(-1e99, f64::max);
        assert_eq!(envelope.gap.value, gap);
        let open_count = states[1..].iter().filter(|s| !s.modes[e].is_closed()).count();
        assert!((envelope.open - open_count as f64 * simulation.time_step()).abs() < 1e-9);
        assert_eq!(envelope.element, elements[e]);
    }
}

/// Checks the intervals of uplift, by runs of letters in a string.
fn assert_uplift(recorded: &Recorded) {
    let Recorded { simulation, states, run, .. } = recorded;
    let letters: String = states[1..]
        .iter()
        .map(|s| if s.uplifted_fraction > 0.0 { 'u' } else { ' ' })
        .collect();
    let stretches: Vec<usize> = letters.split_whitespace().map(str::len).collect();
    let uplift = run.whole.uplift;
    let dt = simulation.time_step();
    assert!(stretches.len() > 2, "{letters}");
    assert_eq!(uplift.count, stretches.len());
    assert!((uplift.duration - dt * stretches.iter().sum::<usize>() as f64).abs() < 1e-9);
    assert!((uplift.longest - dt * *stretches.iter().max().unwrap() as f64).abs() < 1e-9);
}

/// Checks the slip events, by runs of letters for the direction.
fn assert_slip_events(recorded: &Recorded) {
    let Recorded { simulation, states, run, .. } = recorded;
    let dt = simulation.time_step();
    let letters: Vec<char> = states
        .windows(2)
        .map(|pair| {
            let closed_modes: Vec<_> =
                pair[1].modes.iter().filter(|mode| mode.is_closed()).collect();
            let slides = !closed_modes.is_empty() && closed_modes.iter().all(|mode| mode.is_slip());
            match (slides, pair[1].mean_slip > pair[0].mean_slip) {
                (false, _) => ' ',
                (true, true) => 'r',
                (true, false) => 'l',
            }
        })
        .collect();
    let sliding = &run.whole.sliding;
    let events = letters.chunk_by(|a, b| a == b).filter(|event| event[0] != ' ').count();
    assert!(events > 2, "{letters:?}");
    assert_eq!(sliding.events.len(), events);
    let sliding_count = letters.iter().filter(|&&letter| letter != ' ').count();
    assert!((sliding.duration - dt * sliding_count as f64).abs() < 1e-9);
    assert_eq!(run.whole.residual_slip, states[STEP_COUNT].mean_slip);
    let sliding_distance: f64 = sliding.events.iter().map(|event| event.slip.abs()).sum();
    assert!((sliding_distance / sliding.path - 1.0).abs() < 1e-12);
    let peak = states.iter().fold(0.0_f64, |m, s| m.max(s.mean_slip.abs()));
    assert_eq!(run.whole.mean_slip.magnitude(), peak);
}

/// Checks the factors of safety, by the resultants of the states.
fn assert_safety(recorded: &Recorded) {
    let Recorded { states, time_series, run, .. } = recorded;
    let half = 2.0;
    for (k, state) in states.iter().enumerate() {
        let sliding = FRICTION_COEFFICIENT * state.normal_force / state.base_shear.abs();
        let overturning = state.normal_force * half / state.base_moment.abs();
        for (quantity, expected) in
            [(Quantity::SlidingSafety, sliding), (Quantity::OverturningSafety, overturning)]
        {
            let computed = time_series.series(quantity)[k];
            if state.normal_force == 0.0 {
                assert!(computed.is_nan());
                continue;
            }
            assert!(
                expected > 1e6 || (computed / expected - 1.0).abs() < 1e-8,
                "{computed} {expected}"
            );
            assert!(computed > 1.0 - 1e-9);
        }
    }
    let min_safety = run.whole.sliding_safety.lowest;
    assert!((min_safety.value - 1.0).abs() < 1e-9);
}

/// Checks the last energy balance and the sum of its fractions.
fn assert_energy(recorded: &Recorded) {
    let Recorded { states, run, .. } = recorded;
    let energy_balance = states[STEP_COUNT].energy_balance;
    assert_eq!(run.energy_balance, energy_balance);
    let fractions = energy_balance.fractions().unwrap();
    assert!((fractions.iter().map(|(_, fraction)| fraction).sum::<f64>() - 1.0).abs() < 1e-9);
    let contact = energy_balance.fraction(EnergyTerm::Contact).unwrap();
    assert!((contact * energy_balance.input / energy_balance.contact - 1.0).abs() < 1e-12);
    let soil = energy_balance.fraction(EnergyTerm::Soil).unwrap();
    assert!(soil > 0.05 && contact > 0.05);
}

/// All results are computed again from the states.
#[test]
fn series_and_peaks_are_those_of_the_states() {
    let recorded = recorded(Recorder::new().contact(1));
    assert_series(&recorded);
    assert_envelopes(&recorded);
    assert_uplift(&recorded);
    assert_slip_events(&recorded);
    assert_safety(&recorded);
    assert_energy(&recorded);
    // Frames are the states.
    let Recorded { states, time_series, .. } = recorded;
    let frames: Vec<_> = time_series.contact_frames().collect();
    assert_eq!(frames.len(), STEP_COUNT + 1);
    assert!(frames.iter().zip(&states).all(|(f, s)| f.states == s.contact && f.modes == s.modes));
}

#[test]
fn thinned_series_are_every_seventh_state() {
    let Recorded { states, time_series, .. } =
        recorded(Recorder::new().every(7).contact(20).motion(50));
    let complete_series = recorded(Recorder::new()).time_series;
    assert_eq!(time_series.times().len(), 1 + STEP_COUNT / 7);
    for (k, &shear) in time_series.series(Quantity::BaseShear).iter().enumerate() {
        assert_eq!(shear, states[7 * k].base_shear);
    }
    // Time, 13 scalars, 2 probes, 13 terms of the energy balance and its largest energy.
    assert_eq!(complete_series.bytes(), 8 * (1 + 13 + 2 + 14) * (STEP_COUNT + 1));
    assert!(time_series.bytes() < complete_series.bytes());
    assert_eq!(time_series.contact_frames().count(), 21);
    let frames: Vec<_> = time_series.motion_frames().collect();
    assert_eq!(frames.len(), 9);
    for (k, frame) in frames.iter().enumerate() {
        assert_eq!(frame.displacement, states[50 * k].displacement());
        assert_eq!(frame.velocity, states[50 * k].velocity());
    }
    assert!(matches!(
        time_series.acceleration_record("top acceleration"),
        Err(Error::Scene { .. })
    ));
}
