//! Dynamic stiffness of a rigid strip over frequency: half-plane, layer on rock, layer on a rigid base.
//!
//! ```text
//! cargo run --release --example impedances
//! cargo run --release --example impedances -- --out somewhere
//! ```
//!
//! A strip 6 m wide is bonded to soil of 150 m/s: an undamped half-plane of it; 6 m of it with 5 %
//! damping on rock of 450 m/s with 1 %; the same 6 m on a rigid base. Every K(ω) is split into a spring Re K and
//! a dashpot Im K/ω beside it. The half-plane's dashpots are radiation alone. Those of the layers
//! contain the soil's own damping, and hardly anything else below the first frequency of the layer, 6.25 Hz: a
//! half-plane overestimates the damping of such a site.

use std::path::PathBuf;

use basemat::bem::layered::{LayeredGround, StripContact, StripImpedance};
use basemat::plot::{Curve, curves};
use basemat::prelude::*;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::{Error, Result};
use clap::Parser;

/// Half the strip's width, m.
const HALF: f64 = 3.0;
/// Elements, graded: errors below 1 %.
const ELEMENTS: usize = 24;
const COMPONENTS: [&str; 4] = ["hh", "vv", "rr", "hr"];

/// Impedances of a rigid strip.
#[derive(Parser)]
struct Options {
    /// Folder for the table and the pictures.
    #[arg(long, default_value = "target/impedances")]
    out: PathBuf,
}

/// K over μ, μ, μ B² and μ B, as tables have it.
fn normalized(found: &StripImpedance, soil: Soil) -> [[f64; 2]; 4] {
    let scales = [1.0, 1.0, HALF * HALF, HALF].map(|scale| soil.shear_modulus() * scale);
    let values = [found.horizontal, found.vertical, found.rocking, found.coupling];
    std::array::from_fn(|i| [values[i].re / scales[i], values[i].im / scales[i]])
}

fn main() -> Result<()> {
    let out = Options::parse().out;
    let soil = Soil::from_shear_wave_speed(150.0, 1.0 / 3.0, 1800.0)?;
    let rock = Soil::from_shear_wave_speed(450.0, 0.3, 2160.0)?;
    // Constant over the band; the soils' stiffness is that at 4 Hz.
    let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 4.0);
    let layer = |profile: SoilProfile| -> Result<SoilProfile> {
        Ok(profile.with_layer(soil, 2.0 * HALF)?.with_damping(damping(0.05)?))
    };
    let rock = layer(SoilProfile::on_half_plane(rock).with_base_damping(damping(0.01)?))?;
    let rigid = layer(SoilProfile::on_rigid_base())?;
    println!("layer on rock:\n{rock}\n\nlayer on a rigid base:\n{rigid}\n");

    // a₀ = ωB/c from 0.05 to 2.5.
    let unit = soil.shear_wave_speed() / (std::f64::consts::TAU * HALF);
    let frequencies: Vec<f64> = (1..=50).map(|i| 0.05 * f64::from(i) * unit).collect();
    let strip = -HALF..HALF;
    let contact = StripContact::Bonded;
    let cases = [
        (
            "half-plane",
            HalfPlaneGround::strip(soil, strip.clone(), ELEMENTS)?
                .impedances(&frequencies, contact)?,
        ),
        ("layer on rock, 5 %", impedances(rock, &frequencies)?),
        ("layer on a rigid base, 5 %", impedances(rigid, &frequencies)?),
    ];

    println!("K = Re K + i Im K over mu (hh, vv), mu B^2 (rr), mu B (hr); a0 = omega B/c");
    let mut csv = "ground,frequency_hz,a0".to_owned();
    for name in COMPONENTS {
        csv += &format!(",stiffness_{name},dashpot_{name}");
    }
    csv.push('\n');
    for (name, found) in &cases {
        println!(
            "\n{name}\n   f (Hz)    a0            hh              vv              rr              hr"
        );
        for (i, found) in found.iter().enumerate() {
            let a0 = found.frequency / unit;
            if i % 5 == 4 {
                print!("{:>9.2} {a0:>5.2}", found.frequency);
                for [re, im] in normalized(found, soil) {
                    print!("  {re:>6.3} {im:>+6.3}i");
                }
                println!();
            }
            csv += &format!("\"{name}\",{},{a0}", found.frequency);
            for (spring, dashpot) in found.stiffnesses().into_iter().zip(found.dashpots()) {
                csv += &format!(",{spring},{dashpot}");
            }
            csv.push('\n');
        }
    }
    for (i, name) in COMPONENTS.into_iter().enumerate() {
        let lines = |value: &dyn Fn(&StripImpedance) -> f64| -> Vec<Curve> {
            let points = |found: &[StripImpedance]| {
                found.iter().map(|found| (found.frequency, value(found))).collect()
            };
            let curve = |(name, found): &(&str, Vec<_>)| Curve {
                name: (*name).to_owned(),
                points: points(found),
            };
            cases.iter().map(curve).collect()
        };
        let unit = ["MN/m²", "MN/m²", "MN", "MN/m"][i];
        let springs = lines(&|found| 1e-6 * found.stiffnesses()[i]);
        curves(&format!("Spring Re K_{name}"), "frequency, Hz", unit, &springs)?
            .save(out.join(format!("spring_{name}.svg")))?;
        let dashpots = lines(&|found| 1e-6 * found.dashpots()[i]);
        curves(
            &format!("Dashpot Im K_{name}/ω"),
            "frequency, Hz",
            &format!("{unit} · s"),
            &dashpots,
        )?
        .save(out.join(format!("dashpot_{name}.svg")))?;
    }
    let file = out.join("impedances.csv");
    std::fs::write(&file, csv)
        .map_err(|error| Error::Write { file: file.display().to_string(), reason: error.kind() })?;
    println!("\ntable and pictures in {}", out.display());

    // Im K/μ of sway and heave at a₀ = 0.5 from tables of other programs.
    for ((name, found), wanted) in cases.iter().zip([[1.32, 2.02], [0.602, 0.934], [0.256, 0.490]])
    {
        let [hh, vv, ..] = normalized(&found[9], soil);
        for ([_, found], wanted) in [hh, vv].into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 0.01, "{name}: {found}, not {wanted}");
        }
    }
    Ok(())
}

fn impedances(profile: SoilProfile, frequencies: &[f64]) -> Result<Vec<StripImpedance>> {
    LayeredGround::strip(profile, -HALF..HALF, ELEMENTS)?
        .impedances(frequencies, StripContact::Bonded)
}
