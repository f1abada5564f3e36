//! GOAL: closed forms are in equilibrium, symmetric and right in their limits, and refuse bad
//! input.
//! SCENE: rocking and sliding blocks, tilted strips, line loads.
//! REFERENCE: statics, differential equations, integration in small steps.

use basemat::motion::{Record, SpectralOrdinate, el_centro_1940};
use basemat::reference::{
    NoTensionStrip, RigidStrip, RockingBlock, SlidingBlock, SlidingEstimate, UpliftLaw,
    WinklerStrip, flamant_horizontal_displacement, flamant_radial_stress,
    flamant_relative_settlement, hertz_plate_settlement, kelvin_relative_displacement,
    loaded_rectangle_settlement, pais_kausel_impedances,
};
use basemat::{Error, Soil};
use proptest::prelude::*;

use basemat_problems::close;

const BAD: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn soil() -> Soil {
    Soil::new(3.0, 0.3, 1.0).unwrap()
}

#[track_caller]
#[expect(clippy::needless_pass_by_value, reason = "takes results as they come")]
fn refused<T: std::fmt::Debug>(outcome: Result<T, Error>) {
    assert!(matches!(outcome, Err(Error::Input { .. })), "{outcome:?}");
}

#[test]
fn bad_inputs_are_refused() {
    let strip = NoTensionStrip::new(soil(), 2.0, 0.3).unwrap();
    let springs = WinklerStrip::new(1.0, 1.0).unwrap();
    for bad in BAD {
        refused(UpliftLaw::new(bad));
        refused(RockingBlock::new(bad, 1.0, 9.81));
        refused(RockingBlock::new(1.0, bad, 9.81));
        refused(RockingBlock::new(1.0, 2.0, bad));
        refused(SlidingBlock::new(bad, 9.81));
        refused(SlidingBlock::new(0.3, bad));
        refused(NoTensionStrip::new(soil(), bad, 0.0));
        refused(strip.contact(bad, 0.1));
        refused(strip.pressure(bad, 0.1, 0.0));
        refused(strip.moment(bad, 0.1));
        refused(WinklerStrip::new(bad, 1.0));
        refused(WinklerStrip::new(1.0, bad));
        refused(springs.uplift_tilt(bad));
        refused(springs.moment(bad, 0.1));
        refused(springs.contact_length(bad, 0.1));
        refused(RigidStrip::new(soil(), bad));
        refused(flamant_relative_settlement(soil(), 1.0, bad, 1.0));
        refused(flamant_relative_settlement(soil(), 1.0, 1.0, bad));
        refused(flamant_radial_stress(1.0, bad, 0.0));
        refused(kelvin_relative_displacement(soil(), [1.0, 0.0], [1.0, 0.0], bad));
    }
    refused(SlidingBlock::new(1e-200, 1e-200));
    for bad in &BAD[2..] {
        refused(NoTensionStrip::new(soil(), 1.0, *bad));
        refused(strip.contact(1.0, *bad));
        refused(strip.pressure(1.0, 0.0, *bad));
        refused(strip.moment(1.0, *bad));
        refused(springs.moment(1.0, *bad));
        refused(springs.contact_length(1.0, *bad));
        refused(flamant_relative_settlement(soil(), *bad, 1.0, 2.0));
        refused(flamant_horizontal_displacement(soil(), *bad, 1.0));
        refused(flamant_horizontal_displacement(soil(), 1.0, *bad));
        refused(flamant_radial_stress(*bad, 1.0, 0.0));
        refused(flamant_radial_stress(1.0, 1.0, *bad));
        refused(kelvin_relative_displacement(soil(), [*bad, 0.0], [1.0, 0.0], 1.0));
        refused(kelvin_relative_displacement(soil(), [0.0, *bad], [1.0, 0.0], 1.0));
        refused(kelvin_relative_displacement(soil(), [1.0, 0.0], [*bad, 0.0], 1.0));
    }
    for eccentricity in [2.0, -2.0, 5.0] {
        refused(strip.contact(1.0, eccentricity));
    }
    refused(kelvin_relative_displacement(soil(), [1.0, 0.0], [0.0, 0.0], 1.0));
}

