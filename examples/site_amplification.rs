//! Transfer function from rock to the surface of a damped soil profile, as a table.
//!
//! `cargo run --release --example site_amplification`
//!
//! Lines `layer` hold thickness (m), shear wave speed (m/s), density (kg/m³) and damping ratio from the
//! surface down; the half-plane has no thickness. Lines `transfer` hold frequency (Hz) and the real and
//! imaginary parts of two transfer functions: to the surface from the rock's outcrop, and from the rock
//! within.

use basemat::Result;
use basemat::prelude::*;
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{Hysteretic, SoilProfile};

/// Thickness, speed, density, damping ratio.
const LAYERS: [[f64; 4]; 4] = [
    [3.0, 140.0, 1700.0, 0.05],
    [7.5, 220.0, 1850.0, 0.03],
    [4.0, 160.0, 1750.0, 0.08],
    [12.0, 380.0, 2000.0, 0.02],
];
const ROCK: [f64; 3] = [800.0, 2300.0, 0.01];

fn main() -> Result<()> {
    let [speed, density, ratio] = ROCK;
    let rock = Soil::from_shear_wave_speed(speed, 0.25, density)?;
    let mut profile =
        SoilProfile::on_half_plane(rock).with_bedrock_damping(Hysteretic::new(ratio)?);
    for [thickness, speed, density, ratio] in LAYERS {
        let soil = Soil::from_shear_wave_speed(speed, 0.35, density)?;
        profile = profile.with_layer(soil, thickness)?.with_damping(Hysteretic::new(ratio)?);
        println!("layer,{thickness},{speed},{density},{ratio}");
    }
    println!("layer,,{speed},{density},{ratio}");
    let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    for i in 1..=250 {
        let frequency = 0.1 * f64::from(i);
        let outcrop = column.transfer(ControlPoint::Outcrop, frequency)?;
        let within = column.transfer(ControlPoint::Within, frequency)?;
        println!("transfer,{frequency},{},{},{},{}", outcrop.re, outcrop.im, within.re, within.im);
    }
    Ok(())
}
