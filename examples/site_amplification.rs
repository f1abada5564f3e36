//! Transfer function from rock to the surface of a damped soil profile, as a table.
//!
//! `cargo run --release --example site_amplification`
//!
//! Lines that begin with `layer` contain thickness (m), shear wave speed (m/s), density (kg/m³) and damping ratio from
//! the surface down; the half-plane has no thickness. Lines that begin with `transfer` contain the frequency (Hz) and
//! the real and imaginary parts of two transfer functions: from the motion of a rock outcrop to the surface, and from
//! the motion of the rock below the layers to the surface.

use basemat::Result;
use basemat::prelude::*;
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::{Hysteretic, SoilProfile};

/// Layers: thickness (m), shear wave speed (m/s), density (kg/m³) and damping ratio, from the surface down.
const SOIL_LAYERS: [[f64; 4]; 4] = [
    [3.0, 140.0, 1700.0, 0.05],
    [7.5, 220.0, 1850.0, 0.03],
    [4.0, 160.0, 1750.0, 0.08],
    [12.0, 380.0, 2000.0, 0.02],
];
/// Shear wave speed of the rock, m/s.
const ROCK_SPEED: f64 = 800.0;
/// Density of the rock, kg/m³.
const ROCK_DENSITY: f64 = 2300.0;
/// Damping ratio of the rock.
const ROCK_DAMPING: f64 = 0.01;

fn main() -> Result<()> {
    let rock = Soil::from_shear_wave_speed(ROCK_SPEED, 0.25, ROCK_DENSITY)?;
    let mut profile =
        SoilProfile::on_half_plane(rock).with_bedrock_damping(Hysteretic::new(ROCK_DAMPING)?);
    for [thickness, speed, density, ratio] in SOIL_LAYERS {
        let soil = Soil::from_shear_wave_speed(speed, 0.35, density)?;
        profile = profile.with_layer(soil, thickness)?.with_damping(Hysteretic::new(ratio)?);
        println!("layer,{thickness},{speed},{density},{ratio}");
    }
    println!("layer,,{ROCK_SPEED},{ROCK_DENSITY},{ROCK_DAMPING}");
    let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    for i in 1..=250 {
        let frequency = 0.1 * f64::from(i);
        let outcrop = column.transfer(ControlPoint::Outcrop, frequency)?;
        let transfer_within = column.transfer(ControlPoint::Within, frequency)?;
        println!(
            "transfer,{frequency},{},{},{},{}",
            outcrop.re, outcrop.im, transfer_within.re, transfer_within.im
        );
    }
    Ok(())
}
