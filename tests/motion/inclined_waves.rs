//! GOAL: inclined waves have the right amplification, Rayleigh waves the right ellipses; components that vanish are errors.
//! SCENE: plane SV and P waves over angle and ν.
//! REFERENCE: a solution of 30 digits; Ewing, Jardetzky & Press 1957.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use basemat::motion::{Baseline, FreeField, PlaneWave, Record, TravellingWave, el_centro_1940};
use basemat::{Error, Result, Soil};

use basemat_problems::table;

pub(super) fn soil(poisson: f64) -> Soil {
    Soil::new(80e6, poisson, 1900.0).unwrap()
}

pub(super) fn sv(poisson: f64, angle: f64) -> PlaneWave {
    PlaneWave::sv(soil(poisson), angle).unwrap()
}

fn p(poisson: f64, angle: f64) -> PlaneWave {
    PlaneWave::p(soil(poisson), angle).unwrap()
}

/// El Centro, at rest at its end.
pub(super) fn el_centro_to_rest() -> Record {
    el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap()
}

/// GOAL: amplifications leave no traction at the surface.
/// REFERENCE: a solution of 30 digits.
#[test]
fn surface_motion_leaves_no_traction() {
    let table = table("inclined_waves.csv");
    let rows =
        table.rows(["poisson", "angle_deg", "horizontal", "horizontal_late", "up", "up_late"]);
    for (kind, [poisson, angle, expected @ ..]) in table.text("wave").into_iter().zip(rows) {
        let angle = angle.to_radians();
        let wave = if kind == "sv" { sv(poisson, angle) } else { p(poisson, angle) };
        for (computed, expected) in wave.amplification().iter().flatten().zip(&expected) {
            let error = (computed - expected).abs();
            assert!(error < 1e-11, "{kind} {poisson} {angle}: {computed} {expected}");
        }
        let speed = if kind == "sv" {
            soil(poisson).shear_wave_speed()
        } else {
            soil(poisson).pressure_wave_speed()
        };
        assert!((wave.apparent_velocity() * angle.sin() / speed - 1.0).abs() < 1e-14);
    }
}

/// GOAL: waves from the left and from the right are mirror images.
#[test]
fn waves_from_the_other_side_are_mirror_images() {
    // An incident P wave from the right pushes to the left.
    for (build, sign) in [(sv as fn(f64, f64) -> PlaneWave, 1.0), (p, -1.0)] {
        for angle in [0.3, 0.9] {
            let left = build(0.3, -angle);
            let reversed = build(0.3, angle).reversed();
            assert_eq!(left.apparent_velocity(), reversed.apparent_velocity());
            for (a, b) in left.amplification().iter().zip(reversed.amplification()) {
                for (a, b) in a.iter().zip(b) {
                    assert!((a - sign * b).abs() < 1e-14);
                }
            }
        }
    }
}

/// GOAL: under vertical incidence the surface doubles the incident wave and moves along one axis.
#[test]
fn vertical_incidence_doubles_one_component() {
    let vertical_sv = sv(0.3, 0.0);
    let vertical_p = p(0.3, 0.0);
    for (wave, expected) in
        [(vertical_sv, [[2.0, 0.0], [0.0, 0.0]]), (vertical_p, [[0.0, 0.0], [2.0, 0.0]])]
    {
        for (a, b) in wave.amplification().iter().flatten().zip(expected.iter().flatten()) {
            assert!((a - b).abs() < 1e-14);
        }
        assert!(wave.apparent_velocity().is_infinite());
    }
    let record = el_centro_1940();
    let field = vertical_sv.field_from_horizontal(&record, 0.0).unwrap();
    assert_eq!(field.displacement(50.0, 7.0), [record.at(7.0).displacement, 0.0]);
    assert!(vertical_sv.field_from_vertical(&record, 0.0).is_err());
    assert!(vertical_p.field_from_horizontal(&record, 0.0).is_err());
    // At 45 degrees SV moves the surface up and down only.
    assert!(sv(0.3, FRAC_PI_4).field_from_horizontal(&record, 0.0).is_err());
    for angle in [f64::NAN, f64::INFINITY, 1.6, -1.6] {
        assert!(
            PlaneWave::sv(soil(0.3), angle).is_err() && PlaneWave::p(soil(0.3), angle).is_err()
        );
    }
}

