//! GOAL: vertical waves move the surface correctly, and deconvolution recovers them.
//! SCENE: damped and elastic layers on rock and on a rigid base.
//! REFERENCE: a table of another program, sums of reflections, the motion itself.

use basemat::motion::{Record, el_centro_1940};
use basemat::site::{ControlPoint, SiteMotion, SiteWarning, SoilColumn, VerticalWave};
use basemat::soil::SoilError;
use basemat::soil::{GeneralizedMaxwell, Hysteretic, SoilProfile};
use basemat::{Complex, Error, Soil, unobserved};

use basemat_problems::profiles::p1;

/// GOAL: the transfer function from the outcrop to the surface of a hysteretic layer agrees with a table.
/// REFERENCE: `amplification_1d.csv` by another program.
#[test]
fn amplification_matches_the_table() {
    let layer_on_rock = p1(Hysteretic::new(0.05).unwrap(), Hysteretic::new(0.01).unwrap());
    let column = SoilColumn::new(layer_on_rock, VerticalWave::Shear).unwrap();
    let table = include_str!("../data/layered/amplification_1d.csv");
    let mut largest_error = 0.0_f64;
    let mut rows = 0;
    for line in table.lines().filter(|line| line.starts_with("P1")) {
        let fields: Vec<f64> = line.split(',').skip(1).map(|x| x.parse().unwrap()).collect();
        let frequency = fields[0] / std::f64::consts::TAU;
        let computed = column.transfer(ControlPoint::Outcrop, frequency).unwrap();
        let expected = Complex::new(fields[1], fields[2]);
        largest_error = largest_error.max((computed - expected).abs() / expected.abs());
        rows += 1;
    }
    println!("{rows} frequencies: {largest_error:e}");
    assert_eq!(rows, 160);
    assert!(largest_error < 1e-10, "{largest_error:e}");
}

fn ricker(t: f64) -> f64 {
    let a = ((t - 1.5) / 0.2).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// Time between samples of the pulses, s.
const TIME_STEP: f64 = 0.01;

/// 15 s of the Ricker pulse.
fn ricker_samples() -> Vec<f64> {
    (0..1500).map(|i| ricker(TIME_STEP * f64::from(i))).collect()
}

/// Motion of the surface of an elastic layer by its reflections.
struct ReflectedPulse {
    /// Impedance of the layer over the rock's.
    impedance_ratio: f64,
    /// Travel time through the layer.
    travel_time: f64,
}

impl ReflectedPulse {
    fn at_surface(&self, t: f64) -> f64 {
        let r = (1.0 - self.impedance_ratio) / (1.0 + self.impedance_ratio);
        (0..400_i32)
            .map(|m| (-r).powi(m) * ricker(t - f64::from(2 * m + 1) * self.travel_time))
            .sum::<f64>()
            * 2.0
            / (1.0 + self.impedance_ratio)
    }

    fn at_bottom(&self, t: f64) -> f64 {
        0.5 * (self.at_surface(t - self.travel_time) + self.at_surface(t + self.travel_time))
    }
}

/// GOAL: a pulse passes through one elastic layer on rock, up to the surface and down again.
/// REFERENCE: the pulse arrives after h/c, then returns −r times as large after each 2h/c.
#[test]
fn reflections_in_an_elastic_layer_are_those_of_theory() {
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0).unwrap();
    let height = 35.0;
    let profile = SoilProfile::on_half_plane(rock).with_layer(layer, height).unwrap();
    let motion = ricker_samples();
    for (wave, speeds) in [
        (VerticalWave::Shear, [layer.shear_wave_speed(), rock.shear_wave_speed()]),
        (VerticalWave::Pressure, [layer.pressure_wave_speed(), rock.pressure_wave_speed()]),
    ] {
        let column = SoilColumn::new(profile.clone(), wave).unwrap();
        let surface = column
            .to_surface(ControlPoint::Outcrop, TIME_STEP, &motion, &mut unobserved)
            .unwrap()
            .samples;
        let motion_within = column
            .from_surface(ControlPoint::Within, TIME_STEP, &surface, &mut unobserved)
            .unwrap()
            .samples;
        let expected = ReflectedPulse {
            impedance_ratio: layer.density() * speeds[0] / (rock.density() * speeds[1]),
            travel_time: height / speeds[0],
        };
        let mut surface_error = 0.0_f64;
        let mut within_error = 0.0_f64;
        for i in 0..motion.len() {
            let t = TIME_STEP * i as f64;
            surface_error = surface_error.max((surface[i] - expected.at_surface(t)).abs());
            within_error = within_error.max((motion_within[i] - expected.at_bottom(t)).abs());
        }
        println!("{wave:?}: surface {surface_error:e}, within {within_error:e}");
        assert!(surface_error < 1e-9, "{wave:?} {surface_error:e}");
        assert!(within_error < 1e-9, "{wave:?} {within_error:e}");
    }
}

