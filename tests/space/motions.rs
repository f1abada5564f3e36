//! Waves that run over a mat in any direction, and motions in three directions through layers.

use std::f64::consts::{FRAC_PI_2, TAU};

use basemat::interface::Bonded;
use basemat::motion::{FreeField, PlaneWave, Record, TravellingWave, Triaxial, el_centro_1940};
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil, unobserved};

use super::cells::{BedProperties, SpringCells};

/// Point on the path of a wave where its motion has the time of the record, m.
const WAVE_ORIGIN: f64 = -12.0;
const SHEAR_WAVE_SPEED: f64 = 180.0;
/// Angles of SV, P and SH waves from the vertical, rad.
const INCIDENCE_ANGLES: [f64; 3] = [0.3, 0.7, 0.5];

fn soil() -> Soil {
    Soil::from_shear_wave_speed(SHEAR_WAVE_SPEED, 0.3, 1900.0).unwrap()
}

/// SV, P and SH, with El Centro as one component of the surface's motion.
fn waves() -> Vec<TravellingWave> {
    let record = el_centro_1940();
    let sv = PlaneWave::sv(soil(), INCIDENCE_ANGLES[0]).unwrap();
    let p = PlaneWave::p(soil(), INCIDENCE_ANGLES[1]).unwrap();
    let sh = PlaneWave::sh(soil(), INCIDENCE_ANGLES[2]).unwrap();
    vec![
        sv.field_from_horizontal(&record, WAVE_ORIGIN).unwrap(),
        p.field_from_vertical(&record, WAVE_ORIGIN).unwrap(),
        sh.field_from_across(&record, WAVE_ORIGIN).unwrap(),
    ]
}

/// σ_zz/μ and σ_xz/μ of a wave of this amplitude and vertical slowness (down), for a horizontal slowness.
///
/// `ratio` is the squared ratio of the wave speeds.
fn surface_stress([x, z]: [f64; 2], down: f64, slowness: f64, ratio: f64) -> [f64; 2] {
    [ratio * down * z + (ratio - 2.0) * slowness * x, slowness * z + down * x]
}

/// Horizontal and upward motion of the free surface by an incident wave of this amplitude.
///
/// A solution that shares no code with the crate: amplitudes of the reflected waves by Cramer's rule. With z down: P (p, −a)
/// and SV (b, p) upwards; reflected P (p, a) and SV (b, −p).
fn surface_motion(p: f64, incident: [f64; 2]) -> [f64; 2] {
    let c1 = soil().pressure_wave_speed();
    let c2 = soil().shear_wave_speed();
    let a = (c1.powi(-2) - p * p).sqrt();
    let b = (c2.powi(-2) - p * p).sqrt();
    let ratio = c1 * c1 / (c2 * c2);
    let down = if incident[0] == p { -a } else { -b };
    let f = surface_stress(incident, down, p, ratio);
    let by_p = surface_stress([p, a], a, p, ratio);
    let by_sv = surface_stress([b, -p], b, p, ratio);
    let determinant = by_p[0] * by_sv[1] - by_sv[0] * by_p[1];
    let q = (by_sv[0] * f[1] - f[0] * by_sv[1]) / determinant;
    let r = (f[0] * by_p[1] - by_p[0] * f[1]) / determinant;
    [incident[0] + q * p + r * b, -(incident[1] + q * a - r * p)]
}

/// Vertical over horizontal motion by SV, and horizontal over vertical by P.
fn surface_ratios() -> [f64; 2] {
    let c1 = soil().pressure_wave_speed();
    let c2 = soil().shear_wave_speed();
    let p = INCIDENCE_ANGLES[0].sin() / c2;
    let by_sv = surface_motion(p, [(c2.powi(-2) - p * p).sqrt(), p]);
    let q = INCIDENCE_ANGLES[1].sin() / c1;
    let by_p = surface_motion(q, [q, -(c1.powi(-2) - q * q).sqrt()]);
    [by_sv[1] / by_sv[0], by_p[0] / by_p[1]]
}

