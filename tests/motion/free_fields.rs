//! GOAL: free fields, their velocities and stresses agree with their source.
//! SCENE: El Centro in one and two components, functions, Ricker pulses.
//! REFERENCE: the source itself, and closed-form derivatives.

use basemat::Soil;
use basemat::bem::full_plane::{IncidentField, VerticalWaves};
use basemat::motion::{
    AtRest, FreeField, FreeFieldFn, RickerDisplacement, VerticalIncidence, el_centro_1940,
};

use basemat_problems::assert_close;

/// GOAL: displacements and velocities of free fields are those of their records and functions.
#[test]
fn free_fields_agree_with_their_sources() {
    let record = el_centro_1940();
    let vertical = record.scaled(-0.5).unwrap().resampled(0.03).unwrap();
    let both =
        VerticalIncidence { horizontal: Some(record.clone()), vertical: Some(vertical.clone()) };
    let only_vertical = VerticalIncidence { horizontal: None, vertical: Some(vertical.clone()) };
    let from_record = VerticalIncidence::from(record.clone());
    for k in -10..3000 {
        let time = f64::from(k) * 0.0123;
        let u = record.at(time).displacement;
        let w = vertical.at(time).displacement;
        assert_eq!(both.displacement(1e3, time), [u, w]);
        assert_eq!(only_vertical.displacement(0.0, time), [0.0, w]);
        assert_eq!(from_record.displacement(0.0, time), [u, 0.0]);
        assert_eq!(record.displacement(0.0, time), [u, 0.0]);
        assert_eq!(record.velocity(0.0, time), [record.at(time).velocity, 0.0]);
        let velocity = [record.at(time).velocity, vertical.at(time).velocity];
        assert_eq!(both.velocity(-1e3, time), velocity);
    }
    assert_eq!(AtRest.displacement(0.0, 1.0), [0.0; 2]);
    let always = FreeFieldFn::new(|_, _| [1.0, 1.0]).with_velocity(|_, _| [2.0, 2.0]);
    assert_eq!(always.displacement(0.0, 0.0), [0.0; 2]);
    assert_eq!(always.velocity(0.0, -1.0), [0.0; 2]);
    assert_eq!(always.velocity(0.0, 1e-9), [2.0; 2]);
}

/// GOAL: the default velocity, a difference of displacements, is as accurate as documented, late in time too.
/// REFERENCE: the closed form of a Ricker pulse of about 1.5 and 15 Hz.
#[test]
fn velocities_by_default_are_differences() {
    struct WithoutVelocity(RickerDisplacement);
    impl FreeField for WithoutVelocity {
        fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
            self.0.displacement(x, time)
        }
    }
    for (sigma, center) in [(0.15, 1.0), (0.015, 1.0), (0.015, 1.0e6)] {
        let pulse = RickerDisplacement::new(0.3, sigma, center).unwrap();
        let closure = FreeFieldFn::new(move |x, t| pulse.displacement(x, t));
        let mut max_magnitude = 0.0_f64;
        let mut largest_error = 0.0_f64;
        for k in -300..300 {
            let time = center + 0.013 * sigma * f64::from(k);
            let expected = pulse.velocity(0.0, time)[0];
            let computed = WithoutVelocity(pulse).velocity(0.0, time);
            assert_eq!(computed, closure.velocity(0.0, time));
            assert_eq!(computed[1], 0.0);
            max_magnitude = max_magnitude.max(expected.abs());
            largest_error = largest_error.max((computed[0] - expected).abs());
        }
        // The largest third derivative is 8.4/σ² times the largest velocity; the second term bounds the rounding.
        let bound = (1e-5 / sigma).powi(2) * 8.5 / 6.0 * max_magnitude + 2.0 * 0.3 * 2e-11;
        println!("sigma {sigma}: {largest_error:e} m/s of {max_magnitude} m/s, bound {bound:e}");
        assert!(largest_error < bound);
        assert!(max_magnitude > 0.3 / sigma);
    }
    let ramp = FreeFieldFn::new(|_, t| [t, -2.0 * t]);
    for time in [0.0, -1.0, f64::NAN] {
        assert_eq!(ramp.velocity(0.0, time), [0.0; 2]);
    }
    for time in [1e-3, 1.0, 1e9, 1e15] {
        let velocity = ramp.velocity(0.0, time);
        assert!((velocity[0] - 1.0).abs() < 1e-9, "{velocity:?}");
        assert!((velocity[1] + 2.0).abs() < 1e-9, "{velocity:?}");
    }
    assert!(format!("{ramp:?}").contains("exact_velocity: false"));
}

/// GOAL: stresses of waves from below do not need an exact velocity.
#[test]
fn stresses_of_waves_need_no_exact_velocity() {
    let soil = Soil::new(80.0e6, 0.25, 2000.0).unwrap();
    let pulse = RickerDisplacement::new(0.1, 0.1, 0.8).unwrap();
    let exact = VerticalWaves::new(soil, pulse, 20.0).unwrap();
    let closure = FreeFieldFn::new(move |x, t| pulse.displacement(x, t));
    let by_difference = VerticalWaves::new(soil, closure, 20.0).unwrap();
    let mut max_magnitude = 0.0_f64;
    for k in 0..200 {
        let time = 0.01 * f64::from(k);
        let expected = exact.stress([0.0, 7.0], time);
        let computed = by_difference.stress([0.0, 7.0], time);
        max_magnitude = max_magnitude.max(expected[2].abs());
        let error = (expected[2] - computed[2]).abs();
        assert!(error < 1e-6 * 1.0e6, "{expected:?} {computed:?}");
    }
    assert!(max_magnitude > 1.0e5);
}

/// GOAL: the velocity of a Ricker pulse is the derivative of its displacement; bad pulses are errors.
#[test]
fn ricker_velocity_is_the_derivative() {
    let pulse = RickerDisplacement::new(-0.3, 0.4, 2.0).unwrap();
    let vertical = pulse.vertical();
    let h = 1e-5;
    for k in 1..400 {
        let time = f64::from(k) * 0.01 + 1e-3;
        let slope = (pulse.displacement(0.0, time + h)[0] - pulse.displacement(0.0, time - h)[0])
            / (2.0 * h);
        assert_close("velocity", pulse.velocity(5.0, time)[0], slope, 1e-8, 0.0);
        assert_eq!(vertical.displacement(0.0, time), [0.0, pulse.displacement(0.0, time)[0]]);
    }
    assert_eq!(pulse.displacement(0.0, 0.0), [0.0; 2]);
    assert_eq!(pulse.velocity(0.0, -3.0), [0.0; 2]);
    for (amplitude, sigma, center) in [
        (f64::NAN, 1.0, 5.0),
        (1.0, 0.0, 5.0),
        (1.0, -1.0, 5.0),
        (1.0, 1.0, 3.9),
        (1.0, 1.0, f64::NAN),
        (1.0, 1.0, f64::INFINITY),
    ] {
        assert!(RickerDisplacement::new(amplitude, sigma, center).is_err());
    }
}
