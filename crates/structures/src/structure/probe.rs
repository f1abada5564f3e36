//! Quantities recorded at every step.

use crate::error::{Error, Result};
use crate::structure::{DofCombination, SectionRows};
use crate::text::column::column;

/// A quantity recorded at every step: a weighted sum of displacements, velocities, accelerations.
///
/// Displacements are changes from the static state, relative to the translation of the free field under the connected
/// part. [`Probe::absolute_displacement`] includes that translation; [`DofCombination::relative_to_base`] and
/// [`DofCombination::total_drift`] also subtract the motion of the base. Velocities and accelerations are absolute.
///
/// ```
/// use basemat::coupled::Probe;
/// use basemat::structure::{ShearBuilding, Storey};
///
/// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
/// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?;
/// // The base's `[u_x, u_y, θ]` come first.
/// let rotation = 2;
/// let probes = [
///     Probe::acceleration("roof", building.roof()),
///     Probe::displacement("lowest drift", building.drift(0)?),
///     Probe::displacement("drift of the roof", building.total_drift(4)?),
///     Probe::section("base shear", &building.shear(0)?),
///     Probe::displacement("rotation", rotation).in_unit("rad"),
/// ];
/// assert_eq!(probes.map(|probe| probe.unit), ["m/s²", "m", "m", "N/m", "rad"]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[non_exhaustive]
pub struct Probe {
    /// Name, for tables; different for each probe of a simulation.
    pub name: String,
    /// Unit, for tables; may be empty.
    ///
    /// It is a label: values are weighted sums in SI units.
    pub unit: String,
    /// Sum of displacements, as changes from the static state.
    pub displacement: DofCombination,
    /// Whether the displacements include the translation of the free field.
    pub absolute: bool,
    /// Sum of velocities.
    pub velocity: DofCombination,
    /// Sum of accelerations.
    pub acceleration: DofCombination,
}

impl Probe {
    /// Displacement (m) relative to the free field: a degree of freedom, or a weighted sum.
    pub fn displacement(name: impl Into<String>, row: impl Into<DofCombination>) -> Self {
        Self { displacement: row.into(), ..Self::new(name, "m") }
    }

    /// Displacement (m) that includes the translation of the free field.
    pub fn absolute_displacement(name: impl Into<String>, row: impl Into<DofCombination>) -> Self {
        Self { absolute: true, ..Self::displacement(name, row) }
    }

    /// Velocity (m/s) of a degree of freedom, or a weighted sum of velocities.
    pub fn velocity(name: impl Into<String>, row: impl Into<DofCombination>) -> Self {
        Self { velocity: row.into(), ..Self::new(name, "m/s") }
    }

    /// Acceleration (m/s²) of a degree of freedom, or a weighted sum of accelerations.
    pub fn acceleration(name: impl Into<String>, row: impl Into<DofCombination>) -> Self {
        Self { acceleration: row.into(), ..Self::new(name, "m/s²") }
    }

    /// A section resultant of a structure: a force (N/m) or a moment (N·m/m).
    pub fn section(name: impl Into<String>, rows: &SectionRows) -> Self {
        Self {
            displacement: rows.displacement.clone(),
            velocity: rows.velocity.clone(),
            acceleration: rows.acceleration.clone(),
            ..Self::new(name, rows.unit)
        }
    }

    /// Replaces the label of the probe's unit, for a rotation for example; values do not change.
    ///
    /// Printed tables and pictures convert the units "m", "rad", "N/m" and "N·m/m" to mm, mrad, kN/m and kN·m/m, but no
    /// other units. Files use the probe's unit.
    #[must_use]
    pub fn in_unit(self, unit: impl Into<String>) -> Self {
        Self { unit: unit.into(), ..self }
    }

    /// Name of the column in files, from name and unit, such as `roof_left_m_per_s2`.
    #[doc(hidden)]
    pub fn column(&self) -> String {
        column(&self.name, &self.unit)
    }

    fn new(name: impl Into<String>, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.to_owned(), ..Self::default() }
    }

    /// Weighted sums of displacements, velocities and accelerations.
    #[doc(hidden)]
    pub fn rows(&self) -> [&DofCombination; 3] {
        [&self.displacement, &self.velocity, &self.acceleration]
    }

    /// Converts the probe's weighted sums to other degrees of freedom; an error names the probe.
    pub(crate) fn try_map_rows(
        self,
        map: impl Fn(DofCombination) -> Result<DofCombination>,
    ) -> Result<Self> {
        let Self { name, displacement, velocity, acceleration, .. } = self.clone();
        let named_map = |row| map(row).map_err(|fault| fault.within(format!("probe '{name}'")));
        Ok(Self {
            displacement: named_map(displacement)?,
            velocity: named_map(velocity)?,
            acceleration: named_map(acceleration)?,
            ..self
        })
    }
}

/// Checks the degrees of freedom and the names of probes.
///
/// # Errors
/// [`Error::Item`] for degrees of freedom of at least `dofs`, and [`Error::DuplicateName`] for two probes of one name.
pub fn check_probes(probes: &[Probe], dofs: usize) -> Result<()> {
    let mut names = std::collections::BTreeSet::new();
    for probe in probes {
        let name = &probe.name;
        for row in probe.rows() {
            row.check("degree of freedom", dofs)
                .map_err(|fault| fault.within(format!("probe '{name}'")))?;
        }
        if !names.insert(name) {
            return Err(Error::DuplicateName { quantity: "probe", name: name.clone() });
        }
    }
    Ok(())
}

/// Index of the probe called `name` in a list.
///
/// # Errors
/// [`Error::Name`] with the names in the list.
pub fn probe_index<T>(
    probes: &[T],
    name: &str,
    name_of: impl Fn(&T) -> &String + Copy,
) -> Result<usize> {
    let index = probes.iter().position(|probe| name_of(probe) == name);
    index.ok_or_else(|| Error::no_name("probe", name, probes.iter().map(name_of)))
}
