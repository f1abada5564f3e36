//! GOAL: closed forms of pulses that overturn a block.
//! SCENE: rigid blocks at rest on rigid ground.
//! REFERENCE: the equation of motion in small steps, from event to event.

use basemat::Error;
use basemat::reference::RockingBlock;

/// Tilt and its rate after `step` of θ″ = p² (θ − equilibrium): distances from the unstable equilibrium grow and fall.
fn linear_step([tilt, rate]: [f64; 2], equilibrium: f64, p: f64, step: f64) -> [f64; 2] {
    let from = tilt - equilibrium;
    let growth = 0.5 * (from + rate / p);
    let fall = 0.5 * (from - rate / p);
    [
        equilibrium + growth * (p * step).exp() + fall * (-p * step).exp(),
        p * (growth * (p * step).exp() - fall * (-p * step).exp()),
    ]
}

/// Whether a slender block at rest overturns by a rectangular pulse, by steps of the linear equation.
fn overturns(block: &RockingBlock, acceleration: f64, duration: f64) -> bool {
    let angle = block.slenderness_angle();
    let p = block.frequency_parameter();
    let steps = 20_000;
    let step = duration / f64::from(steps);
    let mut state = [0.0, 0.0];
    for _ in 0..steps {
        state = linear_step(state, angle - acceleration / 9.81, p, step);
    }
    loop {
        state = linear_step(state, angle, p, 1e-3 / p);
        if !(0.0..angle).contains(&state[0]) {
            return state[0] > 0.0;
        }
    }
}

#[test]
fn pulses_overturn_from_the_duration_of_housner() {
    let block = RockingBlock::new(0.5, 2.0, 9.81).unwrap();
    for factor in [1.05, 1.5, 4.0, 30.0] {
        let acceleration = factor * 9.81 * block.slenderness_angle();
        let duration = block.overturning_pulse(acceleration).unwrap();
        assert!(overturns(&block, acceleration, 1.0001 * duration), "{factor}");
        assert!(!overturns(&block, acceleration, 0.9999 * duration), "{factor}");
    }
    let smallest_acceleration = 9.81 * block.slenderness_angle();
    for invalid_number in [smallest_acceleration, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            matches!(block.overturning_pulse(invalid_number), Err(Error::Input { .. })),
            "{invalid_number}"
        );
    }
}

/// Rates of the tilt towards the lower corner and of its rate: θ″ = −p² sin(α − θ).
fn rocking_rates([tilt, rate]: [f64; 2], angle: f64, p: f64) -> [f64; 2] {
    [rate, -p * p * (angle - tilt).sin()]
}

fn shifted([tilt, rate]: [f64; 2], time: f64, rates: [f64; 2]) -> [f64; 2] {
    [tilt + time * rates[0], rate + time * rates[1]]
}

/// A step of Runge–Kutta integration.
fn rocking_step(state: [f64; 2], angle: f64, p: f64, step: f64) -> [f64; 2] {
    let a = rocking_rates(state, angle, p);
    let b = rocking_rates(shifted(state, 0.5 * step, a), angle, p);
    let c = rocking_rates(shifted(state, 0.5 * step, b), angle, p);
    let d = rocking_rates(shifted(state, step, c), angle, p);
    [0, 1].map(|k| state[k] + step / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]))
}

/// Whether the ground's velocity jumps by `velocity`, and back after `delay` times the time to the first impact,
/// overturn a block: θ″ = −p² sin(α − θ) on one corner and its mirror image on the other one.
fn overturned_by_two(block: &RockingBlock, size: f64, velocity: f64, delay: f64) -> bool {
    let angle = block.slenderness_angle();
    let p = block.frequency_parameter();
    let step = 1e-3 / p;
    let jump = 0.75 * velocity * angle.cos() / size;
    // Up to the largest tilt; the time to the first impact is twice that.
    let mut first = [0.0, jump];
    let mut fall = 0.0;
    while first[1] > 0.0 && first[0] < angle {
        first = rocking_step(first, angle, p, step);
        fall += step;
    }
    let pulse_time = 2.0 * fall * delay;
    let mut state = [0.0, jump];
    let mut time = 0.0;
    let mut has_jumped_back = false;
    let mut side = 1.0;
    loop {
        if !has_jumped_back && time >= pulse_time {
            state[1] -= side * jump;
            has_jumped_back = true;
        }
        let mut next_state = rocking_step(state, angle, p, step);
        if next_state[0] < 0.0 {
            // An impact: the block rotates about the other corner at the reduced rate.
            side = -side;
            next_state = [0.0, -next_state[1] * block.restitution()];
            if has_jumped_back && next_state[1] < 1e-3 * p {
                return false;
            }
        }
        if next_state[0] > angle {
            return true;
        }
        state = next_state;
        time += step;
        if time > 40.0 / p {
            return false;
        }
    }
}

#[test]
fn double_impulses_overturn_from_the_velocity_of_the_closed_form() {
    for (half_width, half_height) in [(0.5_f64, 2.0_f64), (0.5, 0.9), (3.0, 8.0)] {
        let block = RockingBlock::new(half_width, half_height, 9.81).unwrap();
        let size = half_width.hypot(half_height);
        let velocity = block.overturning_double_impulse().unwrap();
        // Right after the impact.
        assert!(overturned_by_two(&block, size, 1.01 * velocity, 1.005), "{half_width}");
        assert!(!overturned_by_two(&block, size, 0.99 * velocity, 1.005), "{half_width}");
        for delay in [0.3, 0.7, 0.9, 1.3, 1.6] {
            assert!(!overturned_by_two(&block, size, velocity, delay), "{half_width}, {delay}");
        }
    }
    // sin² α = 0.8: the block stops at its first impact.
    let low_block = RockingBlock::new(2.0, 1.0, 9.81).unwrap();
    assert!(matches!(low_block.overturning_double_impulse(), Err(Error::Input { .. })));
}
