macro_rules! TO {
    ($c:expr,$a:expr,$b:expr,$d:expr) => {
        $c.to_surface($a, $b, $d, &mut basemat::unobserved)
    };
}
macro_rules! EL {
    ($c:expr,$a:expr,$b:expr,$d:expr) => {
        $c.equivalent_linear($a, $b, $d, &mut basemat::unobserved)
    };
}
use basemat::Soil;
use basemat::motion::Record;
use basemat::site::*;
use basemat::soil::*;
use std::time::Instant;
fn main() {
    let n = 28000;
    let dt = 0.005;
    let m: Vec<f64> = (0..n)
        .map(|i| {
            let t = i as f64 * dt;
            (t / 8.0).min(1.0)
                * (-(t - 8.0).max(0.0) / 10.0).exp()
                * ((7.3 * t).sin() + 0.5 * (17.0 * t).sin())
        })
        .collect();
    for kind in ["shared", "each"] {
        let mut p =
            SoilProfile::on_half_plane(Soil::from_shear_wave_speed(800.0, 0.25, 2300.0).unwrap())
                .with_base_damping(GeneralizedMaxwell::constant_q(0.01, [0.1, 30.0], 1.0).unwrap());
        for i in 0..50 {
            let r = if kind == "shared" { 0.03 } else { 0.03 + 0.0004 * i as f64 };
            p = p
                .with_layer(
                    Soil::from_shear_wave_speed(150.0 + 8.0 * i as f64, 0.35, 1900.0).unwrap(),
                    1.0,
                )
                .unwrap()
                .with_damping(GeneralizedMaxwell::constant_q(r, [0.1, 30.0], 1.0).unwrap());
        }
        let c = SoilColumn::new(p, VerticalWave::Shear).unwrap();
        for _ in 0..3 {
            let t = Instant::now();
            let s = TO!(c, ControlPoint::Outcrop, dt, &m).unwrap();
            println!(
                "to_surface {kind} {:.3} s {}",
                t.elapsed().as_secs_f64(),
                s.samples.iter().map(|x| x.abs()).sum::<f64>()
            );
        }
        if kind == "each" {
            let rec = Record::new(dt, m.clone()).unwrap();
            let curves = vec![StrainCurves::VuceticDobry { plasticity_index: 30.0 }; 50];
            let o = EquivalentLinearOptions::of_magnitude(6.9);
            for _ in 0..2 {
                let t = Instant::now();
                let s = EL!(c, &rec, &curves, &o).unwrap();
                println!(
                    "equivalent_linear {:.3} s, {} iterations {}",
                    t.elapsed().as_secs_f64(),
                    s.iterations,
                    s.peak_accelerations[0]
                );
            }
        }
    }
}