#[test]
fn rocking_amplitudes_out_of_range_are_refused() {
    let block = RockingBlock::new(0.5, 2.0, 9.81).unwrap();
    for bad in BAD.into_iter().chain([block.slenderness_angle(), 1.0]) {
        refused(block.period(bad));
        refused(block.period_slender(bad));
        refused(block.next_peak(bad));
        refused(block.next_peak_slender(bad));
        refused(block.impact_rate(bad));
        refused(block.impact_times(bad, 3));
    }
    // sin² α = 0.8: the block stops at its first impact
    refused(RockingBlock::new(2.0, 1.0, 9.81).unwrap().impact_times(0.1, 3));
}

/// The exact forms tend to Housner's for slender blocks and small tilts, with all digits left.
#[test]
fn slender_blocks_rock_as_housner_says() {
    let block = RockingBlock::new(1e-3, 1.0, 9.81).unwrap();
    for ratio in [1e-12, 1e-6, 0.1, 0.5, 0.9, 0.999] {
        let amplitude = ratio * block.slenderness_angle();
        let (exact, slender) =
            (block.period(amplitude).unwrap(), block.period_slender(amplitude).unwrap());
        close("period", exact, slender, 0.0, 1e-6);
        let (exact, slender) =
            (block.next_peak(amplitude).unwrap(), block.next_peak_slender(amplitude).unwrap());
        close("peak", exact, slender, 0.0, 1e-5);
        // p θ₀-pendulum: rate at impact p √(α² − (α − θ₀)²)
        let (alpha, p) = (block.slenderness_angle(), block.frequency_parameter());
        let rate = p * (amplitude * (2.0 * alpha - amplitude)).sqrt();
        close("rate", block.impact_rate(amplitude).unwrap(), rate, 0.0, 1e-6);
    }
}

/// The uplift law with α = 6 is the strip on springs, with α = 4 the smooth strip on the half-plane.
#[test]
fn uplift_laws_are_exact_on_springs_and_on_the_half_plane() {
    let load = 1.3;
    let (springs, strip) =
        (WinklerStrip::new(0.7, 2.0).unwrap(), NoTensionStrip::new(soil(), 2.0, 0.0).unwrap());
    let (on_springs, on_soil) = (UpliftLaw::new(6.0).unwrap(), UpliftLaw::new(4.0).unwrap());
    let first = springs.uplift_tilt(load).unwrap();
    let stiffness = RigidStrip::new(soil(), 2.0).unwrap().smooth_rocking_stiffness();
    for rotation in [0.3, 1.0, 1.2, 3.0, 20.0] {
        let moment = springs.moment(load, rotation * first).unwrap();
        let known = on_springs.moment_ratio(rotation).unwrap() * load * 4.0 / 6.0;
        close("springs", moment, known, 1e-14, 0.0);
        let length = springs.contact_length(load, rotation * first).unwrap();
        close("contact", length / 4.0, on_springs.contact_ratio(rotation).unwrap(), 1e-14, 0.0);

        let tilt = rotation * load * 4.0 / 4.0 / stiffness;
        let moment = strip.moment(load, tilt).unwrap();
        let known = on_soil.moment_ratio(rotation).unwrap() * load * 4.0 / 4.0;
        close("half-plane", moment, known, 1e-14, 0.0);
        let length = strip.contact(load, -moment / load).unwrap().length();
        close("contact", length / 4.0, on_soil.contact_ratio(rotation).unwrap(), 1e-14, 0.0);
    }
    for bad in [2.0, 1.9] {
        refused(UpliftLaw::new(bad));
    }
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        refused(on_soil.moment_ratio(bad));
        refused(on_soil.contact_ratio(bad));
    }
}

