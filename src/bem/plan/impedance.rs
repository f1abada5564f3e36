//! Dynamic stiffness of rigid mats in plan.
//!
//! Without damping, poles lie on the path of the integrals at s = iω. The stiffness is still analytic there, so it
//! is evaluated at iω + η, 2η, … 8η and extrapolated.

use super::cells::Plan;
use super::integrals::{Integrals, Workspace};
use super::sectors::{MOTIONS, Sectors};
use crate::bem::layered::{Compliances, StripContact, impedance_watch, points, stiffnesses};
use crate::error::{Observer, PlanError, Result};
use crate::geometry::SERIES_PER_OFFSET;
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Dynamic stiffness of a rigid, massless mat for motions e^(iωt).
///
/// x to the right, y away from the reader, z up, rotations right-handed; forces and moments act on the soil. The
/// reference point is [`Plan::middle`]. Several mats of one plan move together.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct PlanImpedance {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Forces and moments (rows) due to translations and rotations (columns), N/m, N and N m.
    ///
    /// Along x, y, z and about these axes; symmetric. The real part is stiffness (minus the inertia of the soil
    /// that moves along), the imaginary part damping by radiation and in the soil.
    pub matrix: [[Complex; MOTIONS]; MOTIONS],
}

impl PlanImpedance {
    /// Springs Re K.
    pub fn stiffnesses(&self) -> [[f64; MOTIONS]; MOTIONS] {
        self.matrix.map(|row| row.map(|k| k.re))
    }

    /// Dashpots Im K/ω parallel to these springs, N s/m and so on; NaN at frequency zero.
    pub fn dashpots(&self) -> [[f64; MOTIONS]; MOTIONS] {
        self.matrix.map(|row| row.map(|k| k.im / (std::f64::consts::TAU * self.frequency)))
    }
}

/// Tolerance of the cells' compliances; the error of the cells themselves is far larger.
const TOLERANCE: f64 = 1e-9;
/// Smallest number of cells in a wavelength.
const RESOLVED: f64 = 6.0;
/// Number of entries of a matrix.
const ENTRIES: usize = MOTIONS * MOTIONS;

/// Dynamic stiffness of the rigid mats of `plan` on `profile` at each of `frequencies` (Hz).
///
/// Frequency 0 is the static stiffness. Layers may have any damping, also hysteretic; without damping they take
/// eight times as long. Relaxed contact has vertical motions and rocking without shear, and horizontal motions and
/// torsion without pressure. Tractions are constant over the contact elements, either cells or unions of them.
/// The observer's parts are points of the Laplace plane, eight per frequency.
///
/// ```
/// use basemat::bem::layered::StripContact;
/// use basemat::bem::plan::{Plan, impedances_in_plan};
/// use basemat::{Soil, unobserved};
/// let soil = Soil::new(1.0, 0.25, 1.0)?;
/// let mat = Plan::rectangle(-1.0..1.0, -1.0..1.0, 8)?;
/// let found = impedances_in_plan(&soil.into(), &mat, &[0.0], StripContact::Relaxed, &mut unobserved)?;
/// // A square punch of side 2: 4.6092 μ/(1 − ν).
/// assert!((found[0].matrix[2][2].re * 0.75 / 4.6092 - 1.0).abs() < 2e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite; [`PlanError::CoarseCells`]
/// for less than six cells in a shear wave of the top layer;
/// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) without damping at a frequency at which guided
/// waves begin; [`GroundError::TooFine`](crate::bem::GroundError::TooFine) for a top layer too thin relative to the mat;
/// [`Error::Memory`](crate::Error::Memory); [`Error::Stopped`](crate::Error::Stopped) by the observer.
pub fn impedances_in_plan(
    profile: &SoilProfile,
    plan: &Plan,
    frequencies: &[f64],
    contact: StripContact,
    observer: &mut Observer<'_>,
) -> Result<Vec<PlanImpedance>> {
    let watch = &mut impedance_watch(frequencies, observer);
    profile.check()?;
    let mut lists = Vec::with_capacity(frequencies.len());
    for frequency in frequencies {
        lists.push(points(profile, plan.lattice.diagonal(), *frequency)?);
        check_cells(profile, plan, *frequency)?;
    }
    let all = lists.iter().flatten().copied();
    let integrals = Integrals::new(&plan.lattice, profile, all, TOLERANCE, watch)?;
    let parts: &[&[usize]] = match contact {
        StripContact::Bonded => &[&[0, 1, 2]],
        StripContact::Relaxed => &[&[0], &[1, 2]],
    };
    let sectors = Sectors::new(plan);
    let diagonal: [usize; MOTIONS] = std::array::from_fn(|i| (MOTIONS + 1) * i);
    let mut work = Workspace::default();
    let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; integrals.table.classes];
    let found = stiffnesses(&lists, &diagonal, watch, |s| {
        integrals.compliance(profile, s, &mut work, &mut values)?;
        let matrix = sectors.stiffness(&values, parts)?;
        Ok::<[Complex; ENTRIES], _>(std::array::from_fn(|k| matrix[k / MOTIONS][k % MOTIONS]))
    })?;
    let impedance = |(frequency, entries): (&f64, [Complex; ENTRIES])| {
        let matrix = std::array::from_fn(|i| std::array::from_fn(|j| entries[MOTIONS * i + j]));
        PlanImpedance { frequency: *frequency, matrix }
    };
    Ok(frequencies.iter().zip(found).map(impedance).collect())
}

/// Error for cells that do not resolve the waves of a frequency.
fn check_cells(profile: &SoilProfile, plan: &Plan, frequency: f64) -> Result<()> {
    let speed = profile.surface().map_or(f64::INFINITY, |soil| soil.shear_wave_speed());
    let (wavelength, [a, b]) = (speed / frequency, plan.pitch());
    let cell = a.max(b);
    if cell * RESOLVED > wavelength {
        let needed = RESOLVED;
        return Err(PlanError::CoarseCells { cell, frequency, wavelength, needed }.into());
    }
    Ok(())
}
