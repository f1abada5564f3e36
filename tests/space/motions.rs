//! Waves that run over a mat in any direction, and motions in three directions through layers.

use std::f64::consts::{FRAC_PI_2, TAU};

use basemat::interface::Bonded;
use basemat::motion::{FreeField, PlaneWave, TravellingWave, Triaxial, el_centro_1940};
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil, unobserved};

use super::cells::{Bed, Cells};

const ORIGIN: f64 = -12.0;

fn soil() -> Soil {
    Soil::from_shear_wave_speed(180.0, 0.3, 1900.0).unwrap()
}

/// SV, P and SH at these angles, with El Centro as the component that is given.
fn waves() -> Vec<TravellingWave> {
    let record = el_centro_1940();
    vec![
        PlaneWave::sv(soil(), 0.3).unwrap().field_from_horizontal(&record, ORIGIN).unwrap(),
        PlaneWave::p(soil(), 0.7).unwrap().field_from_vertical(&record, ORIGIN).unwrap(),
        PlaneWave::sh(soil(), 0.5).unwrap().field_from_across(&record, ORIGIN).unwrap(),
    ]
}

/// An own solution of the free surface: amplitudes of the reflected waves by Cramer's rule.
fn ratios() -> [f64; 2] {
    let soil = soil();
    let (c1, c2) = (soil.pressure_wave_speed(), soil.shear_wave_speed());
    // With z down: P (p, −a), SV (b, p) upwards; reflected P (p, a), SV (b, −p). σ_zz/μ, σ_xz/μ.
    let amplitudes = |p: f64, incident: [f64; 2]| {
        let (a, b) = ((c1.powi(-2) - p * p).sqrt(), (c2.powi(-2) - p * p).sqrt());
        let ratio = c1 * c1 / (c2 * c2);
        let stress = |[x, z]: [f64; 2], down: f64| {
            [ratio * down * z + (ratio - 2.0) * p * x, p * z + down * x]
        };
        let (own, down) = (incident, if incident[0] == p { -a } else { -b });
        let [[f1, f2], [p1, p2], [s1, s2]] =
            [stress(own, down), stress([p, a], a), stress([b, -p], b)];
        let determinant = p1 * s2 - s1 * p2;
        let (q, r) = ((s1 * f2 - f1 * s2) / determinant, (f1 * p2 - p1 * f2) / determinant);
        [own[0] + q * p + r * b, -(own[1] + q * a - r * p)]
    };
    let p = 0.3_f64.sin() / c2;
    let [x, up] = amplitudes(p, [(c2.powi(-2) - p * p).sqrt(), p]);
    let q = 0.7_f64.sin() / c1;
    let [along, rise] = amplitudes(q, [q, -(c1.powi(-2) - q * q).sqrt()]);
    [up / x, along / rise]
}

#[test]
fn waves_run_in_the_direction_of_their_azimuth() {
    let record = el_centro_1940();
    let speeds = [
        180.0 / 0.3_f64.sin(),
        soil().pressure_wave_speed() / 0.7_f64.sin(),
        180.0 / 0.5_f64.sin(),
    ];
    let [sv, p] = ratios();
    for azimuth in [0.0, FRAC_PI_2, 2.2, -0.6] {
        for (k, wave) in waves().into_iter().enumerate() {
            let wave = wave.with_azimuth(azimuth).unwrap();
            for (place, time) in [([4.0, -3.0], 2.0), ([-6.0, 7.0], 5.3), ([0.0, 2.0], 11.1)] {
                let way = place[0] * azimuth.cos() + place[1] * azimuth.sin() - ORIGIN;
                let given = record.at(time - way / speeds[k]).displacement;
                let [along, across, up] =
                    [[given, 0.0, sv * given], [p * given, 0.0, given], [0.0, given, 0.0]][k];
                let exact = [
                    along * azimuth.cos() - across * azimuth.sin(),
                    along * azimuth.sin() + across * azimuth.cos(),
                    up,
                ];
                let found = wave.displacement_at(place, time);
                for (found, exact) in found.iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-12, "{k} {azimuth} {found} {exact}");
                }
                let [x, _, up] = wave.displacement_at([place[0], 0.0], time);
                assert_eq!(wave.displacement(place[0], time), [x, up]);
                let after = wave.displacement(place[0], time + 5e-4)[0];
                let rate = (after - wave.displacement(place[0], time - 5e-4)[0]) / 1e-3;
                assert!((wave.velocity(place[0], time)[0] - rate).abs() < 1e-3);
            }
        }
    }
}

/// u = f(t − p x + q z) + R f(t − p x − q z) has no traction at z = 0 if R = 1.
#[test]
fn sh_waves_double_at_the_surface() {
    let wave = PlaneWave::sh(soil(), 0.5).unwrap();
    assert_eq!((wave.amplification_across(), wave.amplification()), (2.0, [[0.0; 2]; 2]));
    assert!((wave.apparent_velocity() * 0.5_f64.sin() / 180.0 - 1.0).abs() < 1e-14);
    assert_eq!(PlaneWave::sh(soil(), 0.0).unwrap().apparent_velocity(), f64::INFINITY);
    assert_eq!(wave.reversed().apparent_velocity(), -wave.apparent_velocity());
    let record = el_centro_1940();
    for error in [
        PlaneWave::sh(soil(), FRAC_PI_2).err(),
        PlaneWave::sh(soil(), f64::NAN).err(),
        wave.field_from_horizontal(&record, 0.0).err(),
        wave.field_from_vertical(&record, 0.0).err(),
        PlaneWave::sv(soil(), 0.1).unwrap().field_from_across(&record, 0.0).err(),
        wave.field_from_across(&record, f64::NAN).err(),
        wave.field_from_across(&record, 0.0).unwrap().with_azimuth(f64::INFINITY).err(),
    ] {
        assert!(matches!(error, Some(basemat::Error::Input { .. })), "{error:?}");
    }
}

