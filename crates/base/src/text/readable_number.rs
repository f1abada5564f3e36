//! Numbers in reports, with customary units and few figures.

/// Unit of printed values, and the factor from the SI unit to this unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedUnit<'a> {
    /// Printed values are SI values times this factor.
    pub factor: f64,
    /// Symbol of the unit.
    pub symbol: &'a str,
}

/// Customary printed unit of an SI unit; other units are unchanged.
pub fn printed_unit(unit: &str) -> PrintedUnit<'_> {
    match unit {
        "m" => PrintedUnit { factor: 1e3, symbol: "mm" },
        "rad" => PrintedUnit { factor: 1e3, symbol: "mrad" },
        "N/m" => PrintedUnit { factor: 1e-3, symbol: "kN/m" },
        "N·m/m" => PrintedUnit { factor: 1e-3, symbol: "kN·m/m" },
        "J/m" => PrintedUnit { factor: 1e-3, symbol: "kJ/m" },
        symbol => PrintedUnit { factor: 1.0, symbol },
    }
}

/// Unit of a quantity, in plan without the "per metre" of the plane.
pub fn whole_body_unit(unit: &str, in_plan: bool) -> &str {
    unit.strip_suffix("/m").filter(|_| in_plan).unwrap_or(unit)
}

/// Magnitude, in printed units, below which a number counts as a rounding error of zero.
const ROUNDING_LIMIT: f64 = 1e-9;
/// Magnitudes that are printed without an exponent.
const PLAIN_MAGNITUDES: std::ops::Range<f64> = 1e-3..1e6;

/// Text of a number with at least three significant figures.
///
/// It has an exponent only below 1e-3 and from 1e6 on, and there is no negative zero.
pub fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude < ROUNDING_LIMIT {
        "0".to_owned()
    } else if !PLAIN_MAGNITUDES.contains(&magnitude) {
        format!("{value:.3e}")
    } else if magnitude >= 1e3 {
        format!("{value:.1}")
    } else if magnitude >= 1.0 {
        format!("{value:.3}")
    } else {
        format!("{value:.5}")
    }
}

/// A number with three decimals; no negative zero.
pub fn thousandths(value: f64) -> String {
    // A value that rounds to zero is written as zero.
    format!("{:.3}", if value.abs() < 0.5e-3 { 0.0 } else { value })
}
