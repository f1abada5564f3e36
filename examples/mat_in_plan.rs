//! Dynamic stiffness of a square mat, compared with a strip of the same width.
//!
//! ```text
//! cargo run --release --example mat_in_plan
//! ```
//!
//! A mat of 20 × 20 m on soil with a shear wave speed of 200 m/s is compared with its usual model in plane strain: 20 m
//! of an infinitely long strip 20 m wide. The strip is softer, because the loads on all its parts act on the same soil.
//! The strip also radiates more, above all in rocking. Plane strain therefore underestimates the rocking of square
//! mats.

use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{Grading, Strip};
use basemat::prelude::*;
use basemat::soil::SoilProfile;
use basemat::unobserved;

/// Half the mat's width, m.
const HALF_WIDTH: f64 = 10.0;

/// Equivalent damping ratio Im K/(2 Re K).
fn damping_ratio(impedance: basemat::Complex) -> f64 {
    0.5 * impedance.im / impedance.re
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(200.0, 1.0 / 3.0, 1800.0)?;
    let profile = SoilProfile::from(soil);
    // Frequencies at which a₀ = ωb/c is 0.25, 0.5 and 1, with half the width b.
    let frequency_scale = soil.shear_wave_speed() / (std::f64::consts::TAU * HALF_WIDTH);
    let frequencies = [0.25, 0.5, 1.0].map(|a0| a0 * frequency_scale);

    // 16 cells along a side.
    let mat = Plan::rectangle(-HALF_WIDTH..HALF_WIDTH, -HALF_WIDTH..HALF_WIDTH, 16)?;
    let mats =
        impedances_in_plan(&profile, &mat, &frequencies, StripContact::Bonded, &mut unobserved)?;
    let strip_ground =
        ElasticGround::new(soil, Strip::new(-HALF_WIDTH..HALF_WIDTH, 24, Grading::Cosine)?)?;
    let strips = strip_ground.impedances(&frequencies, StripContact::Bonded, &mut unobserved)?;

    println!(
        "   f (Hz)  motion      spring, mat   dashpot, mat   strip/mat: spring  dashpot   damping ratio: mat, strip"
    );
    for (mat, strip) in mats.iter().zip(&strips) {
        // Motions along x and z, and rotation about y.
        for (name, direction, strip_impedance) in [
            ("sway", 0, strip.horizontal),
            ("heave", 2, strip.vertical),
            ("rocking", 4, strip.rocking),
        ] {
            let omega = std::f64::consts::TAU * mat.frequency;
            let mat_spring = mat.stiffnesses()[direction][direction];
            let mat_dashpot = mat.dashpots()[direction][direction];
            // The strip's impedances are multiplied by its length of 20 m.
            let strip_spring = 2.0 * HALF_WIDTH * strip_impedance.re;
            let strip_dashpot = 2.0 * HALF_WIDTH * strip_impedance.im / omega;
            println!(
                "{:>9.2}  {name:<8} {mat_spring:>14.3e} {mat_dashpot:>14.3e} {:>18.2} {:>8.2} {:>18.1} % {:>5.1} %",
                mat.frequency,
                strip_spring / mat_spring,
                strip_dashpot / mat_dashpot,
                50.0 * omega * mat_dashpot / mat_spring,
                50.0 * omega * strip_dashpot / strip_spring,
            );
        }
    }
    let mat_damping = damping_ratio(mats[1].matrix[4][4]);
    let strip_damping = damping_ratio(strips[1].rocking);
    assert!(strip_damping > 3.0 * mat_damping);
    Ok(())
}
