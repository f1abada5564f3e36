//! Pulses that just overturn a rigid block, on stiff ground and on soil.

use std::f64::consts::TAU;

use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY};
use basemat::reference::RockingBlock;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{Case, Check, Outcome};
use crate::AnyError;
use crate::figure::{BLUE, Figure, GREEN, ORANGE, Panel, RED};
use basemat_problems::series::whole;

pub(crate) const CASE: Case = Case {
    name: "overturning",
    title: "Pulses that overturn a block",
    reference: "rectangular and double pulse in closed form (Housner; Nabeshima et al.); sine by own integration from event to event, exact between events",
    settings: "block 1 m × 4 m, small tilts with P–Δ; two stiff elements, Δt = 0.1 ms, under impulses 0.02 ms; half-plane, 16 cosine-graded elements, Δt = 2.5 ms",
    run,
};

/// Half width, half height (m), mass (kg/m).
const B: f64 = 0.5;
const H: f64 = 2.0;
const MASS: f64 = 1e4;
/// Frequencies of the sine pulses over the rate q of the inverted pendulum.
const FREQUENCIES: [f64; 5] = [2.0, 3.0, 4.0, 5.0, 6.0];
/// Rate after an impact below which the block stays at rest, over q b/h.
const REST: f64 = 1e-4;
/// Times in 1/q that a run goes on after the pulse.
const AFTER: f64 = 12.0;

/// Tilt at which the block stands on its corner, for small tilts.
const LIMIT: f64 = B / H;

/// About the corner.
fn corner_inertia() -> f64 {
    MASS * (4.0 / 3.0) * (B * B + H * H)
}

/// Rate of the inverted pendulum, 1/s: q² = N h/I.
fn rate() -> f64 {
    (MASS * STANDARD_GRAVITY * H / corner_inertia()).sqrt()
}

/// Part of the rate of rotation that an impact leaves, from the moment of momentum.
fn kept() -> f64 {
    1.0 - 2.0 * MASS * B * B / corner_inertia()
}