/// Spectra of constant displacement give it back; of constant velocity v, the slip v²/(2 μₑ g) of a block whose ground
/// jumps to this velocity.
#[test]
fn slip_of_a_spectrum_is_that_of_a_velocity_pulse() {
    let spectrum = |power: i32, value: f64| -> Vec<SpectralOrdinate> {
        let periods = (1..=60).map(|k| 0.1 * f64::from(k));
        let ordinate = |period: f64| {
            let acceleration = value * (std::f64::consts::TAU / period).powi(power);
            SpectralOrdinate {
                period,
                displacement: f64::NAN,
                pseudo_velocity: f64::NAN,
                pseudo_acceleration: acceleration,
                acceleration: f64::NAN,
            }
        };
        periods.map(ordinate).collect()
    };
    let estimate = SlidingEstimate::new(0.3, 2.5, 10.0).unwrap();
    close("c", estimate.spectral_acceleration(), 2.0 * 0.3 * 0.9 * 10.0, 1e-14, 0.0);
    let slip = |list: &[SpectralOrdinate]| estimate.slip(list).unwrap();
    close("displacement", slip(&spectrum(2, 0.4)).unwrap(), 0.4, 1e-14, 0.0);
    // A jump of the velocity: one sample of acceleration.
    let (velocity, step) = (1.3, 1e-5);
    let jump = Record::new(step, vec![0.0, velocity / step, 0.0]).unwrap();
    let pushed = SlidingBlock::new(0.3 * 0.9, 10.0).unwrap().slide(&jump).minimum();
    close("velocity", slip(&spectrum(1, velocity)).unwrap(), -pushed, 0.0, 1e-4);
    // The longest period of several counts.
    let mut twice = spectrum(2, 0.4);
    twice[1].pseudo_acceleration = 0.1;
    close("last", slip(&twice).unwrap(), 0.4, 1e-14, 0.0);
    assert_eq!(slip(&spectrum(0, 1.0)), None);

    refused(estimate.slip(&spectrum(0, 6.0)));
    for bad in BAD {
        refused(SlidingEstimate::new(bad, 0.0, 9.81));
        refused(SlidingEstimate::new(0.3, 0.0, bad));
        let mut list = spectrum(2, 0.4);
        list[7].pseudo_acceleration = bad;
        refused(estimate.slip(&list));
        list = spectrum(2, 0.4);
        list[7].period = bad;
        refused(estimate.slip(&list));
    }
    for bad in [-0.1, 25.0, f64::NAN, f64::INFINITY] {
        refused(SlidingEstimate::new(0.3, bad, 10.0));
    }
    assert!(estimate.slip(&spectrum(2, 0.4)[..1]).is_err());
}

/// ∫ f dx over the contact, by a substitution that tames both ends.
fn integral(strip: &NoTensionStrip, eccentricity: f64, weight: impl Fn(f64) -> f64) -> f64 {
    let contact = strip.contact(5.0, eccentricity).unwrap();
    let (middle, half) = (f64::midpoint(contact.left, contact.right), contact.length() / 2.0);
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
            close("load", integral(&strip, eccentricity, |_| 1.0), 5.0, 1e-5, 0.0);
            close("moment", integral(&strip, eccentricity, |x| x), 5.0 * eccentricity, 1e-5, 0.0);
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
        let (a, b) =
            (right.contact(1.0, eccentricity).unwrap(), left.contact(1.0, -eccentricity).unwrap());
        close("tilt", a.tilt, -b.tilt, 1e-15, 1e-14);
        close("left", a.left, -b.right, 1e-14, 0.0);
    }
    // small tilts: the smooth strip is as stiff as the static limit says
    let smooth = NoTensionStrip::new(soil(), 2.0, 0.0).unwrap();
    let stiffness = RigidStrip::new(soil(), 2.0).unwrap().smooth_rocking_stiffness();
    close("stiffness", smooth.moment(1.0, 1e-3).unwrap(), 1e-3 * stiffness, 0.0, 1e-13);
}

