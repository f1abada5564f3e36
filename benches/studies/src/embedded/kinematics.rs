//! Motion of a rigid, massless body in a trench under vertical shear waves, beside the cosine rule of practice.
//!
//! The rule: the translation is cos(ωd/c_S), the motion of the free field at the depth of the base, up to 0.7 of the
//! first frequency of the soil beside the body, and constant beyond.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::{Soil, unobserved};

use crate::AnyError;

/// Share of the first frequency of the soil above the base from which the rule is constant.
const CONSTANT: f64 = 0.7;
/// Depths over the half width, with elements of the base and of a wall.
const DEPTHS: [(f64, [usize; 2]); 4] =
    [(0.25, [18, 4]), (0.5, [12, 6]), (1.0, [12, 8]), (2.0, [12, 12])];

/// |u| and b|θ| at ωd/c_S.
fn motions(depth: f64, [base, wall]: [usize; 2], places: &[f64]) -> basemat::Result<Vec<[f64; 2]>> {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
    let elements = Trench::new(-1.0..1.0, depth)?.elements(base, wall)?;
    let ground = TrenchGround::new(soil, elements)?;
    let frequencies: Vec<f64> = places.iter().map(|place| place / depth / TAU).collect();
    let found = ground.kinematic_motions(&frequencies, &mut unobserved)?;
    Ok(found.iter().map(|own| [own.horizontal.abs(), own.rotation.abs()]).collect())
}

pub(super) fn tables(short: bool) -> Result<String, AnyError> {
    let first = CONSTANT * FRAC_PI_2;
    let places = [0.25, 0.5, 0.75, 1.0, first, 1.3, FRAC_PI_2, 2.0];
    let places = if short { &places[..2] } else { &places[..] };
    let depths = if short { &DEPTHS[..1] } else { &DEPTHS[..] };
    let mut columns = vec![];
    for (depth, counts) in depths {
        columns.push(motions(*depth, *counts, places)?);
    }
    let mut text = String::new();
    let names: Vec<String> = depths.iter().map(|(depth, _)| format!(" d/b = {depth} |")).collect();
    for (k, what) in ["Translation |u| of the base", "Rotation b|θ|"].into_iter().enumerate() {
        writeln!(text, "{what}, per unit motion of the surface:\n")?;
        let rule = if k == 0 { " cosine rule |" } else { "" };
        writeln!(text, "| ωd/c_S |{}{rule}", names.concat())?;
        writeln!(text, "|---|{}", "---|".repeat(depths.len() + 1 - k))?;
        for (line, place) in places.iter().enumerate() {
            write!(text, "| {place:.2} |")?;
            for column in &columns {
                write!(text, " {:.3} |", column[line][k])?;
            }
            let rule =
                if k == 0 { format!(" {:.3} |", place.min(first).cos()) } else { String::new() };
            writeln!(text, "{rule}")?;
        }
        text.push('\n');
    }
    Ok(text)
}
