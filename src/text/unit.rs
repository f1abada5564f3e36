//! Numbers as engineers read them.

/// Factor from an SI unit to the one that is printed for it, and that; others stay.
pub(crate) fn printed(unit: &str) -> (f64, &str) {
    match unit {
        "m" => (1e3, "mm"),
        "rad" => (1e3, "mrad"),
        "N/m" => (1e-3, "kN/m"),
        "N·m/m" => (1e-3, "kN·m/m"),
        other => (1.0, other),
    }
}

/// Below this, in units of engineers, a number is rounding: nobody measures 10⁻¹² N or m.
const NOTHING: f64 = 1e-9;

/// Five figures, no exponents where they can be helped; no negative zero.
pub(crate) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude < NOTHING {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&magnitude) {
        format!("{value:.3e}")
    } else if magnitude >= 1e3 {
        format!("{value:.1}")
    } else if magnitude >= 1.0 {
        format!("{value:.3}")
    } else {
        format!("{value:.5}")
    }
}