/// Asserts the error of a component with little motion.
#[track_caller]
fn assert_errors(outcome: Result<TravellingWave>, name: &str) {
    let Err(error @ Error::Input { value, .. }) = outcome else {
        panic!("{name}: accepted")
    };
    assert!(error.to_string().contains("of the wave") && value <= 0.1, "{name}: {error}");
}

/// GOAL: no component is prescribed where the other one would be ten times as large or more.
/// SCENE: SV at 45° and at the critical angle, P near grazing for ν = 0, either near the vertical.
#[test]
fn components_that_vanish_are_not_prescribed() {
    let record = el_centro_to_rest();
    for poisson in [-0.5, -0.1, 0.0, 0.01, 0.25, 0.3, 0.45] {
        let critical = f64::sqrt(0.5 * (1.0 - 2.0 * poisson) / (1.0 - poisson)).asin();
        for offset in [0.0_f64, 1e-12, -1e-9, 1e-6, -1e-4, 1e-3] {
            let name = format!("nu {poisson}, {offset:e} rad off");
            let near_45_degrees = sv(poisson, FRAC_PI_4 + offset);
            assert_errors(near_45_degrees.field_from_horizontal(&record, 0.0), &name);
            if offset.abs() < 1e-9 && poisson != 0.0 {
                let near_critical = sv(poisson, critical + offset);
                assert_errors(near_critical.field_from_vertical(&record, 0.0), &name);
            }
            let offset = offset.abs();
            assert_errors(sv(poisson, offset).field_from_vertical(&record, 0.0), &name);
            assert_errors(p(poisson, offset).field_from_horizontal(&record, 0.0), &name);
        }
    }
    for offset in [1e-3, 1e-6, 1e-12] {
        let grazing = p(0.0, FRAC_PI_2 - offset);
        assert_errors(grazing.field_from_vertical(&record, 0.0), "P, nu 0, grazing");
        assert!(grazing.field_from_horizontal(&record, 0.0).is_ok());
    }
    for angle in [44.9_f64, 45.1] {
        let wave = sv(0.0, angle.to_radians());
        assert_errors(wave.field_from_horizontal(&record, 0.0), "one unit of length");
    }
    // A few degrees away the component is accepted.
    for (angle, poisson) in [(43.0, 0.0), (43.0, 0.3), (48.0, 0.3), (2.0, 0.3)] {
        let wave = sv(poisson, f64::to_radians(angle));
        assert!(wave.field_from_horizontal(&record, 0.0).is_ok(), "{angle}");
    }
}

/// GOAL: whatever component is accepted, at any angle, the other one is less than ten times as large.
#[test]
fn accepted_components_are_not_small() {
    let record = Record::new(0.1, vec![0.0, 1.0, -1.0, 0.0]).unwrap();
    let mut accepted = 0;
    for poisson in [-0.5, 0.0, 0.01, 0.25, 0.45] {
        for build in [PlaneWave::sv, PlaneWave::p] {
            for angle in (1..3600).map(|k| f64::from(k) * FRAC_PI_2 / 3600.0) {
                let Ok(wave) = build(soil(poisson), angle) else { continue };
                let [x, up] = wave.amplification().map(|[re, im]| re.hypot(im));
                let ratios = [
                    wave.field_from_horizontal(&record, 0.0).map(|_| up / x),
                    wave.field_from_vertical(&record, 0.0).map(|_| x / up),
                ];
                for ratio in ratios.into_iter().flatten() {
                    assert!(ratio < 10.0, "nu {poisson}, {angle} rad: {ratio}");
                    accepted += 1;
                }
            }
        }
    }
    assert!(accepted > 50_000, "{accepted}");
}

/// GOAL: at 45°, where Rayleigh's function may vanish, amplitudes are finite or the angle is an error, for any modulus.
#[test]
fn amplitudes_at_45_degrees_are_finite_or_are_errors() {
    for k in 0..2000 {
        let soil = Soil::new(1e6 * 1.01_f64.powi(k % 1000), 0.0, 1000.0 + f64::from(k)).unwrap();
        match PlaneWave::sv(soil, FRAC_PI_4) {
            Ok(wave) => assert!(wave.amplification().iter().flatten().all(|a| a.abs() < 3.0)),
            Err(error) => assert!(matches!(error, Error::Input { .. })),
        }
    }
}

