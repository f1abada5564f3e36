//! GOAL: inclined and surface waves: amplification, Rayleigh ellipses, and the component that is
//! late by a quarter of a period.
//! SCENE: plane SV and P waves over angle and ν, Gaussian and Ricker pulses.
//! REFERENCE: a solution of 30 digits, Ewing, Jardetzky & Press 1957, closed-form Hilbert
//! transforms.

use std::f64::consts::FRAC_PI_2;

use basemat::motion::{Baseline, FreeField, PlaneWave, Record, TravellingWave, el_centro_1940};
use basemat::{Error, Soil};

use basemat_problems::table;

fn soil(poisson: f64) -> Soil {
    Soil::new(80e6, poisson, 1900.0).unwrap()
}

#[test]
fn surface_motion_leaves_no_traction() {
    let table = table("inclined_waves.csv");
    let rows =
        table.rows(["poisson", "angle_deg", "horizontal", "horizontal_late", "up", "up_late"]);
    for (kind, row) in table.text("wave").into_iter().zip(rows) {
        let (poisson, angle) = (row[0], row[1].to_radians());
        let make = if kind == "sv" { PlaneWave::sv } else { PlaneWave::p };
        let wave = make(soil(poisson), angle).unwrap();
        for (found, known) in wave.amplification().iter().flatten().zip(&row[2..]) {
            assert!((found - known).abs() < 1e-11, "{kind} {row:?}: {found}");
        }
        let speed = if kind == "sv" {
            soil(poisson).shear_wave_speed()
        } else {
            soil(poisson).pressure_wave_speed()
        };
        assert!((wave.apparent_velocity() * angle.sin() / speed - 1.0).abs() < 1e-14);
    }
}

