//! Smallest pulses that overturn a rigid block, on stiff ground and on soil.

use std::f64::consts::TAU;

use basemat::bem::{ElasticGround, Grading, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY};
use basemat::reference::RockingBlock;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_ORANGE, CURVE_RED, Figure, FigurePanel};
use basemat_problems::series::nearest_integer;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "overturning",
    title: "Pulses that overturn a block",
    reference: "rectangular and double pulse in closed form (Housner; Nabeshima et al.); sine by separate integration from event to event, exact between events",
    settings: "block 1 m × 4 m, small tilts with P–Δ; two stiff elements, Δt = 0.1 ms, under impulses 0.02 ms; half-plane, 16 cosine-graded elements, Δt = 2.5 ms",
    run,
};

/// Half width, half height (m), mass (kg/m).
const B: f64 = 0.5;
const H: f64 = 2.0;
const BLOCK_MASS: f64 = 1e4;
/// Frequencies of the sine pulses over the rate q of the inverted pendulum.
const PULSE_FREQUENCIES: [f64; 5] = [2.0, 3.0, 4.0, 5.0, 6.0];
/// Rate after an impact below which the block stays at rest, over q b/h.
const REST_RATE: f64 = 1e-4;
/// Duration of a run after the pulse, in 1/q.
const FREE_DURATION: f64 = 12.0;

/// Tilt at which the block stands on its corner, for small tilts.
const CORNER_TILT: f64 = B / H;

/// Moment of inertia about the corner.
fn corner_inertia() -> f64 {
    BLOCK_MASS * (4.0 / 3.0) * (B * B + H * H)
}

/// Rate of the inverted pendulum, 1/s: q² = N h/I.
fn rate() -> f64 {
    (BLOCK_MASS * STANDARD_GRAVITY * H / corner_inertia()).sqrt()
}

/// Rate of rotation after an impact over the rate before it, from the moment of momentum.
fn impact_ratio() -> f64 {
    1.0 - 2.0 * BLOCK_MASS * B * B / corner_inertia()
}

/// Rotation about a corner from a state at `time`, in units of q and b/h.
struct CornerMotion {
    amplitude: f64,
    frequency: f64,
    time: f64,
    /// Tilt and its rate.
    state: [f64; 2],
    side: f64,
}

impl CornerMotion {
    /// Tilt and rate of the particular solution.
    fn particular(&self, time: f64) -> [f64; 2] {
        let factor = -self.amplitude / (1.0 + self.frequency * self.frequency);
        let angle = self.frequency * time;
        [factor * angle.sin(), factor * self.frequency * angle.cos()]
    }

    /// State after a time.
    fn after(&self, elapsed_time: f64) -> [f64; 2] {
        let present_value = self.particular(self.time);
        let later_value = self.particular(self.time + elapsed_time);
        let from = [self.state[0] - self.side - present_value[0], self.state[1] - present_value[1]];
        let sinh = elapsed_time.sinh();
        let cosh = elapsed_time.cosh();
        [
            self.side + later_value[0] + from[0] * cosh + from[1] * sinh,
            later_value[1] + from[0] * sinh + from[1] * cosh,
        ]
    }
}

