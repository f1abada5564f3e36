//! Where the energy went, over time.

use super::lines::{Curve, curves};
use super::svg::Svg;
use crate::coupled::Ledger;
use crate::error::Result;
use crate::results::Histories;

/// Name and value of a term.
type Term = (&'static str, fn(&Ledger) -> f64);

const TERMS: [Term; 8] = [
    ("input", |l| l.input),
    ("friction and impact", |l| l.contact),
    ("soil", |l| l.soil),
    ("hysteresis", |l| l.hysteresis),
    ("damping", |l| l.damping),
    ("kinetic and strain", |l| l.kinetic + l.strain),
    ("static pressures", |l| l.preload),
    ("layer, time scheme", |l| l.layer + l.numerical),
];

/// The terms of the energy ledger over time, those that stay below a thousandth of the largest left
/// out.
///
/// # Errors
/// Those of [`curves`].
pub fn energy(title: &str, histories: &Histories) -> Result<Svg> {
    let ledgers = histories.ledgers();
    let largest = |value: fn(&Ledger) -> f64| {
        ledgers.iter().fold(0.0_f64, |m, ledger| m.max(value(ledger).abs()))
    };
    let scale = TERMS.iter().map(|(_, value)| largest(*value)).fold(0.0, f64::max);
    let shown =
        TERMS.iter().filter(|(name, value)| *name == "input" || largest(*value) > 1e-3 * scale);
    let curve = |(name, value): &Term| Curve {
        name: (*name).to_owned(),
        points: histories
            .times()
            .iter()
            .zip(ledgers)
            .map(|(&time, ledger)| (time, 1e-3 * value(ledger)))
            .collect(),
    };
    curves(title, "time, s", "energy, kJ/m", &shown.map(curve).collect::<Vec<_>>())
}