/// GOAL: an elastic layer on a rigid base never comes to rest, and no part of its motion wraps around.
#[test]
fn reflections_on_a_rigid_base_never_end() {
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(layer, 35.0).unwrap();
    let column = SoilColumn::new(profile, VerticalWave::Shear).unwrap();
    let travel_time = 35.0 / 200.0;
    let motion = ricker_samples();
    let surface = column
        .to_surface(ControlPoint::Outcrop, TIME_STEP, &motion, &mut unobserved)
        .unwrap()
        .samples;
    let mut largest_error = 0.0_f64;
    for (i, surface) in surface.iter().enumerate() {
        let expected: f64 = (0..60)
            .map(|m| {
                let delayed_pulse =
                    ricker(TIME_STEP * i as f64 - f64::from(2 * m + 1) * travel_time);
                2.0 * (-1.0_f64).powi(m) * delayed_pulse
            })
            .sum();
        largest_error = largest_error.max((surface - expected).abs());
    }
    println!("{largest_error:e}");
    assert!(largest_error < 1e-7, "{largest_error:e}");
}

/// Largest difference of two motions.
fn largest_difference(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
}

/// GOAL: deconvolution recovers a motion that passed damped layers and ends at rest.
#[test]
fn deconvolution_undoes_convolution() {
    let law = GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0).unwrap();
    let soil = Soil::from_shear_wave_speed(150.0, 0.4, 1800.0).unwrap();
    let rock = Soil::from_shear_wave_speed(800.0, 0.25, 2300.0).unwrap();
    let on_rock = SoilProfile::on_half_plane(rock);
    for base in [on_rock, SoilProfile::on_rigid_bedrock()] {
        let profile = base
            .with_layer(soil, 5.0)
            .unwrap()
            .with_damping(law.clone())
            .with_layer(Soil::from_shear_wave_speed(90.0, 0.45, 1600.0).unwrap(), 4.0)
            .unwrap()
            .with_damping(law.clone());
        let motion: Vec<f64> = (0..12_001).map(|i| ricker(0.005 * f64::from(i))).collect();
        for wave in [VerticalWave::Shear, VerticalWave::Pressure] {
            let column = SoilColumn::new(profile.clone(), wave).unwrap();
            for control in [ControlPoint::Outcrop, ControlPoint::Within] {
                let surface = column.to_surface(control, 0.005, &motion, &mut unobserved).unwrap();
                let recovered_motion =
                    column.from_surface(control, 0.005, &surface.samples, &mut unobserved).unwrap();
                let error = largest_difference(&motion, &recovered_motion.samples);
                let change = largest_difference(&motion, &surface.samples);
                println!("{wave:?} {control:?}: {error:e}");
                assert!(error < 1e-8 && change > 0.05, "{wave:?} {control:?} {error:e} {change}");
            }
        }
    }
}