/// Whether one sine cycle of peak `amplitude` (over g b/h, above one) and `frequency` (over q) overturns the block.
///
/// In units of q and b/h: θ″ = θ − s + a sin ωt on the corner of side s, solved by e^t, e^−t and sin ωt; impacts are
/// found on this solution by bisection.
fn overturned(amplitude: f64, frequency: f64) -> bool {
    let end = TAU / frequency;
    let mut time = (1.0 / amplitude).asin() / frequency;
    let (mut state, mut side) = ([0.0, 0.0], 1.0);
    let step = 1e-3_f64;
    loop {
        let forced = time < end;
        let amplitude = if forced { amplitude } else { 0.0 };
        let particular = -amplitude / (1.0 + frequency * frequency);
        let at = |elapsed: f64| {
            let wave = |time: f64| {
                let (sine, cosine) = (frequency * time).sin_cos();
                [particular * sine, particular * frequency * cosine]
            };
            let [now, later] = [wave(time), wave(time + elapsed)];
            let from = [state[0] - side - now[0], state[1] - now[1]];
            let (sinh, cosh) = (elapsed.sinh(), elapsed.cosh());
            [
                side + later[0] + from[0] * cosh + from[1] * sinh,
                later[1] + from[0] * sinh + from[1] * cosh,
            ]
        };
        let mut elapsed = if forced { step.min(end - time).max(1e-12) } else { step };
        let mut next = at(elapsed);
        if next[0] * side < 0.0 {
            let (mut low, mut high) = (0.0, elapsed);
            for _ in 0..60 {
                let middle = f64::midpoint(low, high);
                if at(middle)[0] * side < 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            elapsed = high;
            next = at(elapsed);
            side = -side;
            next = [0.0, kept() * next[1]];
            if next[1].abs() < REST {
                // At rest until the ground accelerates enough again.
                let Some(start) = uplift(time + elapsed, amplitude, frequency) else {
                    return false;
                };
                time = start;
                state = [0.0; 2];
                side = (frequency * time).sin().signum();
                continue;
            }
        }
        time += elapsed;
        state = next;
        let outward = state[0] * state[1] > 0.0;
        if state[0].abs() > 10.0 || (time >= end && state[0].abs() > 1.0 && outward) {
            return true;
        }
        // Free, and not fast enough to reach the corner again.
        let least = state[1].powi(2) - (1.0 - state[0].abs()).powi(2);
        if time >= end && state[0].abs() < 1.0 && least < 0.0 {
            return false;
        }
    }
}

/// First time from `from` on at which a sine pulse lifts the block.
fn uplift(from: f64, amplitude: f64, frequency: f64) -> Option<f64> {
    let step = 1e-4;
    let steps = whole(((TAU / frequency - from) / step).max(0.0));
    let mut times = (0..steps).map(|k| from + k as f64 * step);
    times.find(|time| amplitude * (frequency * time).sin().abs() > 1.0)
}

/// Least of the numbers at which `fails`, upwards from `from` by `step`, then to `precision`; all relative.
fn boundary(
    from: f64,
    [step, precision]: [f64; 2],
    fails: impl Fn(f64) -> Result<bool, AnyError>,
) -> Result<f64, AnyError> {
    let (mut low, mut high) = (from, from);
    while !fails(high)? {
        (low, high) = (high, high * (1.0 + step));
        if high > 50.0 * from {
            return Err("nothing overturns the block".into());
        }
    }
    if low == high {
        return Err("the block overturns at the first of all amplitudes".into());
    }
    while high > low * (1.0 + precision) {
        let middle = f64::midpoint(low, high);
        if fails(middle)? { high = middle } else { low = middle }
    }
    Ok(f64::midpoint(low, high))
}

/// Whether a record overturns the block on this ground.
fn falls(
    ground: impl Ground + 'static,
    width: f64,
    time_step: f64,
    record: Record,
) -> Result<bool, AnyError> {
    let end = record.duration();
    let steps = whole((end + AFTER / rate()) / time_step);
    let central = corner_inertia() - MASS * (B * B + H * H);
    let block = RigidBlock::from_mass(width, MASS, central, H)?.with_p_delta(STANDARD_GRAVITY)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(block)
        .ground(ground)
        .interface(Coulomb::uplift_only())
        .motion(record)
        .build()?;
    let (mut before, mut rises) = (0.0, false);
    for _ in 0..steps {
        let state = simulation.step()?;
        let tilt = state.absolute_displacement()[RigidBlock::ROTATION].abs();
        if tilt > 2.0 * LIMIT {
            return Ok(true);
        }
        // Turned back after the pulse: no later amplitude is larger.
        if state.time > end && before > tilt && (0.1 * LIMIT..LIMIT).contains(&tilt) && rises {
            return Ok(false);
        }
        rises = tilt > before;
        before = tilt;
    }
    Ok(false)
}

/// Two stiff elements, whose pressures act at ±b.
fn on_corners(time_step: f64, record: Record) -> Result<bool, AnyError> {
    let bed = SpringGround::new(-2.0 * B..2.0 * B, 2, 4e12, 1e13)?
        .with_dashpots(2e8, 0.0)?
        .with_theta(1.0)?;
    falls(bed, 4.0 * B, time_step, record)
}

fn on_soil(speed: f64, record: Record) -> Result<bool, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let ground = ElasticGround::new(soil, Strip::new(-B..B, 16, Grading::Cosine)?)?;
    falls(ground, 2.0 * B, 2.5e-3, record)
}

/// One cycle of sine.
fn sine(amplitude: f64, frequency: f64) -> basemat::Result<Record> {
    let (peak, omega) = (amplitude * STANDARD_GRAVITY * LIMIT, frequency * rate());
    Record::from_fn(TAU / omega / 800.0, TAU / omega, |time| peak * (omega * time).sin())
}

/// Velocity of the two impulses in closed form for small tilts, the second one a time δ (over 1/q) after the impact:
/// m h V/I = q b/h / (η + e^−δ), from the tilt and the rate that meet on the path to the unstable equilibrium.
fn double_impulse(after: f64) -> f64 {
    rate() * LIMIT * corner_inertia() / (MASS * H * (kept() + (-after).exp()))
}

/// The velocity's rate of rotation, over q b/h.
fn rate_of(velocity: f64) -> f64 {
    MASS * H * velocity / corner_inertia() / (rate() * LIMIT)
}

/// Jumps of the ground's velocity by `velocity`, at the begin and, back, a time `after` (over 1/q) after the impact.
fn jumps(velocity: f64, after: f64) -> Result<Record, AnyError> {
    let step = 5e-4;
    // Rises at the rate Ω: turns where tanh t = Ω, and is back after twice this time.
    let later = whole((2.0 * rate_of(velocity).atanh() + after) / rate() / step);
    let mut samples = vec![0.0; later + 4];
    samples[1] = velocity / step;
    samples[later + 1] -= velocity / step;
    Ok(Record::new(step, samples)?)
}

