//! GOAL: SH waves that come at an angle reach the surface of layered ground as they should, and twist a mat.
//! SCENE: elastic, damped and hysteretic layers, softer and stiffer than the half-plane; a light mat.
//! REFERENCE: the layer's closed form, vertical columns, plane waves of a half-plane, half the slope of the motion.

use std::f64::consts::TAU;

use basemat::bem::ElasticGround;
use basemat::interface::Bonded;
use basemat::motion::{FreeField, PlaneWave, Record};
use basemat::site::{ControlPoint, InclinedControl, InclinedWave, SoilColumn, VerticalWave};
use basemat::soil::SoilError;
use basemat::soil::{Relaxation, SoilProfile};
use basemat::structure::RigidBody;
use basemat::{Complex, Error, Simulation, Soil, unobserved};

use basemat_problems::profiles::{constant_q, one_layer, rock, soft, two_layers};

const OUTCROP: InclinedControl = InclinedControl::OutcropHorizontal;

/// μ b and s b, b = √(ρ/μ − p²).
fn across(soil: Soil, law: &dyn Relaxation, p: f64, s: Complex) -> [Complex; 2] {
    let modulus = law.modulus(s) * soil.shear_modulus();
    let b = (Complex::real(soil.density()) / modulus - Complex::real(p * p)).sqrt();
    let b = if (s * b).re < -1e-12 * (s * b).abs() { -b } else { b };
    [modulus * b, s * b]
}

/// Surface over outcrop: 1/(cosh(s b h) + (μ b)/(μ′ b′) sinh(s b h)).
#[test]
fn one_layer_has_its_closed_form() {
    let height = 6.0;
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for [above, below] in [[soft(), rock()], [rock(), soft()]] {
        for (profile, [upper, lower]) in one_layer(above, below, height) {
            for angle in [-50.0_f64, 0.0, 12.0, 25.0, 40.0, 60.0, 85.0] {
                let wave = InclinedWave::sh(profile.clone(), angle.to_radians()).unwrap();
                let p = 1.0 / wave.apparent_velocity();
                for frequency in [0.2, 1.7, 6.0, 14.0, 33.0] {
                    let s = Complex::new(0.0, TAU * frequency);
                    let [z, sb] = across(above, &*upper, p, s);
                    let [z0, _] = across(below, &*lower, p, s);
                    let [up, down] = [1.0, -1.0].map(|sign| (sb * (sign * height)).exp());
                    let wanted = ((up + down) * 0.5 + z / z0 * (up - down) * 0.5).inverse();
                    let [found, vertical] = wave.transfer(OUTCROP, frequency).unwrap();
                    let [incident, _] =
                        wave.transfer(InclinedControl::Incident, frequency).unwrap();
                    worst = worst.max((found - wanted).abs() / wanted.abs());
                    worst = worst.max((incident - wanted * 2.0).abs() / wanted.abs());
                    assert_eq!(vertical, Complex::default());
                    largest = largest.max(wanted.abs());
                }
            }
        }
    }
    println!("{worst:e}, largest {largest}");
    assert!(worst < 1e-11 && largest > 4.0, "{worst:e} {largest}");
}

#[test]
fn vertical_incidence_is_the_column_and_no_layers_a_plane_wave() {
    let layered = two_layers(constant_q(0.05), constant_q(0.02));
    let column = SoilColumn::new(layered.clone(), VerticalWave::Shear).unwrap();
    let upright = InclinedWave::sh(layered.clone(), 0.0).unwrap();
    let motion: Vec<f64> = (0..900).map(|i| (0.3 * f64::from(i)).sin()).collect();
    let wanted = column.to_surface(ControlPoint::Outcrop, 0.01, &motion, &mut unobserved).unwrap();
    let [found, up] = upright.to_surface(OUTCROP, 0.01, &motion, &mut unobserved).unwrap();
    for (a, b) in found.samples.iter().zip(&wanted.samples) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!(up.samples.iter().all(|a| a.abs() < 1e-12));

    let record = Record::new(0.01, motion).unwrap();
    let angle = 0.5;
    let bare = InclinedWave::sh(SoilProfile::on_half_plane(rock()), angle).unwrap();
    let found = bare.field(OUTCROP, &record, -3.0).unwrap().with_azimuth(0.7).unwrap();
    let plane = PlaneWave::sh(rock(), angle).unwrap();
    let plane = plane.field_from_across(&record, -3.0).unwrap().with_azimuth(0.7).unwrap();
    for time in [0.5, 2.0, 6.5] {
        let pair = [&found, &plane].map(|field| field.displacement_at([2.0, 1.0], time));
        let off = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9 && pair[1][0] != 0.0, "{pair:?}");
    }

    // Nothing moves up; a layer stiffer than the base has no refracted wave beyond its critical angle.
    assert!(upright.transfer(InclinedControl::OutcropVertical, 1.0).is_err());
    let covered = SoilProfile::on_half_plane(soft()).with_layer(rock(), 4.0).unwrap();
    let wave = InclinedWave::sh(covered, 0.4).unwrap();
    assert!(wave.transfer(OUTCROP, 3.0).unwrap()[0].abs() > 0.0);
    let error = wave.field(OUTCROP, &record, 0.0).err().unwrap();
    let Error::Soil(SoilError::BeyondCritical { layer, limit, .. }) = error else {
        panic!("{error}")
    };
    assert!(layer == 1 && (limit * 600.0 - 1.0).abs() < 1e-9);
}

/// A rigid mat, small beside the wave, turns as the ground under it does: by half of ∂u_y/∂x = −p v.
#[test]
fn a_mat_twists_by_half_the_slope() {
    let profile = SoilProfile::on_half_plane(rock()).with_layer(soft(), 20.0).unwrap();
    let wave = InclinedWave::sh(profile.clone(), 0.8).unwrap();
    let slow = (0..1500).map(|i| if i < 400 { (TAU * f64::from(i) / 400.0).sin() } else { 0.0 });
    let record = Record::new(0.01, slow.collect()).unwrap();
    let body = RigidBody::cuboid([8.0, 8.0, 0.1], 100.0).unwrap();
    let ground = ElasticGround::under(profile, &body, 6).unwrap();
    let field = || wave.field(OUTCROP, &record, -5.0).unwrap();
    let free = field();
    let mut simulation = Simulation::builder(0.02)
        .structure(body)
        .ground(ground)
        .interface(Bonded)
        .motion(field())
        .build()
        .unwrap();
    let (mut off, mut largest) = (0.0_f64, 0.0_f64);
    let run = simulation
        .run(300, |state| {
            let [ahead, behind] =
                [0.1, -0.1].map(|x| free.displacement_at([x, 0.0], state.time)[1]);
            let half = 0.5 * (ahead - behind) / 0.2;
            off = off.max((state.foundations[0].twist - half).abs());
            largest = largest.max(half.abs());
        })
        .unwrap();
    println!("{off:e} of {largest:e}");
    assert!(largest > 1e-4 && off < 0.01 * largest, "{off:e} of {largest:e}");
    assert!(run.energy_error < 1e-9 && run.whole.base_rotation.magnitude() < 1e-3 * largest);
}