/// Flamant: the radial stress carries the load, and the surface slope is in proportion to it.
#[test]
fn line_loads_satisfy_equilibrium() {
    // radial stress over a half circle carries the load
    let (count, radius, load) = (1000, 0.7, 3.0);
    let step = std::f64::consts::PI / f64::from(count);
    let carried: f64 = (0..count)
        .map(|k| {
            let angle = (f64::from(k) + 0.5) * step - std::f64::consts::FRAC_PI_2;
            let stress = flamant_radial_stress(load, radius, angle).unwrap();
            -stress * angle.cos() * radius * step
        })
        .sum();
    close("load", carried, load, 1e-12, 0.0);
    // slope of the surface (1−ν)P/(πμr), stress under the load −2P/(πr)
    let settlement = flamant_relative_settlement(soil(), load, 1.0, 1.0 + 1e-6).unwrap();
    let slope = -(1.0 - 0.3) / (2.0 * 3.0) * flamant_radial_stress(load, 1.0, 0.0).unwrap();
    close("slope", settlement / 1e-6, slope, 0.0, 1e-6);
    assert_eq!(flamant_horizontal_displacement(soil(), 1.0, 0.0).unwrap(), 0.0);
}

/// The settlement under a loaded rectangle is a sum of point loads, by rays from a point inside and by cells outside.
#[test]
fn loaded_rectangles_settle_as_point_loads_do() {
    let unit = (1.0 - 0.3) / (2.0 * std::f64::consts::PI * 3.0);
    let settled = |point| loaded_rectangle_settlement(soil(), 5.0, [2.0, 3.0], point).unwrap();
    for [x, y] in [[0.0, 0.0], [0.3, -1.1], [-0.9, 1.4]] {
        // ∫ dA/r is the mean length of the rays to the outline, times 2π.
        let count = 400_000;
        let ray = |k: i32| {
            let (sine, cosine) =
                (std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(count)).sin_cos();
            ((1.0_f64.copysign(cosine) - x) / cosine).min((1.5_f64.copysign(sine) - y) / sine)
        };
        let rays: f64 = (0..count).map(ray).sum();
        let wanted = 5.0 * unit * rays * std::f64::consts::TAU / f64::from(count);
        close("inside", settled([x, y]), wanted, 0.0, 1e-9);
    }
    for [x, y] in [[2.0, 0.0], [1.5, -3.0], [0.2, 2.5]] {
        let count = 400;
        let cell = |i: i32, j: i32| {
            let along = 2.0 * (f64::from(i) + 0.5) / f64::from(count) - 1.0;
            let away = 3.0 * (f64::from(j) + 0.5) / f64::from(count) - 1.5;
            1.0 / (along - x).hypot(away - y)
        };
        let sum: f64 = (0..count).flat_map(|i| (0..count).map(move |j| cell(i, j))).sum();
        let wanted = 5.0 * unit * sum * 6.0 / f64::from(count * count);
        close("outside", settled([x, y]), wanted, 0.0, 1e-5);
    }
    for bad in BAD {
        refused(loaded_rectangle_settlement(soil(), 1.0, [1.0, bad], [0.0; 2]));
        if !bad.is_finite() {
            refused(loaded_rectangle_settlement(soil(), bad, [1.0; 2], [0.0; 2]));
            refused(loaded_rectangle_settlement(soil(), 1.0, [1.0; 2], [0.0, bad]));
        }
    }
}

