//! GOAL: closed forms of pulses that overturn a block.
//! SCENE: rigid blocks at rest on rigid ground.
//! REFERENCE: the equation of motion in small steps, from event to event.

use basemat::Error;
use basemat::reference::RockingBlock;

/// Whether a slender block at rest overturns by a rectangular pulse, by steps of the linear equation.
fn overturns(block: &RockingBlock, acceleration: f64, duration: f64) -> bool {
    let (angle, p) = (block.slenderness_angle(), block.frequency_parameter());
    let steps = 20_000;
    let step = duration / f64::from(steps);
    let (mut tilt, mut rate) = (0.0, 0.0);
    // Exact for a constant right-hand side: the tilt's distance from its unstable equilibrium grows and falls.
    let mut advance = |equilibrium: f64, step: f64| {
        let from = tilt - equilibrium;
        let (growth, fall) = (0.5 * (from + rate / p), 0.5 * (from - rate / p));
        tilt = equilibrium + growth * (p * step).exp() + fall * (-p * step).exp();
        rate = p * (growth * (p * step).exp() - fall * (-p * step).exp());
        tilt
    };
    for _ in 0..steps {
        advance(angle - acceleration / 9.81, step);
    }
    loop {
        let tilt = advance(angle, 1e-3 / p);
        if !(0.0..angle).contains(&tilt) {
            return tilt > 0.0;
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
    let least = 9.81 * block.slenderness_angle();
    for bad in [least, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(block.overturning_pulse(bad), Err(Error::Input { .. })), "{bad}");
    }
}

/// Whether the ground's velocity jumps by `velocity`, and back after `delay` times the time to the first impact,
/// overturn a block: θ″ = −p² sin(α − θ) on one corner and its mirror image on the other one, by Runge and Kutta.
fn overturned_by_two(block: &RockingBlock, size: f64, velocity: f64, delay: f64) -> bool {
    let (angle, p) = (block.slenderness_angle(), block.frequency_parameter());
    let step = 1e-3 / p;
    let jump = 0.75 * velocity * angle.cos() / size;
    // Tilt towards the corner that is down, and its rate.
    let advance = |[tilt, rate]: [f64; 2], step: f64| {
        let slope = |[tilt, rate]: [f64; 2]| [rate, -p * p * (angle - tilt).sin()];
        let plus = |k: [f64; 2], part: f64| [tilt + part * step * k[0], rate + part * step * k[1]];
        let a = slope([tilt, rate]);
        let b = slope(plus(a, 0.5));
        let c = slope(plus(b, 0.5));
        let d = slope(plus(c, 1.0));
        [0, 1].map(|k| [tilt, rate][k] + step / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]))
    };
    // To the first impact, where only the rate counts: its time is twice that of the rise.
    let mut first = [0.0, jump];
    let mut fall = 0.0;
    while first[1] > 0.0 && first[0] < angle {
        first = advance(first, step);
        fall += step;
    }
    let pushed = 2.0 * fall * delay;
    let (mut state, mut time, mut back, mut side) = ([0.0, jump], 0.0, false, 1.0);
    loop {
        if !back && time >= pushed {
            state[1] -= side * jump;
            back = true;
        }
        let mut next = advance(state, step);
        if next[0] < 0.0 {
            // An impact: the block turns on with what is left of the rate.
            side = -side;
            next = [0.0, -next[1] * block.restitution()];
            if back && next[1] < 1e-3 * p {
                return false;
            }
        }
        if next[0] > angle {
            return true;
        }
        state = next;
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
        let overturned =
            |factor: f64, delay: f64| overturned_by_two(&block, size, factor * velocity, delay);
        // Right after the impact.
        assert!(overturned(1.01, 1.005), "{half_width}");
        assert!(!overturned(0.99, 1.005), "{half_width}");
        for delay in [0.3, 0.7, 0.9, 1.3, 1.6] {
            assert!(!overturned(1.0, delay), "{half_width}, {delay}");
        }
    }
    // sin² α = 0.8: the block stops at its first impact.
    let low = RockingBlock::new(2.0, 1.0, 9.81).unwrap();
    assert!(matches!(low.overturning_double_impulse(), Err(Error::Input { .. })));
}
