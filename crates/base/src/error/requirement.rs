//! Requirements of numbers, lists and parts, and the errors if they are not met.

use super::{Error, Result};

/// Returns `value`, or an error unless `is_satisfied`.
pub fn require(
    quantity: &'static str,
    value: f64,
    is_satisfied: bool,
    needed: &'static str,
) -> Result<f64> {
    if is_satisfied { Ok(value) } else { Err(Error::Input { quantity, value, needed }) }
}

/// Returns `value`, or an error unless it is finite and above zero.
pub fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value > 0.0, "finite and above zero")
}

/// Returns `value`, or an error unless it is finite and not below zero.
pub fn not_negative(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value >= 0.0, "finite and not below zero")
}

/// Returns `value`, or an error unless it is a damping ratio.
///
/// A damping ratio is a fraction of critical damping: 5 % are 0.05.
pub fn damping_ratio(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, (0.0..1.0).contains(&value), "from 0 to below 1 (0.05 is 5 %)")
}

/// Returns `value`, or an error unless it is finite.
pub fn finite(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite(), "finite")
}

/// The first of `values` that is not finite, and its index.
pub fn first_not_finite(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().find(|(_, value)| !value.is_finite())
}

/// Returns an error if one of `values` is not finite.
pub fn all_finite(quantity: &'static str, values: &[f64]) -> Result<()> {
    match first_not_finite(values) {
        None => Ok(()),
        Some((index, value)) => Err(Error::NotFinite { quantity, index, value }),
    }
}

/// Returns an error unless the length `found` equals `needed`.
pub fn same_length(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found == needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}

/// Returns an error unless the length `found` is at least `needed`.
pub fn at_least(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found >= needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}

/// Returns `index`, or an error unless it is below `bound`.
pub fn in_bounds(quantity: &'static str, index: usize, bound: usize) -> Result<usize> {
    if index < bound { Ok(index) } else { Err(Error::Index { quantity, index, bound }) }
}

/// Returns an error for a part of a scene unless `is_satisfied`.
pub fn require_part(
    quantity: &'static str,
    is_satisfied: bool,
    needed: &'static str,
) -> Result<()> {
    if is_satisfied { Ok(()) } else { Err(Error::Scene { quantity, needed }) }
}

/// Text of a point for a message.
///
/// It has no z if z is zero for all `points`, as in the plane.
pub fn point_text([x, y, z]: &[f64; 3], points: &[[f64; 3]]) -> String {
    if points.iter().all(|point| point[2] == 0.0) {
        format!("({x}, {y})")
    } else {
        format!("({x}, {y}, {z})")
    }
}

/// Number of significant figures of a printed number.
const PRINTED_FIGURES: usize = 6;
/// Number of significant figures of a round number.
///
/// A value that rounding to [`PRINTED_FIGURES`] shortens to so few figures may differ slightly from a round number.
const ROUND_NUMBER_FIGURES: usize = 3;
/// Number of significant figures for such a value.
///
/// They show the difference, but no rounding errors of a computation.
const PRECISE_FIGURES: usize = 12;

/// Text of a number for a message, without rounding errors of its computation.
///
/// Whole numbers are unchanged. Others have six figures, or twelve if six figures show only a round number.
pub fn number_text(value: f64) -> String {
    let is_whole = value.fract() == 0.0 || !value.is_finite();
    let round_number = rounded_to(ROUND_NUMBER_FIGURES, value);
    let printed_number = rounded_to(PRINTED_FIGURES, value);
    let rounded_value = if is_whole {
        value
    } else if printed_number.to_bits() == round_number.to_bits() {
        rounded_to(PRECISE_FIGURES, value)
    } else {
        printed_number
    };
    // Adding zero removes the sign of a negative zero.
    (rounded_value + 0.0).to_string()
}

/// `value` rounded to a number of decimal figures.
fn rounded_to(figures: usize, value: f64) -> f64 {
    let decimals = figures - 1;
    format!("{value:.decimals$e}").parse().unwrap_or(value)
}

impl Error {
    /// Error of a part that the user wrote, if no other error fits.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::{ContactScene, Coulomb, InterfaceLaw, Limits, PreviousContact};
    /// use basemat::structure::RigidBlock;
    /// use basemat::{Error, Result, Simulation};
    ///
    /// /// Friction of a bearing that was tested for steps of up to 5 ms.
    /// struct Bearing(Coulomb);
    ///
    /// impl InterfaceLaw for Bearing {
    ///     fn check(&self, scene: &ContactScene) -> Result<()> {
    ///         if scene.time_step <= 0.005 {
    ///             return Ok(());
    ///         }
    ///         Err(Error::part("bearing", format!("a step of {} s is too long", scene.time_step)))
    ///     }
    ///     fn limits(&self, start: &PreviousContact) -> Result<Limits> {
    ///         self.0.limits(start)
    ///     }
    /// }
    ///
    /// let error = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Bearing(Coulomb::new(0.1)?))
    ///     .build()
    ///     .unwrap_err();
    /// assert_eq!(error.to_string(), "bearing: a step of 0.01 s is too long");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn part(part: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Part { part: part.into(), reason: reason.into() }
    }

    /// The error of `item` with this fault.
    #[doc(hidden)]
    pub fn within(self, item: impl Into<String>) -> Self {
        Self::Item { item: item.into(), r#source: Box::new(self) }
    }

    /// [`Error::Name`] for a name that is not among `valid_names`.
    #[doc(hidden)]
    pub fn no_name<T: Into<String>>(
        quantity: &'static str,
        name: &str,
        valid_names: impl Iterator<Item = T>,
    ) -> Self {
        Self::Name { quantity, name: name.into(), known: valid_names.map(Into::into).collect() }
    }
}

/// Largest number of valid names in a message: more would hide the fault.
const MAX_LISTED_NAMES: usize = 40;

/// Text that lists the valid names; empty if there are none.
pub fn valid_names_text(valid_names: &[String]) -> String {
    let listed_names = valid_names[..valid_names.len().min(MAX_LISTED_NAMES)].join(", ");
    if valid_names.is_empty() { listed_names } else { format!(", only {listed_names}") }
}
