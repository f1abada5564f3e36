//! Waves at an angle: surface motion against an independent solution, limits, and a base under one.

use basemat::Soil;
use basemat::motion::{FreeField, PlaneWave, Record, TravellingWave, el_centro_1940};

fn soil(poisson: f64) -> Soil {
    Soil::new(80e6, poisson, 1900.0).unwrap()
}

#[test]
fn surface_motion_leaves_no_traction() {
    let table = include_str!("data/inclined_waves.csv");
    let rows = table.lines().filter(|line| !line.starts_with(['#', 'w']));
    for row in rows {
        let fields: Vec<_> = row.split(',').collect();
        let numbers: Vec<f64> = fields[1..].iter().map(|field| field.parse().unwrap()).collect();
        let (kind, poisson, angle) = (fields[0], numbers[0], numbers[1].to_radians());
        let make = if kind == "sv" { PlaneWave::sv } else { PlaneWave::p };
        let wave = make(soil(poisson), angle).unwrap();
        for (found, known) in wave.amplification().iter().flatten().zip(&numbers[2..]) {
            assert!((found - known).abs() < 1e-11, "{row}: {found}");
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
    assert_eq!(field.displacement(50.0, 7.0), [record.displacement_at(7.0), 0.0]);
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
    assert!((left.delay(-30.0) - 0.1).abs() < 1e-15);
    let velocity = left.velocity(-30.0, 3.1)[0];
    assert!((velocity - el_centro_1940().velocity_at(3.0)).abs() < 1e-12);
    assert_eq!(left.displacement(0.0, 0.0), [0.0; 2]);
}
