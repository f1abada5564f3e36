//! GOAL: vertically travelling waves reach the surface as they should, and go back.
//! SCENE: damped and elastic layers on rock and on a rigid base.
//! REFERENCE: a table of another program, sums of reflections, the motion itself.

use basemat::motion::{Record, el_centro_1940};
use basemat::site::{ControlPoint, SiteWarning, SoilColumn, VerticalWave};
use basemat::soil::SoilError;
use basemat::soil::{GeneralizedMaxwell, Hysteretic, SoilProfile};
use basemat::{Complex, Error, Soil, unobserved};

use basemat_problems::profiles::p1;

/// `amplification_1d.csv`: surface over outcrop, hysteretic damping.
#[test]
fn amplification_matches_the_table() {
    let damping = |ratio: f64| Hysteretic::new(ratio).unwrap();
    let column = SoilColumn::new(p1(damping(0.05), damping(0.01)), VerticalWave::Shear).unwrap();
    let table = include_str!("../data/layered/amplification_1d.csv");
    let (mut worst, mut rows) = (0.0_f64, 0);
    for line in table.lines().filter(|line| line.starts_with("P1")) {
        let n: Vec<f64> = line.split(',').skip(1).map(|x| x.parse().unwrap()).collect();
        let found = column.transfer(ControlPoint::Outcrop, n[0] / std::f64::consts::TAU).unwrap();
        let wanted = Complex::new(n[1], n[2]);
        worst = worst.max((found - wanted).abs() / wanted.abs());
        rows += 1;
    }
    println!("{rows} frequencies: {worst:e}");
    assert_eq!(rows, 160);
    assert!(worst < 1e-10, "{worst:e}");
}

fn ricker(t: f64) -> f64 {
    let a = ((t - 1.5) / 0.2).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// One elastic layer on rock: the pulse arrives h/c late and then comes back −r times after each 2h/c.
#[test]
fn reflections_in_an_elastic_layer() {
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let rock = Soil::from_shear_wave_speed(600.0, 0.25, 2200.0).unwrap();
    let height = 35.0;
    let profile = SoilProfile::on_half_plane(rock).with_layer(layer, height).unwrap();
    let (dt, count) = (0.01, 1500);
    let motion: Vec<f64> = (0..count).map(|i| ricker(dt * i as f64)).collect();
    for (wave, speeds) in [
        (VerticalWave::Shear, [layer.shear_wave_speed(), rock.shear_wave_speed()]),
        (VerticalWave::Pressure, [layer.pressure_wave_speed(), rock.pressure_wave_speed()]),
    ] {
        let column = SoilColumn::new(profile.clone(), wave).unwrap();
        let surface =
            column.to_surface(ControlPoint::Outcrop, dt, &motion, &mut unobserved).unwrap().samples;
        let within = column
            .from_surface(ControlPoint::Within, dt, &surface, &mut unobserved)
            .unwrap()
            .samples;
        let ratio = layer.density() * speeds[0] / (rock.density() * speeds[1]);
        let (r, travel) = ((1.0 - ratio) / (1.0 + ratio), height / speeds[0]);
        let wanted = |t: f64| -> f64 {
            (0..400_i32)
                .map(|m| (-r).powi(m) * ricker(t - f64::from(2 * m + 1) * travel))
                .sum::<f64>()
                * 2.0
                / (1.0 + ratio)
        };
        let mut worst = [0.0_f64; 2];
        for i in 0..count {
            let t = dt * i as f64;
            worst[0] = worst[0].max((surface[i] - wanted(t)).abs());
            let below = 0.5 * (wanted(t - travel) + wanted(t + travel));
            worst[1] = worst[1].max((within[i] - below).abs());
        }
        println!("{wave:?}: surface {:e}, within {:e}", worst[0], worst[1]);
        assert!(worst[0] < 1e-9 && worst[1] < 1e-9, "{wave:?} {worst:?}");
    }
}

/// An elastic layer on a rigid base never comes to rest: nothing of it may wrap around.
#[test]
fn reflections_on_a_rigid_base_never_end() {
    let layer = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(layer, 35.0).unwrap();
    let column = SoilColumn::new(profile, VerticalWave::Shear).unwrap();
    let (dt, count, travel) = (0.01, 1500, 35.0 / 200.0);
    let motion: Vec<f64> = (0..count).map(|i| ricker(dt * f64::from(i))).collect();
    let surface =
        column.to_surface(ControlPoint::Outcrop, dt, &motion, &mut unobserved).unwrap().samples;
    let mut worst = 0.0_f64;
    for (i, surface) in surface.iter().enumerate() {
        let late = |m: i32| ricker(dt * i as f64 - f64::from(2 * m + 1) * travel);
        let wanted: f64 = (0..60).map(|m| 2.0 * (-1.0_f64).powi(m) * late(m)).sum();
        worst = worst.max((surface - wanted).abs());
    }
    println!("{worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
}

/// There and back again, through damped layers, with a record that ends at rest.
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
                let back =
                    column.from_surface(control, 0.005, &surface.samples, &mut unobserved).unwrap();
                let worst = motion
                    .iter()
                    .zip(&back.samples)
                    .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                let change = motion
                    .iter()
                    .zip(&surface.samples)
                    .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                println!("{wave:?} {control:?}: {worst:e}");
                assert!(worst < 1e-8 && change > 0.05, "{wave:?} {control:?} {worst:e} {change}");
            }
        }
    }
}

