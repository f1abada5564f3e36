//! GOAL: closed forms of blocks and strips are in equilibrium, symmetric and exact in their limits, and return errors
//! for invalid input.
//! SCENE: rocking and sliding blocks, tilted strips.
//! REFERENCE: statics, differential equations, integration in small steps.

use basemat::motion::{Record, SpectralOrdinate, el_centro_1940};
use basemat::reference::{
    NoTensionStrip, RigidStrip, RockingBlock, SlidingBlock, SlidingEstimate, UpliftLaw,
    WinklerStrip,
};
use basemat::{Error, Soil};
use proptest::prelude::*;

use basemat_problems::assert_close;

pub(super) const INVALID_NUMBERS: [f64; 5] =
    [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

pub(super) fn soil() -> Soil {
    Soil::new(3.0, 0.3, 1.0).unwrap()
}

#[track_caller]
#[expect(clippy::needless_pass_by_value, reason = "accepts results by value")]
pub(super) fn assert_is_error<T: std::fmt::Debug>(outcome: Result<T, Error>) {
    assert!(matches!(outcome, Err(Error::Input { .. })), "{outcome:?}");
}

#[test]
fn invalid_inputs_are_errors() {
    let strip = NoTensionStrip::new(soil(), 2.0, 0.3).unwrap();
    let springs = WinklerStrip::new(1.0, 1.0).unwrap();
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(UpliftLaw::new(invalid_value));
        assert_is_error(RockingBlock::new(invalid_value, 1.0, 9.81));
        assert_is_error(RockingBlock::new(1.0, invalid_value, 9.81));
        assert_is_error(RockingBlock::new(1.0, 2.0, invalid_value));
        assert_is_error(SlidingBlock::new(invalid_value, 9.81));
        assert_is_error(SlidingBlock::new(0.3, invalid_value));
        assert_is_error(NoTensionStrip::new(soil(), invalid_value, 0.0));
        assert_is_error(strip.contact(invalid_value, 0.1));
        assert_is_error(strip.pressure(invalid_value, 0.1, 0.0));
        assert_is_error(strip.moment(invalid_value, 0.1));
        assert_is_error(WinklerStrip::new(invalid_value, 1.0));
        assert_is_error(WinklerStrip::new(1.0, invalid_value));
        assert_is_error(springs.uplift_tilt(invalid_value));
        assert_is_error(springs.moment(invalid_value, 0.1));
        assert_is_error(springs.contact_length(invalid_value, 0.1));
        assert_is_error(RigidStrip::new(soil(), invalid_value));
    }
    assert_is_error(SlidingBlock::new(1e-200, 1e-200));
    for invalid_value in &INVALID_NUMBERS[2..] {
        assert_is_error(NoTensionStrip::new(soil(), 1.0, *invalid_value));
        assert_is_error(strip.contact(1.0, *invalid_value));
        assert_is_error(strip.pressure(1.0, 0.0, *invalid_value));
        assert_is_error(strip.moment(1.0, *invalid_value));
        assert_is_error(springs.moment(1.0, *invalid_value));
        assert_is_error(springs.contact_length(1.0, *invalid_value));
    }
    for eccentricity in [2.0, -2.0, 5.0] {
        assert_is_error(strip.contact(1.0, eccentricity));
    }
}

#[test]
fn rocking_amplitudes_out_of_range_are_errors() {
    let block = RockingBlock::new(0.5, 2.0, 9.81).unwrap();
    for invalid_value in INVALID_NUMBERS.into_iter().chain([block.slenderness_angle(), 1.0]) {
        assert_is_error(block.period(invalid_value));
        assert_is_error(block.period_slender(invalid_value));
        assert_is_error(block.next_peak(invalid_value));
        assert_is_error(block.next_peak_slender(invalid_value));
        assert_is_error(block.impact_rate(invalid_value));
        assert_is_error(block.impact_times(invalid_value, 3));
    }
    // sin² α = 0.8: the block stops at its first impact
    assert_is_error(RockingBlock::new(2.0, 1.0, 9.81).unwrap().impact_times(0.1, 3));
}

