//! Dynamic stiffness of a square mat, compared with a strip of the same width.
//!
//! ```text
//! cargo run --release --example mat_in_plan
//! ```
//!
//! A mat of 20 × 20 m on soil of 200 m/s is compared with 20 m of an endless strip 20 m wide, its usual model
//! in plane strain. The strip is softer, because its parts share the soil. It also radiates more, above all
//! in rocking. Plane strain therefore underestimates the rocking of square mats.

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{Grading, Strip};
use basemat::prelude::*;
use basemat::soil::SoilProfile;
use basemat::unobserved;

/// Half the mat's width, m.
const HALF: f64 = 10.0;

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1800.0)?;
    let profile = SoilProfile::from(soil);
    // a₀ = ωb/c of 0.25, 0.5 and 1.
    let unit = soil.shear_wave_speed() / (std::f64::consts::TAU * HALF);
    let frequencies = [0.25, 0.5, 1.0].map(|a0| a0 * unit);

    // 16 cells along a side; the outermost cells extend a tenth of a cell beyond the edge.
    let mat = Plan::rectangle(-HALF..HALF, -HALF..HALF, 16)?;
    let mats =
        impedances_in_plan(&profile, &mat, &frequencies, StripContact::Bonded, &mut unobserved)?;
    let ground = ElasticGround::new(soil, Strip::new(-HALF..HALF, 24, Grading::Cosine)?)?;
    let strips = ground.impedances(&frequencies, StripContact::Bonded, &mut unobserved)?;

    println!(
        "   f (Hz)  motion      spring, mat   dashpot, mat   strip/mat: spring  dashpot   damping ratio: mat, strip"
    );
    for (mat, strip) in mats.iter().zip(&strips) {
        // Motions along x and z, and rotation about y.
        for (name, axis, strip) in [
            ("sway", 0, strip.horizontal),
            ("heave", 2, strip.vertical),
            ("rocking", 4, strip.rocking),
        ] {
            let (spring, dashpot) = (mat.stiffnesses()[axis][axis], mat.dashpots()[axis][axis]);
            let omega = std::f64::consts::TAU * mat.frequency;
            // The strip's impedances are multiplied by its length of 20 m.
            let [stiffness, damping] = [2.0 * HALF * strip.re, 2.0 * HALF * strip.im / omega];
            println!(
                "{:>9.2}  {name:<8} {spring:>14.3e} {dashpot:>14.3e} {:>18.2} {:>8.2} {:>18.1} % {:>5.1} %",
                mat.frequency,
                stiffness / spring,
                damping / dashpot,
                50.0 * omega * dashpot / spring,
                50.0 * omega * damping / stiffness,
            );
        }
    }
    let rocking = |k: basemat::Complex| 0.5 * k.im / k.re;
    let [true_ratio, in_plane] = [rocking(mats[1].matrix[4][4]), rocking(strips[1].rocking)];
    assert!(in_plane > 3.0 * true_ratio);
    Ok(())
}
