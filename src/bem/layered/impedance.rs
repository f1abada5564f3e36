//! Dynamic stiffness of a rigid strip on layered ground.
//!
//! F(iω) are the element compliances. The columns of A are the resultants of unit tractions (horizontal, vertical,
//! rocking), which are also the rigid motions. The stiffness is K = Aᵀ F⁻¹ A.
//!
//! Without damping, poles lie on the path of the integrals at s = iω. K(s) is still analytic at this s, except at the
//! frequencies at which guided waves begin. It is therefore computed at iω + η, iω + 2η, … iω + 8η and extrapolated.

use basemat_fourier::num_complex::Complex64;

use super::passivity::assembled;
use super::static_compliance;
use super::wavenumber::{Compliances, StripWorkspace, Wavenumbers, unresolved};
use crate::error::{Error, Observer, ProgressReporter, Result, not_negative, require};
use crate::geometry::ContactElement;
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::linalg::DenseFactor;
use crate::soil::{Bedrock, SoilProfile};

/// Dynamic stiffness of a rigid, massless strip for motions e^(iωt), per metre of its length.
///
/// x to the right, y down; a positive rotation lowers the right end; forces act on the soil. The reference
/// point is the middle of the elements; for a body in a trench, the middle of its base. The real part is the stiffness
/// minus the inertia of the soil. The imaginary part is the damping by radiation and in the soil.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct StripImpedance {
    /// Frequency, Hz.
    pub frequency: f64,
    /// K_hh: horizontal force per unit horizontal translation, N/m².
    pub horizontal: Complex,
    /// K_vv: vertical force per unit vertical translation, N/m².
    pub vertical: Complex,
    /// K_rr: moment per unit rotation, N.
    pub rocking: Complex,
    /// K_hr: horizontal force per unit rotation, and moment per unit horizontal translation, N/m.
    pub coupling: Complex,
}

impl StripImpedance {
    /// Entries of the stiffness in the order of the fields.
    fn entries(&self) -> [Complex; 4] {
        [self.horizontal, self.vertical, self.rocking, self.coupling]
    }

    /// Spring stiffnesses Re K, in the order of the fields.
    pub fn stiffnesses(&self) -> [f64; 4] {
        self.entries().map(|k| k.re)
    }

    /// Dashpot coefficients Im K/ω in the same order; N s/m² for `horizontal`.
    ///
    /// At frequency zero they are not defined (NaN).
    pub fn dashpots(&self) -> [f64; 4] {
        self.entries().map(|k| k.im / (std::f64::consts::TAU * self.frequency))
    }
}

/// Contact of a rigid strip with the soil below.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum StripContact {
    /// Soil and strip move together.
    #[default]
    Bonded,
    /// Vertical motions cause no shear, horizontal motions no pressure; the coupling is zero.
    Relaxed,
}

/// Relative tolerance of the element compliances, far below the discretisation error.
const COMPLIANCE_TOLERANCE: f64 = 1e-9;
/// Largest Im μ/|μ| of an undamped layer, whose poles are too close to the path of the integrals.
const UNDAMPED_LOSS_RATIO: f64 = 1e-6;
/// Number of points of the extrapolation for a frequency, with which it has engineering accuracy.
const POINTS_PER_FREQUENCY: usize = 8;
/// Largest distance between these points, relative to ω, for an accurate extrapolation.
const MAX_SPACING_PER_FREQUENCY: f64 = 0.04;
/// Largest distance between these points, times the travel time of waves, for an accurate extrapolation.
const MAX_SPACING_BY_TRAVEL_TIME: f64 = 0.1;
/// Largest relative difference between the extrapolations from 8 and from 7 points, for engineering accuracy.
const EXTRAPOLATION_TOLERANCE: f64 = 1e-3;

/// Reporter of progress for impedances at `frequencies`: it counts Laplace variables, eight per frequency.
pub(in crate::bem) fn impedance_progress<'a>(
    frequencies: &[f64],
    observer: &'a mut Observer<'_>,
) -> ProgressReporter<'a> {
    ProgressReporter::new("impedances", POINTS_PER_FREQUENCY * frequencies.len(), observer)
}

