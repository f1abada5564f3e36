//! Dynamic stiffness of a rigid strip on layered ground.
//!
//! F(iω) are the element compliances. The columns of A are the resultants of unit tractions (horizontal,
//! vertical, rocking), which also describe the rigid motions. Then K = Aᵀ F⁻¹ A.
//!
//! Without damping, poles lie on the path of the integrals at s = iω. K(s) is nevertheless analytic there,
//! except at the frequencies at which guided waves begin. It is therefore evaluated at iω + η, 2η, … 8η and
//! extrapolated.

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
/// point is the middle of the patch, and of the base of a body in a trench. The real part is stiffness (less the
/// inertia of soil that moves along). The imaginary part is damping, by radiation and in the soil.
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
    /// The entries, in the order of the fields.
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
    /// Vertical motions cause no shear, horizontal motions no pressure; no coupling.
    Relaxed,
}

/// Relative tolerance of the element compliances; the error of the elements themselves is much larger.
const COMPLIANCE_TOLERANCE: f64 = 1e-9;
/// Largest Im μ/|μ| of a layer that counts as undamped.
const UNDAMPED_LOSS_RATIO: f64 = 1e-6;
/// Number of points of the extrapolation.
const POINTS_PER_FREQUENCY: usize = 8;
/// Largest distance between these points, relative to ω.
const MAX_SPACING_PER_FREQUENCY: f64 = 0.04;
/// Largest distance between these points, times the travel time of waves.
const MAX_SPACING_BY_TRAVEL_TIME: f64 = 0.1;
/// Largest relative difference between the extrapolations from 8 and from 7 points.
const EXTRAPOLATION_TOLERANCE: f64 = 1e-3;

/// Progress of impedances at `frequencies`; its parts are points of the Laplace plane, eight per frequency.
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
    watch: &mut ProgressReporter,
) -> Result<Vec<StripImpedance>> {
    let strip = RigidStripSystem::new(profile, elements, contact)?;
    let mut variables = Vec::with_capacity(frequencies.len());
    for frequency in frequencies {
        let exists = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
        require("frequency of an impedance on a half-plane", *frequency, exists, "above zero")?;
        variables.push(laplace_variables(profile, strip.classes.span(), *frequency)?);
    }
    let stiffnesses =
        extrapolated_stiffnesses(&variables, &[0, 1, 2], watch, |s| strip.stiffness(s))?;
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
/// The only variable is iω; with undamped layers, [`POINTS_PER_FREQUENCY`] points next to iω.
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

/// K(iω) of each frequency from its samples at the [`laplace_variables`] of the frequency.
///
/// `stiffness` returns a sample; `watch` is notified of each. The entries in `checked_entries` must agree between the
/// extrapolations from all samples and from all but the last.
///
/// # Errors
/// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) if the entries do not agree; as for `stiffness`.
pub(in crate::bem) fn extrapolated_stiffnesses<const N: usize>(
    variables: &[Vec<Complex>],
    checked_entries: &[usize],
    watch: &mut ProgressReporter,
    mut stiffness: impl FnMut(Complex) -> Result<[Complex; N]>,
) -> Result<Vec<[Complex; N]>> {
    let mut stiffnesses = Vec::with_capacity(variables.len());
    for (number, points) in variables.iter().enumerate() {
        let mut samples = Vec::with_capacity(points.len());
        for s in points {
            samples.push(stiffness(*s)?);
            if samples.len() < points.len() {
                watch.reach(POINTS_PER_FREQUENCY * number + samples.len())?;
            }
        }
        stiffnesses.push(extrapolate(&samples, checked_entries, points[0].im)?);
        watch.reach(POINTS_PER_FREQUENCY * (number + 1))?;
    }
    Ok(stiffnesses)
}

/// K(iω) at one frequency from its samples.
fn extrapolate<const N: usize>(
    samples: &[[Complex; N]],
    checked_entries: &[usize],
    omega: f64,
) -> Result<[Complex; N]> {
    if let [sample] = samples {
        return Ok(*sample);
    }
    let limit = polynomial_at_zero(samples);
    let coarse_limit = polynomial_at_zero(&samples[..samples.len() - 1]);
    for &entry in checked_entries {
        let change = (limit[entry] - coarse_limit[entry]).abs();
        if change.is_nan() || change > EXTRAPOLATION_TOLERANCE * limit[entry].abs() {
            return Err(unresolved(Complex::new(0.0, omega), 0.0));
        }
    }
    Ok(limit)
}

/// Lagrange's polynomial through samples at 1, 2, …, at zero.
fn polynomial_at_zero<const N: usize>(samples: &[[Complex; N]]) -> [Complex; N] {
    let count = samples.len();
    let mut sum = [Complex::default(); N];
    for (j, sample) in (1..=count).zip(samples) {
        let others = (1..=count).filter(|m| *m != j);
        let weight: f64 = others.map(|m| m as f64 / (m as f64 - j as f64)).product();
        for (sum, value) in sum.iter_mut().zip(sample) {
            *sum += value.scale(weight);
        }
    }
    sum
}

/// A rigid strip on a layered ground.
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
        for (p, element) in elements.iter().enumerate() {
            let length = element.length();
            let vertical = layout.place(0, p);
            let horizontal = layout.place(1, p);
            motions[3 * horizontal].re = length;
            motions[3 * vertical + 1].re = length;
            motions[3 * vertical + 2].re = length * (element.center()[0] - middle);
        }
        Ok(Self { profile, contact, classes, integrals, motions })
    }

    /// Entries hh, vv, rr and hr of Aᵀ F⁻¹ A.
    fn stiffness(&self, s: Complex) -> Result<[Complex; 4]> {
        let compliances = if s == Complex::default() {
            static_compliance::pairs(self.profile, &self.classes)?
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
            for (place, value) in matrix.iter_mut().enumerate() {
                // Displacements in another direction than the traction are set to zero.
                if layout.origin(place / order)[0] != layout.origin(place % order)[0] {
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