/// A square body on a bed, under the wave number `k` in the direction of so many quarters.
fn march(k: usize, quarters: u32, density: f64, bed: Bed) -> (Vec<f64>, Cells) {
    let cells = Cells::under([16.0; 2], [0.0; 2], [6, 6], bed);
    let wave = waves().swap_remove(k).with_azimuth(f64::from(quarters) * FRAC_PI_2).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .structure(RigidBody::cuboid([16.0, 16.0, 8.0], density).unwrap())
        .ground(cells.clone())
        .interface(Bonded)
        .motion(wave)
        .build()
        .unwrap();
    simulation.run(700, |_| {}).unwrap();
    (simulation.state().absolute_displacement().to_vec(), cells)
}

const BED: Bed = Bed { stiffness: [3.0e7, 2.0e7, 2.0e7], dashpot: [6.0e5, 4.0e5, 4.0e5] };

#[test]
fn a_square_mat_turns_with_its_waves() {
    for k in 0..3 {
        let (u, _) = march(k, 0, 2000.0, BED);
        // SV and P rock about y; SH twists, and rocks about x.
        let largest = if k == 2 { u[5].abs() } else { u[4].abs() };
        assert!(largest > 1e-6, "{u:?}");
        for quarters in 1..4 {
            let mut exact = u.clone();
            for _ in 0..quarters {
                exact = vec![-exact[1], exact[0], exact[2], -exact[4], exact[3], exact[5]];
            }
            let (found, _) = march(k, quarters, 2000.0, BED);
            for (found, exact) in found.iter().zip(&exact) {
                assert!((found - exact).abs() < 1e-13, "{k} {quarters}: {found} {exact}");
            }
        }
    }
}

/// A body next to no mass follows the ground in the mean: its twist is Σ A (x u_y − y u_x)/Σ A (x² + y²).
#[test]
fn a_light_mat_twists_with_the_ground_that_an_sh_wave_passes() {
    let (u, cells) = march(2, 0, 1e-3, BED);
    let wave = waves().swap_remove(2);
    let (mut twist, mut polar) = (0.0, 0.0);
    for e in 0..36 {
        let (area, [x, y]) = cells.cell(e);
        let [along, across, _] = wave.displacement_at([x, y], 3.5);
        twist += area * (x * across - y * along);
        polar += area * (x * x + y * y);
    }
    let exact = twist / polar;
    assert!(exact.abs() > 1e-5 && (u[5] / exact - 1.0).abs() < 1e-4, "{} {exact}", u[5]);
}

/// Each component equals the plane's column, with the motion after the record; on a rigid base, a transfer function by
/// hand.
#[test]
fn a_column_carries_three_components_each_by_its_wave() {
    let damping = GeneralizedMaxwell::constant_q(0.03, [0.1, 30.0], 1.0).unwrap();
    let profile =
        SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0).unwrap())
            .with_layer(Soil::from_shear_wave_speed(220.0, 0.35, 1900.0).unwrap(), 14.0)
            .unwrap()
            .with_damping(damping);
    let record = el_centro_1940();
    let motion = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(-0.7).unwrap().resampled(0.01).unwrap()),
        up: Some(record.scaled(0.4).unwrap()),
    };
    for control in [ControlPoint::Outcrop, ControlPoint::Within] {
        let found =
            SoilColumn::surface_in_plan(&profile, control, &motion, &mut unobserved).unwrap();
        for (given, found, wave) in [
            (&motion.x, &found.x, VerticalWave::Shear),
            (&motion.y, &found.y, VerticalWave::Shear),
            (&motion.up, &found.up, VerticalWave::Pressure),
        ] {
            let [given, found] = [given, found].map(|own| own.as_ref().unwrap());
            let column = SoilColumn::new(profile.clone(), wave).unwrap();
            let exact = column
                .to_surface(control, given.time_step(), given.accelerations(), &mut unobserved)
                .unwrap();
            let (own, after) = found.accelerations().split_at(given.len());
            assert_eq!(own, exact.samples);
            assert_eq!(found.time_step(), given.time_step());
            assert!(after.iter().fold(0.0_f64, |most, a| most.max(a.abs())) > 1e-6);
        }
    }
    let none = SoilColumn::surface_in_plan(
        &profile,
        ControlPoint::Outcrop,
        &Triaxial::default(),
        &mut unobserved,
    );
    assert_eq!(none.unwrap(), Triaxial::default());
    // A layer of 10 m on a rigid base under long sines: 1/cos(ω h/c) of each wave.
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(layer, 10.0).unwrap();
    let omega = TAU * 2.0;
    let start = |time: f64| (1.0 - (-0.5 * time * time).exp()) * (omega * time).sin();
    let sine = basemat::motion::Record::new(
        5e-3,
        (0..6000)
            .map(|k| {
                start(5e-3 * f64::from(k)) * (-(5e-3 * f64::from(k) - 15.0).powi(2) / 40.0).exp()
            })
            .collect(),
    )
    .unwrap();
    let motion = Triaxial { x: Some(sine.clone()), y: None, up: Some(sine.clone()) };
    let found =
        SoilColumn::surface_in_plan(&profile, ControlPoint::Within, &motion, &mut unobserved)
            .unwrap();
    assert!(found.y.is_none());
    for (own, speed) in [(found.x, 200.0), (found.up, layer.pressure_wave_speed())] {
        let exact = 1.0 / (omega * 10.0 / speed).cos();
        let ratio = own.unwrap().peaks().acceleration / sine.peaks().acceleration;
        assert!((ratio / exact - 1.0).abs() < 0.01, "{ratio} {exact}");
    }
}
