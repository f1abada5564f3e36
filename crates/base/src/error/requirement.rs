//! Requirements of numbers, lists and parts, and the errors if they are not met.

use super::{Error, Result};

/// `value`, or an error unless its requirement `holds`.
pub fn require(
    quantity: &'static str,
    value: f64,
    holds: bool,
    needed: &'static str,
) -> Result<f64> {
    if holds { Ok(value) } else { Err(Error::Input { quantity, value, needed }) }
}

/// `value`, or an error unless it is finite and above zero.
pub fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value > 0.0, "finite and above zero")
}

/// `value`, or an error unless it is finite and not below zero.
pub fn not_negative(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value >= 0.0, "finite and not below zero")
}

/// `value`, or an error unless it is a damping ratio, a fraction of critical damping (5 % are 0.05).
pub fn damping_ratio(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, (0.0..1.0).contains(&value), "from 0 to below 1 (0.05 is 5 %)")
}

/// `value`, or an error unless it is finite.
pub fn finite(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite(), "finite")
}

/// The first of `values` that is not finite, and its index.
pub fn not_finite(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().find(|(_, value)| !value.is_finite())
}

/// Error if one of `values` is not finite.
pub fn all_finite(quantity: &'static str, values: &[f64]) -> Result<()> {
    match not_finite(values) {
        None => Ok(()),
        Some((index, value)) => Err(Error::NotFinite { quantity, index, value }),
    }
}

/// Error unless `found == needed`.
pub fn same_length(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found == needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}

/// Error unless `found >= needed`.
pub fn at_least(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found >= needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}

/// `index`, or an error unless it is below `bound`.
pub fn in_bounds(quantity: &'static str, index: usize, bound: usize) -> Result<usize> {
    if index < bound { Ok(index) } else { Err(Error::Index { quantity, index, bound }) }
}

/// Error unless the requirement of a part of a scene `holds`.
pub fn require_part(quantity: &'static str, holds: bool, needed: &'static str) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::Scene { quantity, needed }) }
}

/// A point for a message, without z if that is zero for all `points`, as in the plane.
pub fn in_brackets([x, y, z]: &[f64; 3], points: &[[f64; 3]]) -> String {
    if points.iter().all(|point| point[2] == 0.0) {
        format!("({x}, {y})")
    } else {
        format!("({x}, {y}, {z})")
    }
}

/// A number for a message, without rounding errors of its computation.
///
/// Whole numbers stay as they are. Others have six figures, or twelve if six would make them round.
pub fn short(value: f64) -> String {
    let is_whole = value.fract() == 0.0 || !value.is_finite();
    let three_figures = rounded_to(3, value);
    let six_figures = rounded_to(6, value);
    let rounded = if is_whole {
        value
    } else if six_figures.to_bits() == three_figures.to_bits() {
        rounded_to(12, value)
    } else {
        six_figures
    };
    // No negative zero.
    (rounded + 0.0).to_string()
}

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

    /// This fault of an item, named in the error.
    #[doc(hidden)]
    pub fn within(self, item: impl Into<String>) -> Self {
        Self::Item { item: item.into(), r#source: Box::new(self) }
    }

    /// [`Error::Name`] for a name that is not in `known`.
    #[doc(hidden)]
    pub fn no_name<T: Into<String>>(
        quantity: &'static str,
        name: &str,
        known: impl Iterator<Item = T>,
    ) -> Self {
        Self::Name { quantity, name: name.into(), known: known.map(Into::into).collect() }
    }
}

/// Largest number of known names that a message lists.
const MAX_LISTED_NAMES: usize = 40;

/// Text of the known names.
pub fn names(known: &[String]) -> String {
    let listed = known[..known.len().min(MAX_LISTED_NAMES)].join(", ");
    if known.is_empty() { listed } else { format!(", only {listed}") }
}