/// Dynamic stiffness of all `elements` on `profile` as one rigid body, at each of `frequencies` (Hz).
pub(in crate::bem) fn strip_impedances(
    profile: &SoilProfile,
    elements: &[ContactElement],
    frequencies: &[f64],
    contact: StripContact,
    progress: &mut ProgressReporter,
) -> Result<Vec<StripImpedance>> {
    let strip = RigidStripSystem::new(profile, elements, contact)?;
    let mut variables = Vec::with_capacity(frequencies.len());
    for frequency in frequencies {
        let is_defined = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
        require("frequency of an impedance on a half-plane", *frequency, is_defined, "above zero")?;
        variables.push(laplace_variables(profile, strip.classes.span(), *frequency)?);
    }
    let stiffnesses =
        extrapolated_stiffnesses(&variables, &[0, 1, 2], progress, |s| strip.stiffness(s))?;
    let mut impedances = Vec::with_capacity(frequencies.len());
    for (&frequency, entries) in frequencies.iter().zip(stiffnesses) {
        impedances.push(StripImpedance {
            frequency,
            horizontal: entries[0],
            vertical: entries[1],
            rocking: entries[2],
            coupling: entries[3],
        });
    }
    Ok(impedances)
}

/// Laplace variables at which the stiffness is evaluated for a `frequency` (Hz) and elements over `span` (m).
///
/// With damped layers the only variable is iω; with undamped layers there are [`POINTS_PER_FREQUENCY`] points next to iω.
pub(in crate::bem) fn laplace_variables(
    profile: &SoilProfile,
    span: f64,
    frequency: f64,
) -> Result<Vec<Complex>> {
    let omega = std::f64::consts::TAU * not_negative("frequency of an impedance", frequency)?;
    let s = Complex::new(0.0, omega);
    let mut moduli = vec![];
    profile.moduli(s, &mut moduli)?;
    let is_damped =
        moduli.iter().all(|modulus| modulus.im.abs() > UNDAMPED_LOSS_RATIO * modulus.abs());
    if is_damped || omega == 0.0 {
        return Ok(vec![s]);
    }
    let speed = profile.surface().map_or(f64::INFINITY, |soil| soil.shear_wave_speed());
    let travel_time = span / speed + 2.0 * profile.travel_time();
    let spacing = (MAX_SPACING_PER_FREQUENCY * omega).min(MAX_SPACING_BY_TRAVEL_TIME / travel_time);
    Ok((1..=POINTS_PER_FREQUENCY).map(|j| Complex::new(spacing * j as f64, omega)).collect())
}

/// Stiffness K(iω) of each frequency from its samples at the [`laplace_variables`] of the frequency.
///
/// `stiffness` returns a sample; each is reported to `progress`. The entries in `checked_entries` must agree between the
/// extrapolations from all samples and from all but the last.
///
/// # Errors
/// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) if the entries do not agree; as for `stiffness`.
pub(in crate::bem) fn extrapolated_stiffnesses<const N: usize>(
    variables: &[Vec<Complex>],
    checked_entries: &[usize],
    progress: &mut ProgressReporter,
    mut stiffness: impl FnMut(Complex) -> Result<[Complex; N]>,
) -> Result<Vec<[Complex; N]>> {
    let mut stiffnesses = Vec::with_capacity(variables.len());
    for (index, frequency_variables) in variables.iter().enumerate() {
        let mut samples = Vec::with_capacity(frequency_variables.len());
        for s in frequency_variables {
            samples.push(stiffness(*s)?);
            if samples.len() < frequency_variables.len() {
                progress.reach(POINTS_PER_FREQUENCY * index + samples.len())?;
            }
        }
        stiffnesses.push(extrapolate(&samples, checked_entries, frequency_variables[0].im)?);
        progress.reach(POINTS_PER_FREQUENCY * (index + 1))?;
    }
    Ok(stiffnesses)
}

/// Stiffness K(iω) at one frequency, extrapolated from its samples.
fn extrapolate<const N: usize>(
    samples: &[[Complex; N]],
    checked_entries: &[usize],
    omega: f64,
) -> Result<[Complex; N]> {
    if let [sample] = samples {
        return Ok(*sample);
    }
    let stiffness = polynomial_at_zero(samples);
    let coarse_stiffness = polynomial_at_zero(&samples[..samples.len() - 1]);
    for &entry in checked_entries {
        let change = (stiffness[entry] - coarse_stiffness[entry]).abs();
        if change.is_nan() || change > EXTRAPOLATION_TOLERANCE * stiffness[entry].abs() {
            return Err(unresolved(Complex::new(0.0, omega), 0.0));
        }
    }
    Ok(stiffness)
}