/// Gaussian window about 10 s.
pub(super) fn gaussian_window(t: f64, denominator: f64) -> f64 {
    (-(t - 10.0).powi(2) / denominator).exp()
}

/// GOAL: Rayleigh waves are ellipses that turn backwards at the top.
/// REFERENCE: the ratio of the axes for ν = 1/4, 0.8475 to 0.5773 (Ewing, Jardetzky & Press 1957, § 2-2).
#[test]
fn rayleigh_waves_are_retrograde_ellipses() {
    let wave = PlaneWave::rayleigh(soil(0.25));
    let [horizontal, vertical] = wave.amplification();
    assert_eq!(horizontal, [1.0, 0.0]);
    assert_eq!(vertical[0], 0.0);
    assert!((vertical[1] - 0.8475 / 0.5773).abs() < 2e-4, "{vertical:?}");
    let speed = soil(0.25).shear_wave_speed() * 0.919_401_68;
    assert!((wave.apparent_velocity() / speed - 1.0).abs() < 1e-7);
    // A harmonic with a quiet beginning: when the surface is highest it moves to the left.
    let omega = 7.0_f64;
    let samples = (0..4001).map(|k| {
        let t = f64::from(k) * 0.005;
        gaussian_window(t, 8.0) * (omega * t).cos()
    });
    let record = Record::new(0.005, samples.collect()).unwrap();
    let field = wave.field_from_horizontal(&record, 0.0).unwrap();
    let highest = (0..400)
        .map(|k| 10.0 + 0.0025 * f64::from(k))
        .max_by(|&a, &b| field.displacement(0.0, a)[1].total_cmp(&field.displacement(0.0, b)[1]))
        .unwrap();
    assert!(field.velocity(0.0, highest)[0] < -0.9 / omega);
    assert!(field.displacement(0.0, highest)[0].abs() < 0.05 / (omega * omega));
}

/// GOAL: speed and axes of Rayleigh waves are right up to the limit ν = 1/2.
/// REFERENCE: the root of Rayleigh's function (2 − q)² = 4 √(1−q) √(1−q c₂²/c₁²), q = c²/c₂², with 30 digits by mpmath:
/// speed relative to shear waves, and ratio of the axes.
#[test]
fn rayleigh_waves_follow_roots_of_thirty_digits() {
    for (poisson, speed, ratio, tolerance) in [
        (0.0, 0.874_032_048_897_642_1, 1.272_019_649_514_069, 1e-12),
        (0.25, 0.919_401_686_761_966_1, 1.467_889_825_013_870_6, 1e-12),
        (1.0 / 3.0, 0.932_525_905_931_154_9, 1.565_197_717_383_639_4, 1e-12),
        (0.4, 0.942_195_433_116_383_8, 1.659_784_924_279_507_5, 1e-12),
        (0.49, 0.954_074_354_139_504_6, 1.818_844_476_567_570_5, 1e-12),
        (0.5 - 1e-10, 0.955_312_501_025_631_5, 1.839_286_755_214_161, 1e-9),
    ] {
        let soil = soil(poisson);
        let wave = PlaneWave::rayleigh(soil);
        let vertical = wave.amplification()[1];
        assert_eq!(vertical[0], 0.0);
        assert!((vertical[1] / ratio - 1.0).abs() < tolerance, "{poisson}: {vertical:?}");
        let computed = wave.apparent_velocity() / soil.shear_wave_speed();
        assert!((computed / speed - 1.0).abs() < tolerance, "{poisson}: {computed}");
    }
}

/// GOAL: travelling waves are delayed by distance over velocity; velocities and origins out of range are errors.
#[test]
fn travelling_waves_are_delayed_and_need_valid_input() {
    for velocity in [0.0, f64::NAN, 1e-320] {
        assert!(TravellingWave::new(el_centro_1940(), velocity, 0.0).is_err());
    }
    assert!(TravellingWave::new(el_centro_1940(), 1.0, f64::NAN).is_err());
    let left = TravellingWave::new(el_centro_1940(), -500.0, 20.0).unwrap();
    let velocity = left.velocity(-30.0, 3.1)[0];
    assert!((velocity - el_centro_1940().at(3.0).velocity).abs() < 1e-12);
    assert_eq!(left.displacement(0.0, 0.0), [0.0; 2]);
}
