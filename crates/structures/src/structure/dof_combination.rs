//! Weighted sums of degrees of freedom, and section resultants as such sums.

use std::ops::{Add, AddAssign, Deref, Mul, Neg, Sub, SubAssign};

use crate::error::{Result, finite, in_bounds};

/// A weighted sum of a structure's degrees of freedom.
///
/// Examples: a displacement of a point, a drift, a rotation.
///
/// It stores (degree of freedom, weight) terms in the order of their input. A degree of freedom that occurs more than
/// once counts with the sum of its weights. A function with a combination as argument also accepts a degree of freedom
/// (with weight one), a term, or a list of terms.
///
/// ```
/// use basemat::structure::DofCombination;
///
/// let roof = DofCombination::from(7);
/// assert_eq!(roof[..], [(7, 1.0)]);
/// let mut drift = DofCombination::from(7) - DofCombination::from(6);
/// drift += 3.0 * DofCombination::from(2);
/// assert_eq!(drift, DofCombination::from([(7, 1.0), (6, -1.0), (2, 3.0)]));
/// let displacement = [0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.1, 0.2];
/// assert!((drift.value(&displacement) - 0.13).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct DofCombination(Vec<(usize, f64)>);

impl DofCombination {
    /// Value of the sum for these displacements, velocities or accelerations of all degrees of freedom.
    ///
    /// Degrees of freedom beyond the end of `dof_values` count as zero.
    pub fn value(&self, dof_values: &[f64]) -> f64 {
        let dof_value = |dof: usize| dof_values.get(dof).copied().unwrap_or(0.0);
        self.0.iter().map(|&(dof, weight)| weight * dof_value(dof)).sum()
    }

    /// The sum with its degrees of freedom renumbered by `new_dof`.
    #[doc(hidden)]
    #[must_use]
    pub fn map_dofs(&self, new_dof: impl Fn(usize) -> usize) -> Self {
        self.0.iter().map(|&(dof, weight)| (new_dof(dof), weight)).collect()
    }

    /// Returns an error for an invalid weight or degree of freedom.
    ///
    /// Weights must be finite, and degrees of freedom below `dof_count`. `quantity`: name of the degree of freedom in
    /// the error.
    #[doc(hidden)]
    pub fn check(&self, quantity: &'static str, dof_count: usize) -> Result<()> {
        for &(dof, weight) in &self.0 {
            finite("weight of a degree of freedom", weight)?;
            in_bounds(quantity, dof, dof_count)?;
        }
        Ok(())
    }
}

impl From<usize> for DofCombination {
    /// Sum of one degree of freedom, with weight one.
    fn from(dof: usize) -> Self {
        Self(vec![(dof, 1.0)])
    }
}

impl From<(usize, f64)> for DofCombination {
    fn from(term: (usize, f64)) -> Self {
        Self(vec![term])
    }
}

impl From<Vec<(usize, f64)>> for DofCombination {
    fn from(terms: Vec<(usize, f64)>) -> Self {
        Self(terms)
    }
}

impl From<&[(usize, f64)]> for DofCombination {
    fn from(terms: &[(usize, f64)]) -> Self {
        Self(terms.to_vec())
    }
}

impl<const N: usize> From<[(usize, f64); N]> for DofCombination {
    fn from(terms: [(usize, f64); N]) -> Self {
        Self(terms.to_vec())
    }
}

impl<const N: usize> From<&[(usize, f64); N]> for DofCombination {
    fn from(terms: &[(usize, f64); N]) -> Self {
        Self(terms.to_vec())
    }
}

impl From<&DofCombination> for DofCombination {
    fn from(row: &DofCombination) -> Self {
        row.clone()
    }
}

impl FromIterator<(usize, f64)> for DofCombination {
    fn from_iter<I: IntoIterator<Item = (usize, f64)>>(terms: I) -> Self {
        Self(terms.into_iter().collect())
    }
}

/// The (degree of freedom, weight) terms.
impl Deref for DofCombination {
    type Target = [(usize, f64)];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl AsRef<[(usize, f64)]> for DofCombination {
    fn as_ref(&self) -> &[(usize, f64)] {
        &self.0
    }
}

impl AddAssign for DofCombination {
    fn add_assign(&mut self, other: Self) {
        for (dof, weight) in other.0 {
            match self.0.iter_mut().find(|term| term.0 == dof) {
                Some(term) => term.1 += weight,
                None => self.0.push((dof, weight)),
            }
        }
    }
}

impl SubAssign for DofCombination {
    fn sub_assign(&mut self, other: Self) {
        *self += -other;
    }
}

impl Add for DofCombination {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Neg for DofCombination {
    type Output = Self;

    fn neg(self) -> Self {
        -1.0 * self
    }
}

impl Sub for DofCombination {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<DofCombination> for f64 {
    type Output = DofCombination;

    fn mul(self, mut row: DofCombination) -> DofCombination {
        row.0.iter_mut().for_each(|term| term.1 *= self);
        row
    }
}

impl IntoIterator for DofCombination {
    type Item = (usize, f64);
    type IntoIter = std::vec::IntoIter<(usize, f64)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a DofCombination {
    type Item = &'a (usize, f64);
    type IntoIter = std::slice::Iter<'a, (usize, f64)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

/// A force or moment as weighted sums of displacements, velocities and accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionRows {
    /// Unit of the resultant: "N/m" for a force, "N·m/m" for a moment.
    pub unit: &'static str,
    /// Weights of the displacements.
    pub displacement: DofCombination,
    /// Weights of the velocities: dashpots and stiffness-proportional damping.
    pub velocity: DofCombination,
    /// Weights of the accelerations: inertia of the part above the section.
    pub acceleration: DofCombination,
}

impl Default for SectionRows {
    /// Zero force per metre.
    fn default() -> Self {
        Self {
            unit: "N/m",
            displacement: DofCombination::default(),
            velocity: DofCombination::default(),
            acceleration: DofCombination::default(),
        }
    }
}

impl SectionRows {
    /// Value of the resultant for a motion of all degrees of freedom.
    ///
    /// Degrees of freedom beyond the end of a slice count as zero.
    pub fn value(&self, displacement: &[f64], velocity: &[f64], acceleration: &[f64]) -> f64 {
        self.displacement.value(displacement)
            + self.velocity.value(velocity)
            + self.acceleration.value(acceleration)
    }
}