/// Kelvin's solution satisfies Navier's equation (by differences) and reciprocity.
#[test]
fn kelvin_satisfies_navier() {
    let (h, point) = (1e-3, [0.8, -0.5]);
    let u = |x: f64, y: f64| kelvin_relative_displacement(soil(), [1.0, 2.0], [x, y], 1.0).unwrap();
    let [x, y] = point;
    let (xx, yy, c) = ([u(x + h, y), u(x - h, y)], [u(x, y + h), u(x, y - h)], u(x, y));
    let cross: [f64; 2] = std::array::from_fn(|i| {
        (u(x + h, y + h)[i] - u(x + h, y - h)[i] - u(x - h, y + h)[i] + u(x - h, y - h)[i])
            / (4.0 * h * h)
    });
    let second = |pair: [[f64; 2]; 2], i: usize| (pair[0][i] - 2.0 * c[i] + pair[1][i]) / (h * h);
    // ∇²u + ∇(∇·u)/(1−2ν) = 0
    let factor = 1.0 / (1.0 - 0.6);
    let first = second(xx, 0) + second(yy, 0) + factor * (second(xx, 0) + cross[1]);
    let other = second(xx, 1) + second(yy, 1) + factor * (second(yy, 1) + cross[0]);
    assert!(first.abs() < 1e-5 && other.abs() < 1e-5, "{first:e} {other:e}");
    let along = |f: [f64; 2]| kelvin_relative_displacement(soil(), f, point, 1.0).unwrap();
    assert_eq!(along([1.0, 0.0])[1], along([0.0, 1.0])[0]);
}

/// Slip by small explicit steps.
fn slip_by_steps(record: &Record, yield_acceleration: f64, substeps: u32) -> f64 {
    let step = record.time_step() / f64::from(substeps);
    let (mut slip, mut velocity, mut time) = (0.0, 0.0_f64, 0.0);
    while time < record.duration() + 60.0 {
        let ground = record.at(time + step / 2.0).acceleration;
        let push = velocity - ground * step;
        // friction stops the block within the step if it can
        let next = push - push.signum() * push.abs().min(yield_acceleration * step);
        slip += step * f64::midpoint(velocity, next);
        velocity = next;
        time += step;
    }
    slip
}

#[test]
fn sliding_agrees_with_small_steps() {
    let record = el_centro_1940();
    for friction in [0.02, 0.13] {
        let history = SlidingBlock::new(friction, 9.81).unwrap().slide(&record);
        let found = slip_by_steps(&record, friction * 9.81, 400);
        close("residual", history.residual(), found, 2e-5, 0.0);
    }
}

proptest! {
    #[test]
    fn sliding_mirrors_scales_and_ends_at_rest(
        values in prop::collection::vec(prop_oneof![Just(0.0), Just(1.0), -4.0..4.0_f64], 2..40),
        factor in 0.1..10.0_f64,
    ) {
        let record = Record::new(0.5, values).unwrap();
        let history = SlidingBlock::new(0.1, 10.0).unwrap().slide(&record);
        let mirror = SlidingBlock::new(0.1, 10.0).unwrap().slide(&record.scaled(-1.0).unwrap());
        prop_assert!((history.residual() + mirror.residual()).abs() < 1e-10);
        prop_assert!((history.maximum() + mirror.minimum()).abs() < 1e-10);
        let larger =
            SlidingBlock::new(0.1, 10.0 * factor).unwrap().slide(&record.scaled(factor).unwrap());
        let scale = history.maximum().max(-history.minimum()).max(1.0);
        let error = larger.residual() - factor * history.residual();
        prop_assert!(error.abs() < 1e-9 * scale * factor, "{}", error);
        prop_assert_eq!(history.slip_velocity(1e4), 0.0);
        prop_assert_eq!(history.slip(1e4), history.residual());
        prop_assert!(history.minimum() <= history.residual());
        prop_assert!(history.maximum() >= history.residual());
        // slip and velocity are continuous, and stay within the extremes
        let most = record.peaks().acceleration + 1.0;
        for k in 0..2000 {
            let time = f64::from(k) * 0.01;
            let jump = history.slip_velocity(time + 0.01) - history.slip_velocity(time);
            prop_assert!(jump.abs() <= 0.01 * most + 1e-9);
            let slip = history.slip(time);
            prop_assert!(slip >= history.minimum() - 1e-9 && slip <= history.maximum() + 1e-9);
        }
    }
}

