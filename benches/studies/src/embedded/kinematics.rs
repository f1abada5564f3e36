//! Motion of a rigid, massless body in a trench under vertical shear waves, beside the cosine rule used in practice.
//!
//! The rule: the translation is cos(ωd/c_S), the motion of the free field at the depth of the base, up to 0.7 of the
//! first frequency of the soil beside the body, and constant beyond.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::{Soil, unobserved};

use crate::AnyError;

/// Fraction of the first frequency of the soil above the base from which the rule is constant.
const CONSTANT_FROM_RATIO: f64 = 0.7;
/// Depths over the half width, with elements of the base and of a wall.
const DEPTH_CASES: [(f64, [usize; 2]); 4] =
    [(0.25, [18, 4]), (0.5, [12, 6]), (1.0, [12, 8]), (2.0, [12, 12])];

/// |u| and b|θ| at ωd/c_S.
fn motions(
    depth: f64,
    [base, wall]: [usize; 2],
    dimensionless: &[f64],
) -> basemat::Result<Vec<[f64; 2]>> {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
    let elements = Trench::new(-1.0..1.0, depth)?.elements(base, wall)?;
    let ground = TrenchGround::new(soil, elements)?;
    let frequencies: Vec<f64> =
        dimensionless.iter().map(|frequency| frequency / depth / TAU).collect();
    let motions = ground.kinematic_motions(&frequencies, &mut unobserved)?;
    Ok(motions
        .iter()
        .map(|motion| [motion.horizontal.abs(), motion.rotation.abs()])
        .collect())
}

pub(super) fn tables(short: bool) -> Result<String, AnyError> {
    let first = CONSTANT_FROM_RATIO * FRAC_PI_2;
    let frequencies = [0.25, 0.5, 0.75, 1.0, first, 1.3, FRAC_PI_2, 2.0];
    let frequencies = if short { &frequencies[..2] } else { &frequencies[..] };
    let depths = if short { &DEPTH_CASES[..1] } else { &DEPTH_CASES[..] };
    let mut columns = vec![];
    for (depth, counts) in depths {
        columns.push(motions(*depth, *counts, frequencies)?);
    }
    let mut text = String::new();
    let names: Vec<String> = depths.iter().map(|(depth, _)| format!(" d/b = {depth} |")).collect();
    for (k, quantity) in ["Translation |u| of the base", "Rotation b|θ|"].into_iter().enumerate() {
        writeln!(text, "{quantity}, per unit motion of the surface:\n")?;
        let rule = if k == 0 { " cosine rule |" } else { "" };
        writeln!(text, "| ωd/c_S |{}{rule}", names.concat())?;
        writeln!(text, "|---|{}", "---|".repeat(depths.len() + 1 - k))?;
        for (line, frequency) in frequencies.iter().enumerate() {
            write!(text, "| {frequency:.2} |")?;
            for column in &columns {
                write!(text, " {:.3} |", column[line][k])?;
            }
            let rule = if k == 0 {
                format!(" {:.3} |", frequency.min(first).cos())
            } else {
                String::new()
            };
            writeln!(text, "{rule}")?;
        }
        text.push('\n');
    }
    Ok(text)
}