/// The exact forms tend to Housner's for slender blocks and small tilts, without loss of digits.
#[test]
fn slender_blocks_have_the_periods_and_peaks_of_housner() {
    let block = RockingBlock::new(1e-3, 1.0, 9.81).unwrap();
    for ratio in [1e-12, 1e-6, 0.1, 0.5, 0.9, 0.999] {
        let amplitude = ratio * block.slenderness_angle();
        let expected = block.period(amplitude).unwrap();
        let slender_period = block.period_slender(amplitude).unwrap();
        assert_close("period", expected, slender_period, 0.0, 1e-6);
        let expected = block.next_peak(amplitude).unwrap();
        let slender_period = block.next_peak_slender(amplitude).unwrap();
        assert_close("peak", expected, slender_period, 0.0, 1e-5);
        // p θ₀-pendulum: rate at impact p √(α² − (α − θ₀)²)
        let alpha = block.slenderness_angle();
        let p = block.frequency_parameter();
        let rate = p * (amplitude * (2.0 * alpha - amplitude)).sqrt();
        assert_close("rate", block.impact_rate(amplitude).unwrap(), rate, 0.0, 1e-6);
    }
}

/// The uplift law with α = 6 is the strip on springs, with α = 4 the frictionless strip on the half-plane.
#[test]
fn uplift_laws_are_exact_on_springs_and_on_the_half_plane() {
    let load = 1.3;
    let springs = WinklerStrip::new(0.7, 2.0).unwrap();
    let strip = NoTensionStrip::new(soil(), 2.0, 0.0).unwrap();
    let on_springs = UpliftLaw::new(6.0).unwrap();
    let on_soil = UpliftLaw::new(4.0).unwrap();
    let first = springs.uplift_tilt(load).unwrap();
    let stiffness = RigidStrip::new(soil(), 2.0).unwrap().smooth_rocking_stiffness();
    for rotation in [0.3, 1.0, 1.2, 3.0, 20.0] {
        let moment = springs.moment(load, rotation * first).unwrap();
        let expected = on_springs.moment_ratio(rotation).unwrap() * load * 4.0 / 6.0;
        assert_close("springs", moment, expected, 1e-14, 0.0);
        let length = springs.contact_length(load, rotation * first).unwrap();
        assert_close(
            "contact",
            length / 4.0,
            on_springs.contact_ratio(rotation).unwrap(),
            1e-14,
            0.0,
        );

        let tilt = rotation * load * 4.0 / 4.0 / stiffness;
        let moment = strip.moment(load, tilt).unwrap();
        let expected = on_soil.moment_ratio(rotation).unwrap() * load * 4.0 / 4.0;
        assert_close("half-plane", moment, expected, 1e-14, 0.0);
        let length = strip.contact(load, -moment / load).unwrap().length();
        assert_close("contact", length / 4.0, on_soil.contact_ratio(rotation).unwrap(), 1e-14, 0.0);
    }
    for invalid_value in [2.0, 1.9] {
        assert_is_error(UpliftLaw::new(invalid_value));
    }
    for invalid_value in [-0.1, f64::NAN, f64::INFINITY] {
        assert_is_error(on_soil.moment_ratio(invalid_value));
        assert_is_error(on_soil.contact_ratio(invalid_value));
    }
}

/// Spectrum from 0.1 to 6 s whose pseudo-acceleration is `value` (2π/T)ᵖᵒʷᵉʳ.
fn power_spectrum(power: i32, value: f64) -> Vec<SpectralOrdinate> {
    let mut spectrum = Vec::new();
    for k in 1..=60 {
        let period = 0.1 * f64::from(k);
        spectrum.push(SpectralOrdinate {
            period,
            displacement: f64::NAN,
            pseudo_velocity: f64::NAN,
            pseudo_acceleration: value * (std::f64::consts::TAU / period).powi(power),
            acceleration: f64::NAN,
        });
    }
    spectrum
}