/// GOAL: motions, frequencies and profiles out of range are errors.
#[test]
fn invalid_motions_are_errors() {
    let soil = Soil::from_shear_wave_speed(150.0, 0.4, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 5.0).unwrap();
    let column = SoilColumn::new(profile.clone(), VerticalWave::Shear).unwrap();
    let control = ControlPoint::Within;
    for (step, motion) in [
        (0.0, vec![1.0]),
        (f64::NAN, vec![1.0]),
        (0.1, vec![]),
        (0.1, vec![f64::NAN]),
        (1e-320, vec![1.0]),
    ] {
        assert!(
            column.to_surface(control, step, &motion, &mut unobserved).is_err(),
            "{step} {motion:?}"
        );
    }
    assert!(column.transfer(control, -1.0).is_err());
    assert!(column.transfer(control, f64::NAN).is_err());
    assert!(SoilColumn::new(SoilProfile::on_rigid_bedrock(), VerticalWave::Shear).is_err());
    let profile = profile.with_damping(Hysteretic::new(0.05).unwrap());
    let column = SoilColumn::new(profile, VerticalWave::Shear).unwrap();
    let result = column.to_surface(control, 0.1, &[1.0], &mut unobserved);
    assert!(matches!(result, Err(Error::Soil(SoilError::NotCausal { layer: 1, .. }))));
    assert!(result.unwrap_err().to_string().contains("GeneralizedMaxwell"));
}

/// One damped layer on rock.
fn damped_layer(speed: f64, thickness: f64, damping_ratio: f64) -> SoilColumn {
    let rock = Soil::from_shear_wave_speed(760.0, 0.25, 2200.0).unwrap();
    let soil = Soil::from_shear_wave_speed(speed, 0.4, 1700.0).unwrap();
    let law = GeneralizedMaxwell::constant_q(damping_ratio, [0.2, 30.0], 1.0).unwrap();
    let profile = SoilProfile::on_half_plane(rock).with_layer(soil, thickness).unwrap();
    SoilColumn::new(profile.with_damping(law), VerticalWave::Shear).unwrap()
}

/// Outcrop motion of a record of the surface.
fn deconvolved(column: &SoilColumn, record: &Record) -> SiteMotion {
    let samples = record.accelerations();
    column
        .from_surface(ControlPoint::Outcrop, record.time_step(), samples, &mut unobserved)
        .unwrap()
}

/// GOAL: deconvolution warns of the frequency above which it amplifies noise; a low-pass filter or firm soil avoids it.
/// SCENE: El Centro at the surface of 100 m of soft, damped soil.
#[test]
fn amplification_by_deconvolution_causes_a_warning() {
    let record = el_centro_1940().padded(10.0, 40.0).unwrap();
    let soft_column = damped_layer(100.0, 100.0, 0.15);
    let motion_with_noise = deconvolved(&soft_column, &record);
    assert!(motion_with_noise.peak() > 1e5);
    let Some(SiteWarning::Amplified { frequency }) = motion_with_noise.warning() else {
        panic!("{motion_with_noise}")
    };
    // At this frequency deconvolution amplifies a hundredfold, and above it more.
    let [below, gain, above] = [0.8, 1.0, 2.0].map(|ratio| {
        soft_column.transfer(ControlPoint::Outcrop, ratio * frequency).unwrap().abs().recip()
    });
    assert!((gain / 100.0 - 1.0).abs() < 0.05, "{frequency} {gain}");
    assert!(above > 1e3 && below < 100.0);
    let motion_of_filtered_record =
        deconvolved(&soft_column, &record.low_pass(0.5 * frequency, 8).unwrap());
    assert_eq!(motion_of_filtered_record.warning(), None);
    assert!(
        motion_of_filtered_record.peak() < 1e-3 * motion_with_noise.peak(),
        "{motion_of_filtered_record}"
    );
    let firm_column = damped_layer(300.0, 30.0, 0.05);
    assert_eq!(deconvolved(&firm_column, &record).warning(), None);
    let samples = record.accelerations();
    let up = soft_column
        .to_surface(ControlPoint::Outcrop, record.time_step(), samples, &mut unobserved)
        .unwrap();
    assert_eq!(up.warning(), None);
}