/// Value at zero of the Lagrange polynomial through samples at 1, 2, ….
fn polynomial_at_zero<const N: usize>(samples: &[[Complex; N]]) -> [Complex; N] {
    let sample_count = samples.len();
    let mut sums = [Complex::default(); N];
    for (j, sample) in (1..=sample_count).zip(samples) {
        let other_points = (1..=sample_count).filter(|m| *m != j);
        let weight: f64 = other_points.map(|m| m as f64 / (m as f64 - j as f64)).product();
        for (sum, value) in sums.iter_mut().zip(sample) {
            *sum += value.scale(weight);
        }
    }
    sums
}

/// Rigid strip on a layered ground, for its stiffness.
struct RigidStripSystem<'a> {
    profile: &'a SoilProfile,
    contact: StripContact,
    classes: PairClasses,
    integrals: Wavenumbers,
    /// Resultants of unit tractions: 2Q rows, three columns.
    motions: Vec<Complex64>,
}

impl<'a> RigidStripSystem<'a> {
    fn new(
        profile: &'a SoilProfile,
        elements: &[ContactElement],
        contact: StripContact,
    ) -> Result<Self> {
        let classes = PairClasses::new(elements.to_vec())?;
        let integrals = Wavenumbers::new(&classes, COMPLIANCE_TOLERANCE);
        let layout = classes.layout();
        let middle = 0.5 * (elements[0].left() + elements[elements.len() - 1].right());
        let mut motions = vec![Complex64::default(); 3 * layout.len()];
        for (e, element) in elements.iter().enumerate() {
            let length = element.length();
            let vertical_row = layout.index_of(0, e);
            let horizontal_row = layout.index_of(1, e);
            motions[3 * horizontal_row].re = length;
            motions[3 * vertical_row + 1].re = length;
            motions[3 * vertical_row + 2].re = length * (element.center()[0] - middle);
        }
        Ok(Self { profile, contact, classes, integrals, motions })
    }

    /// Entries hh, vv, rr and hr of Aᵀ F⁻¹ A.
    fn stiffness(&self, s: Complex) -> Result<[Complex; 4]> {
        let compliances = if s == Complex::default() {
            static_compliance::pair_compliances(self.profile, &self.classes)?
        } else {
            let mut values = vec![[Complex::default(); STRIP_KINDS]; self.classes.count()];
            self.integrals.compliance(
                self.profile,
                s,
                &mut StripWorkspace::default(),
                &mut values,
            )?;
            values
        };
        let mut matrix = assembled(&self.classes, &compliances);
        let layout = self.classes.layout();
        let order = layout.len();
        if self.contact == StripContact::Relaxed {
            for (index, value) in matrix.iter_mut().enumerate() {
                // Displacements in another direction than the traction are set to zero.
                if layout.component_and_element(index / order)[0]
                    != layout.component_and_element(index % order)[0]
                {
                    *value = Complex64::default();
                }
            }
        }
        let mut tractions = self.motions.clone();
        let mut factor = DenseFactor::with_columns(order, 3);
        if !factor.factor(&matrix, order) {
            return Err(Error::Singular { matrix: "compliance of a strip", order });
        }
        factor.solve_columns(&mut tractions, 3);
        let coupling =
            (self.resultant(&tractions, 0, 2) + self.resultant(&tractions, 2, 0)).scale(0.5);
        let diagonal = [0, 1, 2].map(|i| self.resultant(&tractions, i, i));
        Ok([diagonal[0], diagonal[1], diagonal[2], coupling])
    }

    /// Resultant in the rigid motion `i` of the tractions due to the motion `j`.
    fn resultant(&self, tractions: &[Complex64], i: usize, j: usize) -> Complex {
        let rows = self.motions.chunks_exact(3).zip(tractions.chunks_exact(3));
        let sum: Complex64 = rows.map(|(motion, traction)| motion[i] * traction[j]).sum();
        Complex::new(sum.re, sum.im)
    }
}
