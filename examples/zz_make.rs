use basemat::bem::{PatchKernel, Strip};
use basemat::history::*;
use std::sync::Arc;
fn main() {
    let soil = basemat::Soil::from_wave_speeds(198.12, 396.24, 1804.0).unwrap();
    let q: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let el = 0.4572;
    let half = 0.5 * el * q as f64;
    let strip = Strip::uniform(-half..half, q).unwrap();
    let dt = 0.5 * el / 396.24;
    for _ in 0..20 {
        let kernel = Arc::new(PatchKernel::new(soil, strip.elements(), dt).unwrap());
        let h = ExponentialHistory::new(kernel, 1e-12).unwrap();
        std::hint::black_box(&h);
    }
}
