//! GOAL: SH waves at an angle move the surface of layered ground correctly, and twist a mat.
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

const OUTCROP_HORIZONTAL: InclinedControl = InclinedControl::OutcropHorizontal;

/// SH waves of a soil with vertical slowness b = √(ρ/μ − p²).
struct ShWave {
    /// μ b.
    impedance: Complex,
    /// s b.
    exponent: Complex,
}

impl ShWave {
    fn new(soil: Soil, law: &dyn Relaxation, p: f64, s: Complex) -> Self {
        let modulus = law.modulus(s) * soil.shear_modulus();
        let b = (Complex::real(soil.density()) / modulus - Complex::real(p * p)).sqrt();
        let b = if (s * b).re < -1e-12 * (s * b).abs() { -b } else { b };
        Self { impedance: modulus * b, exponent: s * b }
    }
}

/// GOAL: one layer on a half-plane, softer or stiffer than it, has its closed form.
/// REFERENCE: surface over outcrop 1/(cosh(s b h) + (μ b)/(μ′ b′) sinh(s b h)).
#[test]
fn one_layer_has_its_closed_form() {
    let height = 6.0;
    let mut largest_error = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    for [above, below] in [[soft(), rock()], [rock(), soft()]] {
        for (profile, laws) in one_layer(above, below, height) {
            for angle in [-50.0_f64, 0.0, 12.0, 25.0, 40.0, 60.0, 85.0] {
                let wave = InclinedWave::sh(profile.clone(), angle.to_radians()).unwrap();
                let p = 1.0 / wave.apparent_velocity();
                for frequency in [0.2, 1.7, 6.0, 14.0, 33.0] {
                    let s = Complex::new(0.0, TAU * frequency);
                    let layer = ShWave::new(above, &*laws[0], p, s);
                    let base = ShWave::new(below, &*laws[1], p, s);
                    let up = (layer.exponent * height).exp();
                    let downward_factor = (layer.exponent * -height).exp();
                    let ratio = layer.impedance / base.impedance;
                    let expected = ((up + downward_factor) * 0.5
                        + ratio * (up - downward_factor) * 0.5)
                        .inverse();
                    let over_outcrop = wave.transfer(OUTCROP_HORIZONTAL, frequency).unwrap();
                    let over_incident =
                        wave.transfer(InclinedControl::Incident, frequency).unwrap();
                    for error in [over_outcrop[0] - expected, over_incident[0] - expected * 2.0] {
                        largest_error = largest_error.max(error.abs() / expected.abs());
                    }
                    assert_eq!(over_outcrop[1], Complex::default());
                    max_magnitude = max_magnitude.max(expected.abs());
                }
            }
        }
    }
    println!("{largest_error:e}, largest {max_magnitude}");
    assert!(largest_error < 1e-11 && max_magnitude > 4.0, "{largest_error:e} {max_magnitude}");
}

/// GOAL: at an angle of zero a wave is that of the column; without layers it is a plane wave of the half-plane.
#[test]
fn vertical_waves_are_those_of_columns_and_bare_rock_has_plane_waves() {
    let layered = two_layers(constant_q(0.05), constant_q(0.02));
    let column = SoilColumn::new(layered.clone(), VerticalWave::Shear).unwrap();
    let vertical_wave = InclinedWave::sh(layered.clone(), 0.0).unwrap();
    let motion: Vec<f64> = (0..900).map(|i| (0.3 * f64::from(i)).sin()).collect();
    let expected =
        column.to_surface(ControlPoint::Outcrop, 0.01, &motion, &mut unobserved).unwrap();
    let computed =
        vertical_wave.to_surface(OUTCROP_HORIZONTAL, 0.01, &motion, &mut unobserved).unwrap();
    for (a, b) in computed[0].samples.iter().zip(&expected.samples) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!(computed[1].samples.iter().all(|a| a.abs() < 1e-12));

    let record = Record::new(0.01, motion).unwrap();
    let angle = 0.5;
    let without_layers = InclinedWave::sh(SoilProfile::on_half_plane(rock()), angle).unwrap();
    let field = without_layers.field(OUTCROP_HORIZONTAL, &record, -3.0).unwrap();
    let field = field.with_azimuth(0.7).unwrap();
    let plane_wave = PlaneWave::sh(rock(), angle).unwrap();
    let reference = plane_wave.field_from_across(&record, -3.0).unwrap();
    let reference = reference.with_azimuth(0.7).unwrap();
    for time in [0.5, 2.0, 6.5] {
        let computed = field.displacement_at([2.0, 1.0], time);
        let expected = reference.displacement_at([2.0, 1.0], time);
        for (a, b) in computed.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-9, "{computed:?} {expected:?}");
        }
        assert!(expected[0] != 0.0);
    }

    // SH waves have no vertical motion; a layer stiffer than the base has no refracted wave beyond its critical angle.
    assert!(vertical_wave.transfer(InclinedControl::OutcropVertical, 1.0).is_err());
    let covered = SoilProfile::on_half_plane(soft()).with_layer(rock(), 4.0).unwrap();
    let wave = InclinedWave::sh(covered, 0.4).unwrap();
    assert!(wave.transfer(OUTCROP_HORIZONTAL, 3.0).unwrap()[0].abs() > 0.0);
    let error = wave.field(OUTCROP_HORIZONTAL, &record, 0.0).err().unwrap();
    let Error::Soil(SoilError::BeyondCritical { layer, limit, .. }) = error else {
        panic!("{error}")
    };
    assert!(layer == 1 && (limit * 600.0 - 1.0).abs() < 1e-9);
}

/// GOAL: a rigid mat, small beside the wave, rotates with the ground under it: by half of ∂u_y/∂x = −p v.
#[test]
fn a_mat_twists_by_half_the_slope() {
    let profile = SoilProfile::on_half_plane(rock()).with_layer(soft(), 20.0).unwrap();
    let wave = InclinedWave::sh(profile.clone(), 0.8).unwrap();
    let one_sine =
        (0..1500).map(|i| if i < 400 { (TAU * f64::from(i) / 400.0).sin() } else { 0.0 });
    let record = Record::new(0.01, one_sine.collect()).unwrap();
    let body = RigidBody::cuboid([8.0, 8.0, 0.1], 100.0).unwrap();
    let ground = ElasticGround::under(profile, &body, 6).unwrap();
    let free_field = wave.field(OUTCROP_HORIZONTAL, &record, -5.0).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(body)
        .ground(ground)
        .interface(Bonded)
        .motion(wave.field(OUTCROP_HORIZONTAL, &record, -5.0).unwrap())
        .build()
        .unwrap();
    let mut largest_error = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    let run = simulation
        .run(300, |state| {
            let forward_displacement = free_field.displacement_at([0.1, 0.0], state.time)[1];
            let backward_displacement = free_field.displacement_at([-0.1, 0.0], state.time)[1];
            let expected = 0.5 * (forward_displacement - backward_displacement) / 0.2;
            largest_error = largest_error.max((state.foundations[0].twist - expected).abs());
            max_magnitude = max_magnitude.max(expected.abs());
        })
        .unwrap();
    println!("{largest_error:e} of {max_magnitude:e}");
    assert!(
        max_magnitude > 1e-4 && largest_error < 0.01 * max_magnitude,
        "{largest_error:e} of {max_magnitude:e}"
    );
    assert!(run.energy_error < 1e-9 && run.whole.base_rotation.magnitude() < 1e-3 * max_magnitude);
}