/// Of spectra of constant displacement the slip is that displacement; of constant velocity v it is the slip v²/(2 μₑ g)
/// of a block whose ground jumps to this velocity.
#[test]
fn slip_of_a_spectrum_is_that_of_a_velocity_pulse() {
    let estimate = SlidingEstimate::new(0.3, 2.5, 10.0).unwrap();
    assert_close("c", estimate.spectral_acceleration(), 2.0 * 0.3 * 0.9 * 10.0, 1e-14, 0.0);
    let slip = estimate.slip(&power_spectrum(2, 0.4)).unwrap().unwrap();
    assert_close("displacement", slip, 0.4, 1e-14, 0.0);
    // A jump of the velocity: one sample of acceleration.
    let velocity = 1.3;
    let step = 1e-5;
    let jump = Record::new(step, vec![0.0, velocity / step, 0.0]).unwrap();
    let block_slip = SlidingBlock::new(0.3 * 0.9, 10.0).unwrap().slide(&jump).minimum();
    let slip = estimate.slip(&power_spectrum(1, velocity)).unwrap().unwrap();
    assert_close("velocity", slip, -block_slip, 0.0, 1e-4);
    // The longest of several periods is decisive.
    let mut spectrum = power_spectrum(2, 0.4);
    spectrum[1].pseudo_acceleration = 0.1;
    assert_close("last", estimate.slip(&spectrum).unwrap().unwrap(), 0.4, 1e-14, 0.0);
    assert_eq!(estimate.slip(&power_spectrum(0, 1.0)).unwrap(), None);

    assert_is_error(estimate.slip(&power_spectrum(0, 6.0)));
    for invalid_value in INVALID_NUMBERS {
        assert_is_error(SlidingEstimate::new(invalid_value, 0.0, 9.81));
        assert_is_error(SlidingEstimate::new(0.3, 0.0, invalid_value));
        let mut list = power_spectrum(2, 0.4);
        list[7].pseudo_acceleration = invalid_value;
        assert_is_error(estimate.slip(&list));
        list = power_spectrum(2, 0.4);
        list[7].period = invalid_value;
        assert_is_error(estimate.slip(&list));
    }
    for invalid_value in [-0.1, 25.0, f64::NAN, f64::INFINITY] {
        assert_is_error(SlidingEstimate::new(0.3, invalid_value, 10.0));
    }
    assert!(estimate.slip(&power_spectrum(2, 0.4)[..1]).is_err());
}

/// ∫ f dx over the contact, by a substitution that removes the singularities at both ends.
fn integral(strip: &NoTensionStrip, eccentricity: f64, weight: impl Fn(f64) -> f64) -> f64 {
    let contact = strip.contact(5.0, eccentricity).unwrap();
    let middle = f64::midpoint(contact.left, contact.right);
    let half = contact.length() / 2.0;
    let count = 4000;
    let mut sum = 0.0;
    for k in 0..count {
        let t = (f64::from(k) + 0.5) / f64::from(count);
        let angle = std::f64::consts::PI * t.powi(3) * (10.0 - 15.0 * t + 6.0 * t * t);
        let rate = std::f64::consts::PI * 30.0 * (t * (1.0 - t)).powi(2);
        let x = middle - half * angle.cos();
        if x > contact.left && x < contact.right {
            let pressure = strip.pressure(5.0, eccentricity, x).unwrap();
            assert!(pressure >= 0.0, "{pressure} at {x}");
            sum += pressure * weight(x) * half * angle.sin() * rate / f64::from(count);
        }
    }
    sum
}

#[test]
fn pressure_of_the_tilted_strip_balances_its_load() {
    for friction in [0.0, 0.6, -0.6] {
        let strip = NoTensionStrip::new(soil(), 2.0, friction).unwrap();
        for eccentricity in [-1.8, -1.0, -0.4, 0.0, 0.7, 1.1, 1.9] {
            assert_close("load", integral(&strip, eccentricity, |_| 1.0), 5.0, 1e-5, 0.0);
            assert_close(
                "moment",
                integral(&strip, eccentricity, |x| x),
                5.0 * eccentricity,
                1e-5,
                0.0,
            );
        }
        assert_eq!(strip.pressure(5.0, 1.9, -1.0).unwrap(), 0.0);
        assert_eq!(strip.pressure(5.0, 1.9, 2.5).unwrap(), 0.0);
        assert_eq!(strip.pressure(5.0, 0.0, 2.0).unwrap(), f64::INFINITY);
    }
}

