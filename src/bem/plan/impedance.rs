//! Dynamic stiffness of rigid mats in plan.
//!
//! Without damping, poles lie on the path of the integrals at s = iω. The stiffness is still analytic at this s. It is
//! therefore computed at iω + η, iω + 2η, … iω + 8η and extrapolated.

use super::cells::Plan;
use super::integrals::{CellIntegrals, CellWorkspace};
use super::sectors::{RIGID_MOTION_COUNT, Sectors};
use crate::bem::layered::{
    Compliances, StripContact, extrapolated_stiffnesses, impedance_progress, laplace_variables,
};
use crate::error::{Observer, PlanError, Result};
use crate::geometry::COMPLIANCES_PER_OFFSET;
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
    /// The order is along x, y, z and about these axes; the matrix is symmetric. The real part is the stiffness minus the
    /// inertia of the soil. The imaginary part is the damping by radiation and in the soil.
    pub matrix: [[Complex; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
}

impl PlanImpedance {
    /// Spring stiffnesses Re K, N/m, N and N m.
    pub fn stiffnesses(&self) -> [[f64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT] {
        self.matrix.map(|row| row.map(|k| k.re))
    }

    /// Dashpot coefficients Im K/ω parallel to the springs, N s/m, N s and N m s; NaN at frequency zero.
    pub fn dashpots(&self) -> [[f64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT] {
        self.matrix.map(|row| row.map(|k| k.im / (std::f64::consts::TAU * self.frequency)))
    }
}

/// Relative tolerance of the cells' compliances, far below the discretisation error.
const COMPLIANCE_TOLERANCE: f64 = 1e-9;
/// Smallest number of cells per wavelength, because tractions are constant over a cell.
const MIN_CELLS_PER_WAVELENGTH: f64 = 6.0;
/// Number of entries of a stiffness matrix.
const MATRIX_ENTRY_COUNT: usize = RIGID_MOTION_COUNT * RIGID_MOTION_COUNT;

/// Dynamic stiffness of the rigid mats of `plan` on `profile` at each of `frequencies` (Hz).
///
/// Frequency 0 is the static stiffness. Layers may have any damping, also hysteretic damping; without damping the
/// computation takes eight times as long. In relaxed contact, vertical motions and rocking cause no shear tractions, and
/// horizontal motions and torsion no pressure. Tractions are constant over the contact elements, which are cells or
/// unions of cells. The progress for the observer is the number of Laplace variables, eight per frequency.
///
/// ```
/// use basemat::bem::layered::StripContact;
/// use basemat::bem::plan::{Plan, impedances_in_plan};
/// use basemat::{Soil, unobserved};
/// let soil = Soil::new(1.0, 0.25, 1.0)?;
/// let mat = Plan::rectangle(-1.0..1.0, -1.0..1.0, 8)?;
/// let impedances = impedances_in_plan(&soil.into(), &mat, &[0.0], StripContact::Relaxed, &mut unobserved)?;
/// // The static stiffness of a square punch of side 2 is 4.6092 μ/(1 − ν).
/// assert!((impedances[0].matrix[2][2].re * 0.75 / 4.6092 - 1.0).abs() < 2e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) for a frequency that is negative or not finite;
/// [`Error::Size`](crate::Error::Size) for rigid bedrock without layers; [`PlanError::CoarseCells`]
/// for less than six cells per wavelength of shear waves in the top layer;
/// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) without damping at a frequency at which guided
/// waves begin; [`GroundError::TooFine`](crate::bem::GroundError::TooFine) for a top layer that is too thin relative to the mat;
/// [`Error::Memory`](crate::Error::Memory); [`Error::Stopped`](crate::Error::Stopped) by the observer.
pub fn impedances_in_plan(
    profile: &SoilProfile,
    plan: &Plan,
    frequencies: &[f64],
    contact: StripContact,
    observer: &mut Observer<'_>,
) -> Result<Vec<PlanImpedance>> {
    let progress = &mut impedance_progress(frequencies, observer);
    profile.check()?;
    let mut variables = Vec::with_capacity(frequencies.len());
    for frequency in frequencies {
        variables.push(laplace_variables(profile, plan.lattice.diagonal(), *frequency)?);
        check_resolution(profile, plan, *frequency)?;
    }
    let all_variables = variables.iter().flatten().copied();
    let integrals =
        CellIntegrals::new(&plan.lattice, profile, all_variables, COMPLIANCE_TOLERANCE, progress)?;
    let coupled_components: &[&[usize]] = match contact {
        StripContact::Bonded => &[&[0, 1, 2]],
        StripContact::Relaxed => &[&[0], &[1, 2]],
    };
    let sectors = Sectors::new(plan);
    let diagonal: [usize; RIGID_MOTION_COUNT] =
        std::array::from_fn(|i| (RIGID_MOTION_COUNT + 1) * i);
    let mut workspace = CellWorkspace::default();
    let mut values =
        vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; integrals.table.class_count];
    let stiffnesses = extrapolated_stiffnesses(&variables, &diagonal, progress, |s| {
        integrals.compliance(profile, s, &mut workspace, &mut values)?;
        let matrix = sectors.stiffness(&values, coupled_components)?;
        let mut entries = [Complex::default(); MATRIX_ENTRY_COUNT];
        entries.copy_from_slice(matrix.as_flattened());
        Ok(entries)
    })?;
    let mut impedances = Vec::with_capacity(frequencies.len());
    for (&frequency, entries) in frequencies.iter().zip(stiffnesses) {
        let matrix = [0, 1, 2, 3, 4, 5]
            .map(|i| [0, 1, 2, 3, 4, 5].map(|j| entries[RIGID_MOTION_COUNT * i + j]));
        impedances.push(PlanImpedance { frequency, matrix });
    }
    Ok(impedances)
}

/// Error for cells that do not resolve the shear waves at a frequency.
fn check_resolution(profile: &SoilProfile, plan: &Plan, frequency: f64) -> Result<()> {
    let speed = profile.surface().map_or(f64::INFINITY, |soil| soil.shear_wave_speed());
    let wavelength = speed / frequency;
    let cell = plan.pitch()[0].max(plan.pitch()[1]);
    let needed = MIN_CELLS_PER_WAVELENGTH;
    if cell * needed > wavelength {
        return Err(PlanError::CoarseCells { cell, frequency, wavelength, needed }.into());
    }
    Ok(())
}
