//! Dynamic stiffness of a rigid strip over frequency: half-plane, layer on rock, layer on a rigid base.
//!
//! ```text
//! cargo run --release --example impedances
//! ```
//!
//! A strip 6 m wide is bonded to soil of 150 m/s in three cases: an undamped half-plane; a layer of 6 m with
//! 5 % damping on rock of 450 m/s with 1 %; and the same layer on a rigid base. Every K(ω) is split into a
//! spring Re K and a dashpot Im K/ω. The dashpots of the half-plane represent radiation damping only. The
//! dashpots of the layers contain the soil's own damping, and almost nothing else below the first frequency
//! of the layer, 6.25 Hz. A half-plane therefore overestimates the damping of such a site.

use std::error::Error;
use std::path::Path;

use basemat::bem::layered::{StripContact, StripImpedance};
use basemat::bem::{ElasticGround, Strip};
use basemat::plot::{Curve, curves};
use basemat::prelude::*;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::unobserved;

/// Half the strip's width, m.
const HALF: f64 = 3.0;
/// Number of elements, graded: errors below 1 %.
const ELEMENTS: usize = 24;
const COMPONENTS: [&str; 4] = ["hh", "vv", "rr", "hr"];

/// A ground's name and its impedances.
type Case = (&'static str, Vec<StripImpedance>);

/// K over μ, μ, μ B² and μ B, as in published tables: real and imaginary parts.
fn normalized(found: &StripImpedance, soil: Soil) -> [[f64; 2]; 4] {
    let scales = [1.0, 1.0, HALF * HALF, HALF].map(|scale| soil.shear_modulus() * scale);
    let values = [found.horizontal, found.vertical, found.rocking, found.coupling];
    std::array::from_fn(|i| [values[i].re / scales[i], values[i].im / scales[i]])
}

fn print(cases: &[Case], soil: Soil, unit: f64) {
    println!("K over mu (hh, vv), mu B^2 (rr), mu B (hr); a0 = omega B/c");
    for (name, found) in cases {
        println!(
            "\n{name}\n   f (Hz)   a0             hh              vv              rr              hr"
        );
        for found in found.iter().skip(4).step_by(5) {
            print!("{:>9.2} {:>4.2}", found.frequency, found.frequency / unit);
            for [re, im] in normalized(found, soil) {
                print!("  {re:>6.3} {im:>+6.3}i");
            }
            println!();
        }
    }
}

fn draw(cases: &[Case], out: &Path) -> basemat::Result<()> {
    for (i, (name, unit)) in
        COMPONENTS.into_iter().zip(["MN/m²", "MN/m²", "MN", "MN/m"]).enumerate()
    {
        let lines = |value: &dyn Fn(&StripImpedance) -> [f64; 4]| -> Vec<Curve> {
            let point = |found: &StripImpedance| (found.frequency, 1e-6 * value(found)[i]);
            let curve = |(name, found): &Case| Curve {
                name: (*name).to_owned(),
                points: found.iter().map(point).collect(),
            };
            cases.iter().map(curve).collect()
        };
        let (springs, dashpots) =
            (lines(&StripImpedance::stiffnesses), lines(&StripImpedance::dashpots));
        curves(&format!("Spring Re K_{name}"), "frequency, Hz", unit, &springs)?
            .save(out.join(format!("spring_{name}.svg")))?;
        let unit = format!("{unit} · s");
        curves(&format!("Dashpot Im K_{name}/ω"), "frequency, Hz", &unit, &dashpots)?
            .save(out.join(format!("dashpot_{name}.svg")))?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let out = Path::new("target/impedances");
    let soil = Soil::from_shear_wave_speed(150.0, 1.0 / 3.0, 1800.0)?;
    let rock = Soil::from_shear_wave_speed(450.0, 0.3, 2160.0)?;
    // Damping is constant over the band; the moduli of the soils apply at 4 Hz.
    let damping = |ratio| GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 4.0);
    let on_rock = SoilProfile::on_half_plane(rock).with_bedrock_damping(damping(0.01)?);
    let layer = |profile: SoilProfile| -> basemat::Result<SoilProfile> {
        Ok(profile.with_layer(soil, 2.0 * HALF)?.with_damping(damping(0.05)?))
    };
    let (on_rock, on_rigid_bedrock) = (layer(on_rock)?, layer(SoilProfile::on_rigid_bedrock())?);
    println!("layer on rock:\n{on_rock}\n\nlayer on a rigid base:\n{on_rigid_bedrock}\n");

    // a₀ = ωB/c from 0.05 to 2.5.
    let unit = soil.shear_wave_speed() / (std::f64::consts::TAU * HALF);
    let frequencies: Vec<f64> = (1..=50).map(|i| 0.05 * f64::from(i) * unit).collect();
    let half_plane = ElasticGround::new(soil, Strip::graded(-HALF..HALF, ELEMENTS)?)?;
    let on_rock = ElasticGround::new(on_rock, Strip::graded(-HALF..HALF, ELEMENTS)?)?;
    let on_rigid_bedrock =
        ElasticGround::new(on_rigid_bedrock, Strip::graded(-HALF..HALF, ELEMENTS)?)?;
    let contact = StripContact::Bonded;
    let cases = [
        ("half-plane", half_plane.impedances(&frequencies, contact, &mut unobserved)?),
        ("layer on rock, 5 %", on_rock.impedances(&frequencies, contact, &mut unobserved)?),
        (
            "layer on a rigid base, 5 %",
            on_rigid_bedrock.impedances(&frequencies, contact, &mut unobserved)?,
        ),
    ];

    print(&cases, soil, unit);
    draw(&cases, out)?;
    println!("\npictures in {}", out.display());

    // Im K/μ, horizontal and vertical, at a₀ = 0.5, from tables of other programs.
    for ((name, found), wanted) in
        cases.iter().zip([[1.315, 2.019], [0.602, 0.934], [0.256, 0.490]])
    {
        let [hh, vv, ..] = normalized(&found[9], soil);
        for ([_, found], wanted) in [hh, vv].into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 0.01, "{name}: {found}, not {wanted}");
        }
    }
    Ok(())
}