/// Housner's rectangular pulse of `amplitude` (over g b/h), rising and falling within a sample, and `duration`, s.
fn rectangle(amplitude: f64, duration: f64) -> basemat::Result<Record> {
    const SAMPLES: usize = 800;
    let mut samples = vec![amplitude * STANDARD_GRAVITY * LIMIT; SAMPLES + 2];
    [samples[0], samples[SAMPLES + 1]] = [0.0; 2];
    Record::new(duration / SAMPLES as f64, samples)
}

/// Least durations of rectangular pulses, on stiff ground and on soil, over Housner's.
fn rectangles(short: bool) -> Result<Vec<Check>, AnyError> {
    let block = RockingBlock::new(B, H, STANDARD_GRAVITY)?;
    let mut checks = Vec::new();
    // Accelerations over g b/h, and limits on 200 and 50 m/s.
    let all = [
        (1.2, [0.75..=0.85, 0.48..=0.56]),
        (2.0, [0.87..=0.93, 0.66..=0.75]),
        (5.0, [0.91..=0.97, 0.77..=0.85]),
    ];
    for (x, limits) in all {
        // Housner's slender block has p and α where the block of small tilts has q and b/h.
        let slender = x * STANDARD_GRAVITY * block.slenderness_angle();
        let wanted = block.overturning_pulse(slender)? * block.frequency_parameter() / rate();
        let over = |ground: &dyn Fn(Record) -> Result<bool, AnyError>, from: f64| {
            let found =
                boundary(from * wanted, [0.03, 2e-4], |duration| ground(rectangle(x, duration)?))?;
            Ok::<_, AnyError>(found / wanted)
        };
        let name = format!("rectangle of {x} g b/h");
        let stiff = over(&|record| on_corners(1e-4, record), 0.9)?;
        let label = format!("{name}, stiff ground: least duration, relative");
        checks.push(Check::below(label, (stiff - 1.0).abs(), 2e-3));
        for (speed, limits) in [200.0, 50.0].into_iter().zip(limits) {
            if !short {
                let found = over(&|record| on_soil(speed, record), 0.4)?;
                let label = format!("{name}, {speed} m/s: over that on rigid ground");
                checks.push(Check::within(label, found, limits));
            }
        }
    }
    Ok(checks)
}

fn run(short: bool) -> Result<Outcome, AnyError> {
    let mut checks = rectangles(short)?;
    let [mut exact, mut stiff, mut firm, mut soft] = [const { Vec::new() }; 4];
    let frequencies = if short { &FREQUENCIES[1..4] } else { &FREQUENCIES[..] };
    for &frequency in frequencies {
        let wanted = boundary(1.0 + 1e-9, [2e-3, 1e-9], |a| Ok(overturned(a, frequency)))?;
        let found =
            boundary(0.8 * wanted, [0.03, 2e-4], |a| on_corners(1e-4, sine(a, frequency)?))?;
        let name = format!("sine of {frequency} q, stiff ground: least acceleration, relative");
        checks.push(Check::below(name, (found / wanted - 1.0).abs(), 1e-2));
        exact.push((frequency, wanted));
        stiff.push((frequency, found));
        for (speed, limits, list) in [(200.0, 0.8..=1.0, &mut firm), (50.0, 0.5..=1.1, &mut soft)] {
            if short && speed == 50.0 {
                continue;
            }
            let found =
                boundary(0.5 * wanted, [0.04, 1e-3], |a| on_soil(speed, sine(a, frequency)?))?;
            let name = format!("sine of {frequency} q, {speed} m/s: over that on rigid ground");
            checks.push(Check::within(name, found / wanted, limits));
            list.push((frequency, found));
        }
    }
    let times: &[f64] = if short { &[0.2] } else { &[0.02, 0.2, 0.5] };
    for &after in times {
        let wanted = double_impulse(after);
        let found = boundary(0.9 * wanted, [0.03, 2e-4], |v| on_corners(2e-5, jumps(v, after)?))?;
        let name = format!(
            "two impulses, the second {after}/q after the impact: least velocity, relative"
        );
        checks.push(Check::below(name, (found / wanted - 1.0).abs(), 1e-2));
    }
    let panel = Panel::new("frequency of the pulse over q", "least acceleration over g b/h")
        .legend(SeriesLabelPosition::UpperLeft)
        .reference("rigid ground, event by event", RED, exact)
        .circles("basemat, two corners on a stiff bed", BLUE, stiff)
        .line("half-plane, 200 m/s", GREEN, firm)
        .line("half-plane, 50 m/s", ORANGE, soft);
    let title = "One cycle of sine that just overturns a block of 1 m × 4 m, q = 1.9/s";
    Ok(Outcome { checks, figure: Figure::new(title, 1, vec![panel]) })
}
