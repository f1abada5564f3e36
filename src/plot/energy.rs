//! Where the energy went, over time.

use super::lines::{Curve, curves};
use super::svg::Svg;
use crate::coupled::Ledger;
use crate::error::Result;
use crate::results::Histories;

/// The terms of the energy ledger over time, those that stay below a thousandth of the largest left
/// out.
///
/// # Errors
/// Those of [`curves`].
pub fn energy(title: &str, histories: &Histories) -> Result<Svg> {
    // The input, then what it has become.
    let terms = |ledger: &Ledger| [vec![("input", ledger.input)], ledger.parts()].concat();
    let rows: Vec<_> = histories.ledgers().iter().map(terms).collect();
    let largest = |k: usize| rows.iter().fold(0.0_f64, |m, row| m.max(row[k].1.abs()));
    let names: Vec<_> = rows.first().into_iter().flatten().map(|(name, _)| *name).collect();
    let scale = (0..names.len()).map(largest).fold(0.0, f64::max);
    let shown = (0..names.len()).filter(|k| *k == 0 || largest(*k) > 1e-3 * scale);
    let curve = |k: usize| Curve {
        name: names[k].to_owned(),
        points: histories.times().iter().zip(&rows).map(|(t, row)| (*t, 1e-3 * row[k].1)).collect(),
    };
    curves(title, "time, s", "energy, kJ/m", &shown.map(curve).collect::<Vec<_>>())
}