/// Waves on an infinite plate on springs, summed: ∫ P κ dκ/(2π (D κ⁴ + k)), with κ = l⁻¹ tan φ, l⁴ = D/k.
#[test]
fn hertz_plates_settle_as_their_waves_do() {
    for (force, rigidity, bed) in [(3.0, 2.0, 5.0), (-1.0, 1e9, 2e7)] {
        let per_length = f64::powf(bed / rigidity, 0.25);
        let count = 20_000;
        let sum: f64 = (0..count)
            .map(|n| {
                let angle = 0.5 * std::f64::consts::PI * (f64::from(n) + 0.5) / f64::from(count);
                let wave = per_length * angle.tan();
                wave / (rigidity * wave.powi(4) + bed) * per_length / angle.cos().powi(2)
            })
            .sum();
        let known = force * sum / (4.0 * f64::from(count));
        close("plate", hertz_plate_settlement(force, rigidity, bed).unwrap(), known, 0.0, 1e-7);
    }
    for bad in BAD {
        refused(hertz_plate_settlement(1.0, bad, 1.0));
        refused(hertz_plate_settlement(1.0, 1.0, bad));
    }
    refused(hertz_plate_settlement(f64::NAN, 1.0, 1.0));
}

/// At high frequency a rigid base sends plane waves down: dashpots ρ c per area; rocking springs fall, all grow with the sides.
#[test]
fn rectangles_of_pais_and_kausel_send_plane_waves_at_high_frequency() {
    let frequency = 1e4;
    for ([width, length], poisson) in [([2.0, 2.0], 0.25), ([3.0, 7.5], 0.1), ([1.0, 4.0], 0.45)] {
        let soil = Soil::new(3.0, poisson, 1.7).unwrap();
        let found = pais_kausel_impedances(soil, [width, length], frequency).unwrap();
        let at_rest = pais_kausel_impedances(soil, [width, length], 0.0).unwrap();
        let waves = std::f64::consts::TAU * frequency * soil.density();
        let [shear, pressure] = [soil.shear_wave_speed(), soil.pressure_wave_speed()];
        // Lysmer's and Gazetas' limit for nearly incompressible soil.
        let pressure = pressure.min(2.5 * shear);
        let known = [width * length * shear, width * length * shear, width * length * pressure];
        for (own, known) in found.iter().zip(known) {
            close("dashpot", own.im, waves * known, 0.0, 1e-12);
        }
        let second = length * width.powi(3) / 12.0;
        close("rocking", found[3].im, waves * second * pressure, 0.0, 1e-6);
        assert!(found[3].re < 0.5 * at_rest[3].re && at_rest.iter().all(|own| own.im == 0.0));
        // Stiffer along the shorter side, and less than n squares beside each other.
        let square = pais_kausel_impedances(soil, [width, width], 0.0).unwrap();
        let count = length / width;
        assert!(at_rest[0].re >= at_rest[1].re);
        for (own, square) in at_rest.iter().zip(square) {
            assert!((square.re..=count * square.re).contains(&own.re), "{own:?} {square:?}");
        }
    }
    for bad in BAD {
        refused(pais_kausel_impedances(soil(), [bad, 1.0], 1.0));
        refused(pais_kausel_impedances(soil(), [1.0, bad], 1.0));
    }
    refused(pais_kausel_impedances(soil(), [2.0, 1.9], 1.0));
    refused(pais_kausel_impedances(soil(), [1.0, 2.0], -1.0));
    refused(pais_kausel_impedances(soil(), [1.0, 2.0], f64::NAN));
}