#[test]
fn waves_run_in_the_direction_of_their_azimuth() {
    let record = el_centro_1940();
    let apparent_speeds = [
        SHEAR_WAVE_SPEED / INCIDENCE_ANGLES[0].sin(),
        soil().pressure_wave_speed() / INCIDENCE_ANGLES[1].sin(),
        SHEAR_WAVE_SPEED / INCIDENCE_ANGLES[2].sin(),
    ];
    let ratios = surface_ratios();
    for azimuth in [0.0, FRAC_PI_2, 2.2, -0.6] {
        for (k, wave) in waves().into_iter().enumerate() {
            let wave = wave.with_azimuth(azimuth).unwrap();
            for (place, time) in [([4.0, -3.0], 2.0), ([-6.0, 7.0], 5.3), ([0.0, 2.0], 11.1)] {
                let path = place[0] * azimuth.cos() + place[1] * azimuth.sin() - WAVE_ORIGIN;
                let u = record.at(time - path / apparent_speeds[k]).displacement;
                let [along, across, up] =
                    [[u, 0.0, ratios[0] * u], [ratios[1] * u, 0.0, u], [0.0, u, 0.0]][k];
                let expected = [
                    along * azimuth.cos() - across * azimuth.sin(),
                    along * azimuth.sin() + across * azimuth.cos(),
                    up,
                ];
                let computed = wave.displacement_at(place, time);
                for (computed, expected) in computed.iter().zip(expected) {
                    assert!(
                        (computed - expected).abs() < 1e-12,
                        "{k} {azimuth} {computed} {expected}"
                    );
                }
                let in_space = wave.displacement_at([place[0], 0.0], time);
                let in_plane = wave.displacement(place[0], time);
                assert_eq!(in_plane, [in_space[0], in_space[2]]);
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
    let angle = INCIDENCE_ANGLES[2];
    let wave = PlaneWave::sh(soil(), angle).unwrap();
    assert_eq!(wave.amplification_across(), 2.0);
    assert_eq!(wave.amplification(), [[0.0; 2]; 2]);
    assert!((wave.apparent_velocity() * angle.sin() / SHEAR_WAVE_SPEED - 1.0).abs() < 1e-14);
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

const ISOTROPIC_BED: BedProperties =
    BedProperties { stiffness: [3.0e7, 2.0e7, 2.0e7], dashpot: [6.0e5, 4.0e5, 4.0e5] };

/// Cells under a square body.
fn square_cells() -> SpringCells {
    SpringCells::under([16.0; 2], [0.0; 2], [6, 6], ISOTROPIC_BED)
}

/// Displacement of a square body on a bed after 700 steps, under SV, P or SH waves turned by quarter turns.
fn march(wave_number: usize, quarter_turns: u32, density: f64) -> Vec<f64> {
    let wave = waves().swap_remove(wave_number);
    let wave = wave.with_azimuth(f64::from(quarter_turns) * FRAC_PI_2).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .structure(RigidBody::cuboid([16.0, 16.0, 8.0], density).unwrap())
        .ground(square_cells())
        .interface(Bonded)
        .motion(wave)
        .build()
        .unwrap();
    simulation.run(700, |_| {}).unwrap();
    simulation.state().absolute_displacement().to_vec()
}

#[test]
fn a_square_mat_turns_with_its_waves() {
    for k in 0..3 {
        let u = march(k, 0, 2000.0);
        // SV and P rock about y; SH twists, and rocks about x.
        let rotation = if k == 2 { u[5].abs() } else { u[4].abs() };
        assert!(rotation > 1e-6, "{u:?}");
        for quarter_turns in 1..4 {
            let mut expected = u.clone();
            for _ in 0..quarter_turns {
                let u = &expected;
                expected = vec![-u[1], u[0], u[2], -u[4], u[3], u[5]];
            }
            let computed = march(k, quarter_turns, 2000.0);
            for (computed, expected) in computed.iter().zip(&expected) {
                assert!(
                    (computed - expected).abs() < 1e-13,
                    "{k} {quarter_turns}: {computed} {expected}"
                );
            }
        }
    }
}

/// A body of almost no mass follows the mean of the ground: its twist is Σ A (x u_y − y u_x)/Σ A (x² + y²).
#[test]
fn a_light_mat_twists_with_the_ground_that_an_sh_wave_passes() {
    let cells = square_cells();
    let wave = waves().swap_remove(2);
    let u = march(2, 0, 1e-3);
    let mut moment = 0.0;
    let mut polar_moment = 0.0;
    for e in 0..36 {
        let area = cells.area(e);
        let place = cells.middle(e);
        let u = wave.displacement_at(place, 3.5);
        moment += area * (place[0] * u[1] - place[1] * u[0]);
        polar_moment += area * (place[0] * place[0] + place[1] * place[1]);
    }
    let expected = moment / polar_moment;
    assert!(expected.abs() > 1e-5 && (u[5] / expected - 1.0).abs() < 1e-4, "{} {expected}", u[5]);
}

/// Each component is the motion of a column in the plane, and continues after the record.
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
        let surface =
            SoilColumn::surface_in_plan(&profile, control, &motion, &mut unobserved).unwrap();
        for (input, output, wave) in [
            (&motion.x, &surface.x, VerticalWave::Shear),
            (&motion.y, &surface.y, VerticalWave::Shear),
            (&motion.up, &surface.up, VerticalWave::Pressure),
        ] {
            let input = input.as_ref().unwrap();
            let output = output.as_ref().unwrap();
            let column = SoilColumn::new(profile.clone(), wave).unwrap();
            let expected = column
                .to_surface(control, input.time_step(), input.accelerations(), &mut unobserved)
                .unwrap();
            let during = &output.accelerations()[..input.len()];
            let after = &output.accelerations()[input.len()..];
            assert_eq!(during, expected.samples);
            assert_eq!(output.time_step(), input.time_step());
            assert!(after.iter().fold(0.0_f64, |max, a| max.max(a.abs())) > 1e-6);
        }
    }
    let at_rest = SoilColumn::surface_in_plan(
        &profile,
        ControlPoint::Outcrop,
        &Triaxial::default(),
        &mut unobserved,
    );
    assert_eq!(at_rest.unwrap(), Triaxial::default());
}

/// A layer of 10 m on a rigid base under long sines: 1/cos(ω h/c) of each wave.
#[test]
fn a_layer_on_a_rigid_base_amplifies_sines_by_its_transfer_function() {
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(layer, 10.0).unwrap();
    let omega = TAU * 2.0;
    let accelerations = (0..6000)
        .map(|k| 5e-3 * f64::from(k))
        .map(|time: f64| {
            let start = (1.0 - (-0.5 * time * time).exp()) * (omega * time).sin();
            start * (-(time - 15.0).powi(2) / 40.0).exp()
        })
        .collect();
    let sine = Record::new(5e-3, accelerations).unwrap();
    let motion = Triaxial { x: Some(sine.clone()), y: None, up: Some(sine.clone()) };
    let surface =
        SoilColumn::surface_in_plan(&profile, ControlPoint::Within, &motion, &mut unobserved)
            .unwrap();
    assert!(surface.y.is_none());
    for (output, speed) in [(surface.x, 200.0), (surface.up, layer.pressure_wave_speed())] {
        let expected = 1.0 / (omega * 10.0 / speed).cos();
        let ratio = output.unwrap().peaks().acceleration / sine.peaks().acceleration;
        assert!((ratio / expected - 1.0).abs() < 0.01, "{ratio} {expected}");
    }
}
