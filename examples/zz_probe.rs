use basemat::bem::{PatchKernel, Strip};
use basemat::history::*;
use std::sync::Arc;
use std::time::Instant;
fn main() {
    let soil = basemat::Soil::from_wave_speeds(198.12, 396.24, 1804.0).unwrap();
    for q in [4usize, 10, 40, 100] {
        let el = 0.4572;
        let half = 0.5 * el * q as f64;
        let strip = Strip::uniform(-half..half, q).unwrap();
        let dt = 0.5 * el / 396.24;
        for tol in [1e-10, 1e-12] {
            let kernel = Arc::new(PatchKernel::new(soil, strip.elements(), dt).unwrap());
            let t = Instant::now();
            match ExponentialHistory::new(kernel, tol) {
                Ok(mut h) => {
                    let made = t.elapsed().as_secs_f64();
                    let mut d = vec![0.0; 2 * q];
                    let t = Instant::now();
                    let n = 4000;
                    for i in 0..n {
                        h.evaluate(&mut d).unwrap();
                        let tr: Vec<f64> = (0..2 * q).map(|k| ((i * k) as f64).sin()).collect();
                        h.push(&tr);
                    }
                    println!(
                        "{q} {tol:e} made {made:.3} s, step {:.2} us, window {} poles {} functions {} margin {:.3} err {:.1e} mem {} d {}",
                        t.elapsed().as_secs_f64() / n as f64 * 1e6,
                        h.window(),
                        h.poles(),
                        h.functions(),
                        h.passivity_margin(),
                        h.error_bound(),
                        h.memory(),
                        d[0]
                    );
                }
                Err(e) => println!("{q} {tol:e} {e}"),
            }
        }
    }
}