/// From the left and from the right: mirror images.
#[test]
fn the_other_way_is_the_mirror_image() {
    for make in [PlaneWave::sv, PlaneWave::p] {
        for angle in [0.3, 0.9] {
            let [right, left] = [angle, -angle].map(|angle| make(soil(0.3), angle).unwrap());
            let reversed = right.reversed();
            assert_eq!(left.apparent_velocity(), reversed.apparent_velocity());
            // An incident P wave from the right pushes to the left.
            let sign =
                if make(soil(0.3), 0.0).unwrap().amplification()[0][0] == 0.0 { -1.0 } else { 1.0 };
            for (a, b) in left.amplification().iter().zip(reversed.amplification()) {
                for (a, b) in a.iter().zip(b) {
                    assert!((a - sign * b).abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn vertical_incidence_doubles_one_component() {
    let [s, p] = [PlaneWave::sv, PlaneWave::p].map(|make| make(soil(0.3), 0.0).unwrap());
    for (found, known) in [(s, [[2.0, 0.0], [0.0, 0.0]]), (p, [[0.0, 0.0], [2.0, 0.0]])] {
        for (a, b) in found.amplification().iter().flatten().zip(known.iter().flatten()) {
            assert!((a - b).abs() < 1e-14);
        }
        assert!(found.apparent_velocity().is_infinite());
    }
    let record = el_centro_1940();
    let field = s.field_from_horizontal(&record, 0.0).unwrap();
    assert_eq!(field.displacement(50.0, 7.0), [record.at(7.0).displacement, 0.0]);
    assert!(s.field_from_vertical(&record, 0.0).is_err());
    assert!(p.field_from_horizontal(&record, 0.0).is_err());
    // At 45 degrees SV moves the surface up and down only.
    let wave = PlaneWave::sv(soil(0.3), std::f64::consts::FRAC_PI_4).unwrap();
    assert!(wave.field_from_horizontal(&record, 0.0).is_err());
    for angle in [f64::NAN, f64::INFINITY, 1.6, -1.6] {
        assert!(
            PlaneWave::sv(soil(0.3), angle).is_err() && PlaneWave::p(soil(0.3), angle).is_err()
        );
    }
}

/// GOAL: no component is prescribed where the other one would be ten times as large or more:
/// SV at 45° and at the critical angle, P near grazing for ν = 0, either near the vertical.
#[test]
fn components_that_vanish_are_not_prescribed() {
    let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
    let short = Record::new(0.1, vec![0.0, 1.0, -1.0, 0.0]).unwrap();
    let refused = |outcome: basemat::Result<TravellingWave>, what: &str| {
        let Err(error @ Error::Input { value, .. }) = outcome else { panic!("{what}: accepted") };
        assert!(error.to_string().contains("of the wave") && value <= 0.1, "{what}: {error}");
    };
    let near = [0.0_f64, 1e-12, -1e-9, 1e-6, -1e-4, 1e-3];
    for poisson in [-0.5, -0.1, 0.0, 0.01, 0.25, 0.3, 0.45] {
        let critical = f64::sqrt(0.5 * (1.0 - 2.0 * poisson) / (1.0 - poisson)).asin();
        let right_angle = std::f64::consts::FRAC_PI_4;
        for off in near {
            let sv = |angle: f64| PlaneWave::sv(soil(poisson), angle).unwrap();
            let what = format!("nu {poisson}, {off:e} rad off");
            refused(sv(right_angle + off).field_from_horizontal(&record, 0.0), &what);
            if off.abs() < 1e-9 && poisson != 0.0 {
                refused(sv(critical + off).field_from_vertical(&record, 0.0), &what);
            }
            let off = off.abs();
            refused(sv(off).field_from_vertical(&record, 0.0), &what);
            let p = PlaneWave::p(soil(poisson), off).unwrap();
            refused(p.field_from_horizontal(&record, 0.0), &what);
        }
    }
    for off in [1e-3, 1e-6, 1e-12] {
        let grazing = PlaneWave::p(soil(0.0), FRAC_PI_2 - off).unwrap();
        refused(grazing.field_from_vertical(&record, 0.0), "P, nu 0, grazing");
        assert!(grazing.field_from_horizontal(&record, 0.0).is_ok());
    }
    // Whatever is accepted, at any angle, moves the other way by ten times what is given at most.
    let mut accepted = 0;
    for poisson in [-0.5, 0.0, 0.01, 0.25, 0.45] {
        for make in [PlaneWave::sv, PlaneWave::p] {
            for angle in (1..3600).map(|k| f64::from(k) * FRAC_PI_2 / 3600.0) {
                let Ok(wave) = make(soil(poisson), angle) else { continue };
                let [x, up] = wave.amplification().map(|[re, im]| re.hypot(im));
                let fields = [
                    wave.field_from_horizontal(&short, 0.0).map(|_| up / x),
                    wave.field_from_vertical(&short, 0.0).map(|_| x / up),
                ];
                for ratio in fields.into_iter().flatten() {
                    assert!(ratio < 10.0, "nu {poisson}, {angle} rad: {ratio}");
                    accepted += 1;
                }
            }
        }
    }
    assert!(accepted > 50_000, "{accepted}");
    for angle in [44.9_f64, 45.1] {
        let wave = PlaneWave::sv(soil(0.0), angle.to_radians()).unwrap();
        refused(wave.field_from_horizontal(&record, 0.0), "one unit of length");
    }
    // A few degrees away it can be done.
    for (angle, poisson) in [(43.0, 0.0), (43.0, 0.3), (48.0, 0.3), (2.0, 0.3)] {
        let wave = PlaneWave::sv(soil(poisson), f64::to_radians(angle)).unwrap();
        assert!(wave.field_from_horizontal(&record, 0.0).is_ok(), "{angle}");
    }
}

/// GOAL: amplitudes are numbers, or the angle is refused, for any modulus at the angle at which
/// Rayleigh's function vanishes.
#[test]
fn amplitudes_at_the_double_critical_angle_are_finite_or_refused() {
    for k in 0..2000 {
        let soil = Soil::new(1e6 * 1.01_f64.powi(k % 1000), 0.0, 1000.0 + f64::from(k)).unwrap();
        match PlaneWave::sv(soil, std::f64::consts::FRAC_PI_4) {
            Ok(wave) => assert!(wave.amplification().iter().flatten().all(|a| a.abs() < 3.0)),
            Err(error) => assert!(matches!(error, Error::Input { .. })),
        }
    }
}

/// The ratio of the axes for ν = 1/4, 0.8475 to 0.5773 (Ewing, Jardetzky & Press 1957, § 2-2), and
/// the sense of the ellipse: backwards at the top.
#[test]
fn rayleigh_waves_are_retrograde_ellipses() {
    let wave = PlaneWave::rayleigh(soil(0.25));
    let [[one, zero], [none, up]] = wave.amplification();
    assert_eq!([one, zero, none], [1.0, 0.0, 0.0]);
    assert!((up - 0.8475 / 0.5773).abs() < 2e-4, "{up}");
    let speed = soil(0.25).shear_wave_speed() * 0.919_401_68;
    assert!((wave.apparent_velocity() / speed - 1.0).abs() < 1e-7);
    // A harmonic with a quiet beginning: when the surface is highest it moves to the left.
    let omega = 7.0_f64;
    let window = |t: f64| (-(t - 10.0).powi(2) / 8.0).exp();
    let samples = (0..4001).map(|k| f64::from(k) * 0.005).map(|t| window(t) * (omega * t).cos());
    let record = Record::new(0.005, samples.collect()).unwrap();
    let field = wave.field_from_horizontal(&record, 0.0).unwrap();
    let highest = (0..400)
        .map(|k| 10.0 + 0.0025 * f64::from(k))
        .max_by(|&a, &b| field.displacement(0.0, a)[1].total_cmp(&field.displacement(0.0, b)[1]))
        .unwrap();
    assert!(field.velocity(0.0, highest)[0] < -0.9 / omega);
    assert!(field.displacement(0.0, highest)[0].abs() < 0.05 / (omega * omega));
}

/// Ratio of the speed to the speed of shear waves, and axes of the ellipse, from the root of
/// Rayleigh's function (2 − q)² = 4 √(1−q) √(1−q c₂²/c₁²), q = c²/c₂², found with 30 digits by
/// mpmath; the last is the limit ν = 1/2.
#[test]
fn rayleigh_waves_have_the_roots_of_other_precision() {
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
        let [_, [none, up]] = wave.amplification();
        assert_eq!(none, 0.0);
        assert!((up / ratio - 1.0).abs() < tolerance, "{poisson}: {up}");
        let found = wave.apparent_velocity() / soil.shear_wave_speed();
        assert!((found / speed - 1.0).abs() < tolerance, "{poisson}: {found}");
    }
}

/// A wave whose vertical component is `factor` times the Hilbert transform of the horizontal one.
fn rayleigh() -> (PlaneWave, f64) {
    let wave = PlaneWave::rayleigh(soil(1.0 / 3.0));
    let factor = wave.amplification()[1][1];
    (wave, factor)
}

/// Pulses of displacement whose transforms are known: a Gaussian, of which most is long-period and
/// whose transform fades as 1/t, and Ricker's. Nothing is left to the record's ends: it is cut a
/// short while after the pulse, and the transform evaluated long after and before.
#[test]
fn the_late_component_of_a_pulse_has_its_closed_form() {
    let table = table("hilbert_pulses.csv");
    let (width, centre, step) = (0.7, 6.0, 0.0025);
    let (wave, factor) = rayleigh();
    // Second derivatives in x = (t − centre)/width.
    let gaussian = |x: f64| (x * x - 1.0) * (-0.5 * x * x).exp();
    let ricker = |x: f64| (x * x * (6.0 - x * x) - 3.0) * (-0.5 * x * x).exp();
    for (column, second) in [(0, &gaussian as &dyn Fn(f64) -> f64), (1, &ricker)] {
        let rows = table.rows(["x", "gaussian", "ricker"]);
        let samples = (0..4800).map(|k| second((f64::from(k) * step - centre) / width));
        let record = Record::new(step, samples.map(|a| a / (width * width)).collect()).unwrap();
        let field = wave.field_from_horizontal(&record, 0.0).unwrap();
        let vertical = |x: f64| field.displacement(0.0, centre + width * x)[1] / factor;
        // Both are measured from where they are at x = 0, where the transforms vanish.
        let start = vertical(0.0);
        for row in rows {
            let (x, known) = (row[0], row[1 + column]);
            let found = vertical(x) - start;
            assert!((found - known).abs() < 3e-6, "{x}: {found} {known}");
            if column == 0 {
                // The derivative of Dawson's integral D is 1 − 2xD.
                let slope = (2.0 / std::f64::consts::PI).sqrt() - x * known;
                let found = field.velocity(0.0, centre + width * x)[1] / factor * width;
                assert!((found - slope).abs() < 1e-5, "{x}: {found} {slope}");
            }
        }
    }
}

/// However long the quiet time around it, a record has the same transform: none of it is missing.
#[test]
fn quiet_time_changes_nothing_but_the_start() {
    let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
    let beyond = PlaneWave::sv(soil(1.0 / 3.0), 35.0_f64.to_radians()).unwrap();
    for wave in [rayleigh().0, beyond] {
        let times = [0.5, 2.0, 10.0, 20.0, 30.0, 40.0, 90.0];
        let moved = |before: f64, after: f64| {
            let padded = record.padded(before, after).unwrap();
            let field = wave.field_from_horizontal(&padded, 0.0).unwrap();
            let at = |time: f64| field.displacement(0.0, before + time)[1];
            let drift = padded.at(padded.duration()).velocity.abs();
            (times.map(|time| at(time) - at(0.0)), field.velocity(0.0, 0.0)[1], drift)
        };
        let (bare, jolt, _) = moved(0.0, 0.0);
        for (before, after) in
            [(2.0, 0.0), (60.0, 0.0), (1000.0, 0.0), (2.0, 8.0), (60.0, 60.0), (1000.0, 1000.0)]
        {
            let (padded, less, drift) = moved(before, after);
            for (time, (a, b)) in times.iter().zip(bare.iter().zip(padded)) {
                // A sample of zero after a last one that is not leaves a little velocity, which
                // goes on for as long as the record is padded.
                let slack = 1e-9 + 3.0 * drift * time;
                assert!((a - b).abs() < slack, "{time} s: {a} {b} with {before} and {after} s");
            }
            assert!(less.abs() < jolt.abs());
        }
        // Far away the velocity is the record's first moment over the square of the distance.
        let ratio = moved(500.0, 0.0).1 / moved(1000.0, 0.0).1;
        assert!((ratio - 4.0).abs() < 0.3, "{ratio}");
    }
}

/// The vertical component given: the horizontal one leads it by what it lags otherwise.
#[test]
fn either_component_may_be_given() {
    let record = el_centro_1940().with_baseline(Baseline::RestToRest { degree: 4 }).unwrap();
    let record = record.padded(5.0, 0.0).unwrap();
    let (wave, factor) = rayleigh();
    let down = wave.field_from_horizontal(&record, 0.0).unwrap();
    let along = wave.field_from_vertical(&record, 0.0).unwrap();
    for time in [-3.0, 4.0, 9.1, 17.0, 60.0] {
        let [given, late] = down.displacement(0.0, time);
        let [lead, same] = along.displacement(0.0, time);
        assert_eq!(given, same);
        assert!((late + factor * factor * lead).abs() < 1e-12, "{late} {lead}");
    }
}

/// A record that does not end at rest has no transform.
#[test]
fn records_that_do_not_end_at_rest_are_refused() {
    let drifting = Record::new(0.1, vec![0.0, 1.0, 0.0, -0.9, 0.0]).unwrap();
    let (wave, _) = rayleigh();
    for outcome in
        [wave.field_from_horizontal(&drifting, 0.0), wave.field_from_vertical(&drifting, 0.0)]
    {
        let Err(Error::Input { quantity, value, .. }) = outcome else { panic!("accepted") };
        assert_eq!(quantity, "velocity at the end of the record");
        assert!((value - 0.01).abs() < 1e-12);
    }
    assert!(wave.field_from_horizontal(&Record::new(0.1, vec![0.0; 5]).unwrap(), 0.0).is_ok());
    // In phase it does not matter.
    let steep = PlaneWave::sv(soil(0.25), 0.3).unwrap();
    assert!(steep.field_from_horizontal(&drifting, 0.0).is_ok());
}

/// The transform of a Gaussian-windowed cosine is the windowed sine, to the width of the window;
/// twice the transform is minus the record.
#[test]
fn hilbert_transforms_are_a_quarter_of_a_period_late() {
    let omega = 12.0_f64;
    let window = |t: f64| (-(t - 10.0).powi(2) / 2.0).exp();
    let times: Vec<f64> = (0..2001).map(|k| f64::from(k) * 0.01).collect();
    let record =
        Record::new(0.01, times.iter().map(|&t| window(t) * (omega * t).cos()).collect()).unwrap();
    let late = record.hilbert_transform().unwrap();
    for (&t, found) in times.iter().zip(late.accelerations()) {
        assert!((found - window(t) * (omega * t).sin()).abs() < 1e-12, "{t}");
    }
    let twice = late.hilbert_transform().unwrap();
    for (a, b) in record.accelerations().iter().zip(twice.accelerations()) {
        assert!((a + b).abs() < 1e-12);
    }
    let padded = record.padded(0.995, 2.0).unwrap();
    assert_eq!(padded.len(), 2001 + 100 + 200);
    assert_eq!(padded.accelerations()[100..2101], *record.accelerations());
    for bad in [-1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(record.padded(bad, 0.0).is_err() && record.padded(0.0, bad).is_err());
    }
}

#[test]
fn travelling_waves_are_late_and_refuse_nonsense() {
    for velocity in [0.0, f64::NAN, 1e-320] {
        assert!(TravellingWave::new(el_centro_1940(), velocity, 0.0).is_err());
    }
    assert!(TravellingWave::new(el_centro_1940(), 1.0, f64::NAN).is_err());
    let left = TravellingWave::new(el_centro_1940(), -500.0, 20.0).unwrap();
    let velocity = left.velocity(-30.0, 3.1)[0];
    assert!((velocity - el_centro_1940().at(3.0).velocity).abs() < 1e-12);
    assert_eq!(left.displacement(0.0, 0.0), [0.0; 2]);
}