/// Whether one sine cycle of peak `amplitude` (over g b/h, above one) and `frequency` (over q) overturns the block.
///
/// In units of q and b/h: θ″ = θ − s + a sin ωt on the corner of side s, solved by e^t, e^−t and sin ωt. Impacts are
/// found on this solution by bisection.
fn overturned(amplitude: f64, frequency: f64) -> bool {
    let end = TAU / frequency;
    let mut time = (1.0 / amplitude).asin() / frequency;
    let mut state = [0.0, 0.0];
    let mut side = 1.0;
    let step = 1e-3_f64;
    loop {
        let forced = time < end;
        let amplitude = if forced { amplitude } else { 0.0 };
        let motion = CornerMotion { amplitude, frequency, time, state, side };
        let mut elapsed_time = if forced { step.min(end - time).max(1e-12) } else { step };
        let mut next_state = motion.after(elapsed_time);
        if next_state[0] * side < 0.0 {
            let mut low = 0.0;
            let mut high = elapsed_time;
            for _ in 0..60 {
                let middle = f64::midpoint(low, high);
                if motion.after(middle)[0] * side < 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            elapsed_time = high;
            next_state = motion.after(elapsed_time);
            side = -side;
            next_state = [0.0, impact_ratio() * next_state[1]];
            if next_state[1].abs() < REST_RATE {
                // The block stays at rest until the ground acceleration lifts it again.
                let Some(start) = uplift(time + elapsed_time, amplitude, frequency) else {
                    return false;
                };
                time = start;
                state = [0.0; 2];
                side = (frequency * time).sin().signum();
                continue;
            }
        }
        time += elapsed_time;
        state = next_state;
        let outward = state[0] * state[1] > 0.0;
        if state[0].abs() > 10.0 || (time >= end && state[0].abs() > 1.0 && outward) {
            return true;
        }
        // After the pulse, and not fast enough to reach the corner again.
        let excess_energy = state[1].powi(2) - (1.0 - state[0].abs()).powi(2);
        if time >= end && state[0].abs() < 1.0 && excess_energy < 0.0 {
            return false;
        }
    }
}

/// First time from `from` on at which a sine pulse lifts the block.
fn uplift(from: f64, amplitude: f64, frequency: f64) -> Option<f64> {
    let step = 1e-4;
    let steps = nearest_integer(((TAU / frequency - from) / step).max(0.0));
    let mut times = (0..steps).map(|k| from + k as f64 * step);
    times.find(|time| amplitude * (frequency * time).sin().abs() > 1.0)
}

/// Smallest number at which `fails`.
///
/// The search goes upwards from `from` by `step`, then bisects to `precision`; both are relative.
fn boundary(
    from: f64,
    step: f64,
    precision: f64,
    fails: impl Fn(f64) -> Result<bool, AnyError>,
) -> Result<f64, AnyError> {
    let mut low = from;
    let mut high = from;
    while !fails(high)? {
        low = high;
        high *= 1.0 + step;
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
fn overturns(
    ground: impl Ground + 'static,
    width: f64,
    time_step: f64,
    record: Record,
) -> Result<bool, AnyError> {
    let end = record.duration();
    let steps = nearest_integer((end + FREE_DURATION / rate()) / time_step);
    let central = corner_inertia() - BLOCK_MASS * (B * B + H * H);
    let block =
        RigidBlock::from_mass(width, BLOCK_MASS, central, H)?.with_p_delta(STANDARD_GRAVITY)?;
    let mut simulation = Simulation::builder(time_step)
        .structure(block)
        .ground(ground)
        .interface(Coulomb::uplift_only())
        .motion(record)
        .build()?;
    let mut before = 0.0;
    let mut rises = false;
    for _ in 0..steps {
        let state = simulation.step()?;
        let tilt = state.absolute_displacement()[RigidBlock::ROTATION_DOF].abs();
        if tilt > 2.0 * CORNER_TILT {
            return Ok(true);
        }
        // The block has turned back after the pulse, and no later amplitude is larger.
        if state.time > end
            && before > tilt
            && (0.1 * CORNER_TILT..CORNER_TILT).contains(&tilt)
            && rises
        {
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
    overturns(bed, 4.0 * B, time_step, record)
}

fn on_soil(speed: f64, record: Record) -> Result<bool, AnyError> {
    let soil = Soil::from_wave_speeds(speed, 2.0 * speed, 2000.0)?;
    let ground = ElasticGround::new(soil, Strip::new(-B..B, 16, Grading::Cosine)?)?;
    overturns(ground, 2.0 * B, 2.5e-3, record)
}

/// One cycle of sine.
fn sine(amplitude: f64, frequency: f64) -> basemat::Result<Record> {
    let peak = amplitude * STANDARD_GRAVITY * CORNER_TILT;
    let omega = frequency * rate();
    Record::from_fn(TAU / omega / 800.0, TAU / omega, |time| peak * (omega * time).sin())
}

/// Velocity of the two impulses in closed form for small tilts, the second one a time δ (over 1/q) after the impact:
/// m h V/I = q b/h / (η + e^−δ), from the tilt and the rate that meet on the path to the unstable equilibrium.
fn double_impulse(after: f64) -> f64 {
    rate() * CORNER_TILT * corner_inertia() / (BLOCK_MASS * H * (impact_ratio() + (-after).exp()))
}

/// Rate of rotation by an impulse of this velocity, over q b/h.
fn impulse_rate(velocity: f64) -> f64 {
    BLOCK_MASS * H * velocity / corner_inertia() / (rate() * CORNER_TILT)
}

/// Jumps of the ground's velocity by `velocity`, at the beginning and, back, a time `after` (over 1/q) after the impact.
fn jumps(velocity: f64, after: f64) -> Result<Record, AnyError> {
    let step = 5e-4;
    // The block starts with the rate Ω, turns where tanh t = Ω, and is back after twice this time.
    let second = nearest_integer((2.0 * impulse_rate(velocity).atanh() + after) / rate() / step);
    let mut samples = vec![0.0; second + 4];
    samples[1] = velocity / step;
    samples[second + 1] -= velocity / step;
    Ok(Record::new(step, samples)?)
}

/// Housner's rectangular pulse of `amplitude` (over g b/h), rising and falling within a sample, and `duration`, s.
fn rectangle(amplitude: f64, duration: f64) -> basemat::Result<Record> {
    const PULSE_SAMPLES: usize = 800;
    let mut samples = vec![amplitude * STANDARD_GRAVITY * CORNER_TILT; PULSE_SAMPLES + 2];
    samples[0] = 0.0;
    samples[PULSE_SAMPLES + 1] = 0.0;
    Record::new(duration / PULSE_SAMPLES as f64, samples)
}

/// Smallest durations of rectangular pulses that overturn the block, over Housner's.
fn rectangles(short: bool) -> Result<Vec<ValidationCheck>, AnyError> {
    let block = RockingBlock::new(B, H, STANDARD_GRAVITY)?;
    let mut checks = Vec::new();
    // Accelerations over g b/h, and limits on 200 and 50 m/s.
    let pulses = [
        (1.2, [0.75..=0.85, 0.48..=0.56]),
        (2.0, [0.87..=0.93, 0.66..=0.75]),
        (5.0, [0.91..=0.97, 0.77..=0.85]),
    ];
    for (x, limits) in pulses {
        // Housner's slender block has p and α where the block of small tilts has q and b/h.
        let slender_value = x * STANDARD_GRAVITY * block.slenderness_angle();
        let reference =
            block.overturning_pulse(slender_value)? * block.frequency_parameter() / rate();
        let name = format!("rectangle of {x} g b/h");
        let stiff_boundary = boundary(0.9 * reference, 0.03, 2e-4, |duration| {
            on_corners(1e-4, rectangle(x, duration)?)
        })? / reference;
        let label = format!("{name}, stiff ground: least duration, relative");
        checks.push(ValidationCheck::below(label, (stiff_boundary - 1.0).abs(), 2e-3));
        for (speed, limits) in [200.0, 50.0].into_iter().zip(limits) {
            if !short {
                let soft_boundary = boundary(0.4 * reference, 0.03, 2e-4, |duration| {
                    on_soil(speed, rectangle(x, duration)?)
                })? / reference;
                let label = format!("{name}, {speed} m/s: over that on rigid ground");
                checks.push(ValidationCheck::within(label, soft_boundary, limits));
            }
        }
    }
    Ok(checks)
}

fn run(short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut checks = rectangles(short)?;
    let mut expected = Vec::new();
    let mut stiff_points = Vec::new();
    let mut firm_points = Vec::new();
    let mut soft_points = Vec::new();
    let frequencies = if short { &PULSE_FREQUENCIES[1..4] } else { &PULSE_FREQUENCIES[..] };
    for &frequency in frequencies {
        let reference = boundary(1.0 + 1e-9, 2e-3, 1e-9, |a| Ok(overturned(a, frequency)))?;
        let computed =
            boundary(0.8 * reference, 0.03, 2e-4, |a| on_corners(1e-4, sine(a, frequency)?))?;
        let name = format!("sine of {frequency} q, stiff ground: least acceleration, relative");
        checks.push(ValidationCheck::below(name, (computed / reference - 1.0).abs(), 1e-2));
        expected.push((frequency, reference));
        stiff_points.push((frequency, computed));
        for (speed, limits, list) in
            [(200.0, 0.8..=1.0, &mut firm_points), (50.0, 0.5..=1.1, &mut soft_points)]
        {
            if short && speed == 50.0 {
                continue;
            }
            let computed =
                boundary(0.5 * reference, 0.04, 1e-3, |a| on_soil(speed, sine(a, frequency)?))?;
            let name = format!("sine of {frequency} q, {speed} m/s: over that on rigid ground");
            checks.push(ValidationCheck::within(name, computed / reference, limits));
            list.push((frequency, computed));
        }
    }
    let times: &[f64] = if short { &[0.2] } else { &[0.02, 0.2, 0.5] };
    for &after in times {
        let reference = double_impulse(after);
        let computed =
            boundary(0.9 * reference, 0.03, 2e-4, |v| on_corners(2e-5, jumps(v, after)?))?;
        let name = format!(
            "two impulses, the second {after}/q after the impact: least velocity, relative"
        );
        checks.push(ValidationCheck::below(name, (computed / reference - 1.0).abs(), 1e-2));
    }
    let panel = FigurePanel::new("frequency of the pulse over q", "least acceleration over g b/h")
        .legend(SeriesLabelPosition::UpperLeft)
        .reference("rigid ground, event by event", CURVE_RED, expected)
        .circles("basemat, two corners on a stiff bed", CURVE_BLUE, stiff_points)
        .line("half-plane, 200 m/s", CURVE_GREEN, firm_points)
        .line("half-plane, 50 m/s", CURVE_ORANGE, soft_points);
    let title = "One cycle of sine that just overturns a block of 1 m × 4 m, q = 1.9/s";
    Ok(ValidationOutcome { checks, figure: Figure::new(title, 1, vec![panel]) })
}