#[test]
fn bad_motions_are_refused() {
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
    let found = column.to_surface(control, 0.1, &[1.0], &mut unobserved);
    assert!(matches!(found, Err(Error::Soil(SoilError::NotCausal { layer: 1, .. }))));
    assert!(found.unwrap_err().to_string().contains("GeneralizedMaxwell"));
}

/// El Centro taken down through 100 m of soft, damped soil: noise at the highest frequencies, which a low-pass removes.
/// Firm soil deconvolves without a warning.
#[test]
fn deconvolution_warns_of_what_it_amplifies() {
    let rock = Soil::from_shear_wave_speed(760.0, 0.25, 2200.0).unwrap();
    let column = |speed: f64, depth: f64, ratio: f64| {
        let soil = Soil::from_shear_wave_speed(speed, 0.4, 1700.0).unwrap();
        let law = GeneralizedMaxwell::constant_q(ratio, [0.2, 30.0], 1.0).unwrap();
        let profile = SoilProfile::on_half_plane(rock).with_layer(soil, depth).unwrap();
        SoilColumn::new(profile.with_damping(law), VerticalWave::Shear).unwrap()
    };
    let record = el_centro_1940().padded(10.0, 40.0).unwrap();
    let down = |column: &SoilColumn, record: &Record| {
        let samples = record.accelerations();
        column
            .from_surface(ControlPoint::Outcrop, record.time_step(), samples, &mut unobserved)
            .unwrap()
    };
    let soft = column(100.0, 100.0, 0.15);
    let found = down(&soft, &record);
    assert!(found.peak() > 1e5);
    let Some(SiteWarning::Amplified { frequency }) = found.warning() else { panic!("{found}") };
    // There the way down amplifies a hundredfold, and above it more.
    let gain = |frequency| soft.transfer(ControlPoint::Outcrop, frequency).unwrap().abs().recip();
    assert!((gain(frequency) / 100.0 - 1.0).abs() < 0.05, "{frequency} {}", gain(frequency));
    assert!(gain(2.0 * frequency) > 1e3 && gain(0.8 * frequency) < 100.0);
    let filtered = record.low_pass(0.5 * frequency, 8).unwrap();
    let calm = down(&soft, &filtered);
    assert_eq!(calm.warning(), None);
    assert!(calm.peak() < 1e-3 * found.peak(), "{calm}");
    let firm = column(300.0, 30.0, 0.05);
    assert_eq!(down(&firm, &record).warning(), None);
    let samples = record.accelerations();
    let up = soft
        .to_surface(ControlPoint::Outcrop, record.time_step(), samples, &mut unobserved)
        .unwrap();
    assert_eq!(up.warning(), None);
}