#[test]
fn mirrored_strips_tilt_the_other_way() {
    let right = NoTensionStrip::new(soil(), 2.0, 0.6).unwrap();
    let left = NoTensionStrip::new(soil(), 2.0, -0.6).unwrap();
    for eccentricity in [-1.8, -0.9, 0.0, 0.3, 1.2, 1.9] {
        let a = right.contact(1.0, eccentricity).unwrap();
        let b = left.contact(1.0, -eccentricity).unwrap();
        assert_close("tilt", a.tilt, -b.tilt, 1e-15, 1e-14);
        assert_close("left", a.left, -b.right, 1e-14, 0.0);
    }
    // at small tilts the frictionless strip has the stiffness of the static limit
    let frictionless_strip = NoTensionStrip::new(soil(), 2.0, 0.0).unwrap();
    let stiffness = RigidStrip::new(soil(), 2.0).unwrap().smooth_rocking_stiffness();
    assert_close(
        "stiffness",
        frictionless_strip.moment(1.0, 1e-3).unwrap(),
        1e-3 * stiffness,
        0.0,
        1e-13,
    );
}

/// Slip by small explicit steps.
fn slip_by_steps(record: &Record, yield_acceleration: f64, substeps: u32) -> f64 {
    let step = record.time_step() / f64::from(substeps);
    let mut slip = 0.0;
    let mut velocity = 0.0_f64;
    let mut time = 0.0;
    while time < record.duration() + 60.0 {
        let ground = record.at(time + step / 2.0).acceleration;
        let push = velocity - ground * step;
        // friction stops the block within the step if it can
        let next_velocity = push - push.signum() * push.abs().min(yield_acceleration * step);
        slip += step * f64::midpoint(velocity, next_velocity);
        velocity = next_velocity;
        time += step;
    }
    slip
}

#[test]
fn slip_agrees_with_integration_in_small_steps() {
    let record = el_centro_1940();
    for friction in [0.02, 0.13] {
        let slide = SlidingBlock::new(friction, 9.81).unwrap().slide(&record);
        let computed = slip_by_steps(&record, friction * 9.81, 400);
        assert_close("residual", slide.residual(), computed, 2e-5, 0.0);
    }
}

proptest! {
    #[test]
    fn slip_is_mirrored_and_scaled_with_the_record_and_ends_at_rest(
        values in prop::collection::vec(prop_oneof![Just(0.0), Just(1.0), -4.0..4.0_f64], 2..40),
        factor in 0.1..10.0_f64,
    ) {
        let record = Record::new(0.5, values).unwrap();
        let slide = SlidingBlock::new(0.1, 10.0).unwrap().slide(&record);
        let mirror = SlidingBlock::new(0.1, 10.0).unwrap().slide(&record.scaled(-1.0).unwrap());
        prop_assert!((slide.residual() + mirror.residual()).abs() < 1e-10);
        prop_assert!((slide.maximum() + mirror.minimum()).abs() < 1e-10);
        let larger_slip =
            SlidingBlock::new(0.1, 10.0 * factor).unwrap().slide(&record.scaled(factor).unwrap());
        let scale = slide.maximum().max(-slide.minimum()).max(1.0);
        let error = larger_slip.residual() - factor * slide.residual();
        prop_assert!(error.abs() < 1e-9 * scale * factor, "{}", error);
        prop_assert_eq!(slide.slip_velocity(1e4), 0.0);
        prop_assert_eq!(slide.slip(1e4), slide.residual());
        prop_assert!(slide.minimum() <= slide.residual());
        prop_assert!(slide.maximum() >= slide.residual());
        // slip and velocity are continuous, and stay within the extremes
        let largest_acceleration = record.peaks().acceleration + 1.0;
        for k in 0..2000 {
            let time = f64::from(k) * 0.01;
            let jump = slide.slip_velocity(time + 0.01) - slide.slip_velocity(time);
            prop_assert!(jump.abs() <= 0.01 * largest_acceleration + 1e-9);
            let slip = slide.slip(time);
            prop_assert!(slip >= slide.minimum() - 1e-9 && slip <= slide.maximum() + 1e-9);
        }
    }
}
