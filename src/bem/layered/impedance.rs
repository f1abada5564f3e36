//! Dynamic stiffness of a rigid strip on layered ground.
//!
//! F(iω) are the element compliances. The columns of A are the resultants of unit tractions (horizontal,
//! vertical, rocking), which also describe the rigid motions. Then K = Aᵀ F⁻¹ A.
//!
//! Without damping, poles lie on the path of the integrals at s = iω. K(s) is nevertheless analytic there,
//! except at the frequencies at which guided waves begin. It is therefore evaluated at iω + η, 2η, … 8η and
//! extrapolated.

use realfft::num_complex::Complex64;

use super::passivity::assembled;
use super::static_compliance;
use super::wavenumber::{Compliances, Wavenumbers, Workspace, unresolved};
use crate::error::{Error, Observer, Result, Watch, not_negative, require};
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
    fn all(&self) -> [Complex; 4] {
        [self.horizontal, self.vertical, self.rocking, self.coupling]
    }

    /// Spring stiffnesses Re K, in the order of the fields.
    pub fn stiffnesses(&self) -> [f64; 4] {
        self.all().map(|k| k.re)
    }

    /// Dashpot coefficients Im K/ω in the same order; N s/m² for `horizontal`.
    ///
    /// At frequency zero they are not defined (NaN).
    pub fn dashpots(&self) -> [f64; 4] {
        self.all().map(|k| k.im / (std::f64::consts::TAU * self.frequency))
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
    /// Vertical motions without shear, horizontal motions without pressure; no coupling.
    Relaxed,
}

/// Accuracy of the element compliances; the error of the elements themselves is much larger.
const TOLERANCE: f64 = 1e-9;
/// Im μ/|μ| below which a layer counts as undamped.
const LOSSLESS: f64 = 1e-6;
/// Number of points of the extrapolation.
const PER_FREQUENCY: usize = 8;
/// Distance of the points relative to ω, and to the inverse of the wave travel time.
const SPACING: [f64; 2] = [0.04, 0.1];
/// Largest relative difference between the extrapolations from 8 and from 7 points.
const SETTLED: f64 = 1e-3;

/// Progress of impedances at `frequencies`; its parts are points of the Laplace plane, eight per frequency.
pub(in crate::bem) fn impedance_watch<'a>(
    frequencies: &[f64],
    observer: &'a mut Observer<'_>,
) -> Watch<'a> {
    Watch::new("impedances", PER_FREQUENCY * frequencies.len(), observer)
}

/// Dynamic stiffness of all `elements` on `profile` as one rigid body, at each of `frequencies` (Hz).
pub(in crate::bem) fn strip_impedances(
    profile: &SoilProfile,
    elements: &[ContactElement],
    frequencies: &[f64],
    contact: StripContact,
    watch: &mut Watch,
) -> Result<Vec<StripImpedance>> {
    let strip = RigidStrip::new(profile, elements, contact)?;
    let mut lists = Vec::with_capacity(frequencies.len());
    for frequency in frequencies {
        let exists = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
        require("frequency of an impedance on a half-plane", *frequency, exists, "above zero")?;
        lists.push(points(profile, strip.classes.span(), *frequency)?);
    }
    let found = stiffnesses(&lists, &[0, 1, 2], watch, |s| strip.stiffness(s))?;
    let impedance = |(frequency, values): (&f64, [Complex; 4])| {
        let [horizontal, vertical, rocking, coupling] = values;
        StripImpedance { frequency: *frequency, horizontal, vertical, rocking, coupling }
    };
    Ok(frequencies.iter().zip(found).map(impedance).collect())
}

/// Laplace variables at which the stiffness is evaluated for a `frequency` (Hz) and elements over `span` (m).
///
/// The only variable is iω; with undamped layers, [`PER_FREQUENCY`] points next to iω.
pub(in crate::bem) fn points(
    profile: &SoilProfile,
    span: f64,
    frequency: f64,
) -> Result<Vec<Complex>> {
    let omega = std::f64::consts::TAU * not_negative("frequency of an impedance", frequency)?;
    let s = Complex::new(0.0, omega);
    let mut moduli = vec![];
    profile.moduli(s, &mut moduli)?;
    let damped = moduli.iter().all(|modulus| modulus.im.abs() > LOSSLESS * modulus.abs());
    if damped || omega == 0.0 {
        return Ok(vec![s]);
    }
    let slowest = profile.surface().map_or(f64::INFINITY, |soil| soil.shear_wave_speed());
    let time = span / slowest + 2.0 * profile.travel_time();
    let step = (SPACING[0] * omega).min(SPACING[1] / time);
    Ok((1..=PER_FREQUENCY).map(|j| Complex::new(step * j as f64, omega)).collect())
}

/// K(iω) from its samples `at` the [`points`] of each frequency; `watch` is notified of each sample.
///
/// The entries `judged` must agree between the extrapolations from all samples and from all but the last.
///
/// # Errors
/// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) if the entries do not agree; as for `at`.
pub(in crate::bem) fn stiffnesses<const N: usize>(
    lists: &[Vec<Complex>],
    judged: &[usize],
    watch: &mut Watch,
    mut at: impl FnMut(Complex) -> Result<[Complex; N]>,
) -> Result<Vec<[Complex; N]>> {
    let mut found = Vec::with_capacity(lists.len());
    for (number, list) in lists.iter().enumerate() {
        let mut samples = Vec::with_capacity(list.len());
        for s in list {
            samples.push(at(*s)?);
            if samples.len() < list.len() {
                watch.reach(PER_FREQUENCY * number + samples.len())?;
            }
        }
        found.push(extrapolated(&samples, judged, list[0].im)?);
        watch.reach(PER_FREQUENCY * (number + 1))?;
    }
    Ok(found)
}

/// K(iω) at one frequency from its samples.
fn extrapolated<const N: usize>(
    samples: &[[Complex; N]],
    judged: &[usize],
    omega: f64,
) -> Result<[Complex; N]> {
    if let [only] = samples {
        return Ok(*only);
    }
    // Lagrange's polynomial at zero.
    let limit = |count: usize| {
        let mut sum = [Complex::default(); N];
        for (j, sample) in (1..=count).zip(samples) {
            let others = (1..=count).filter(|m| *m != j);
            let weight: f64 = others.map(|m| m as f64 / (m as f64 - j as f64)).product();
            for (sum, value) in sum.iter_mut().zip(sample) {
                *sum += value.scale(weight);
            }
        }
        sum
    };
    let (found, coarse) = (limit(samples.len()), limit(samples.len() - 1));
    for place in judged {
        let change = (found[*place] - coarse[*place]).abs();
        if change.is_nan() || change > SETTLED * found[*place].abs() {
            return Err(unresolved(Complex::new(0.0, omega), 0.0));
        }
    }
    Ok(found)
}

struct RigidStrip<'a> {
    profile: &'a SoilProfile,
    contact: StripContact,
    classes: PairClasses,
    integrals: Wavenumbers,
    /// Resultants of unit tractions: 2Q rows, three columns.
    motions: Vec<Complex64>,
}

impl<'a> RigidStrip<'a> {
    fn new(
        profile: &'a SoilProfile,
        elements: &[ContactElement],
        contact: StripContact,
    ) -> Result<Self> {
        let classes = PairClasses::new(elements.to_vec())?;
        let integrals = Wavenumbers::new(&classes, TOLERANCE);
        let layout = classes.layout();
        let middle = 0.5 * (elements[0].left() + elements[elements.len() - 1].right());
        let mut motions = vec![Complex64::default(); 3 * layout.len()];
        for (p, element) in elements.iter().enumerate() {
            let (length, [down, along]) = (element.length(), layout.places(p));
            motions[3 * along].re = length;
            motions[3 * down + 1].re = length;
            motions[3 * down + 2].re = length * (element.center()[0] - middle);
        }
        Ok(Self { profile, contact, classes, integrals, motions })
    }

    /// Entries hh, vv, rr and hr of Aᵀ F⁻¹ A.
    fn stiffness(&self, s: Complex) -> Result<[Complex; 4]> {
        let compliances = if s == Complex::default() {
            static_compliance::pairs(self.profile, &self.classes)?
        } else {
            let mut values = vec![[Complex::default(); STRIP_KINDS]; self.classes.count()];
            self.integrals.compliance(self.profile, s, &mut Workspace::default(), &mut values)?;
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
        let product = |i: usize, j: usize| {
            let rows = self.motions.chunks_exact(3).zip(tractions.chunks_exact(3));
            let sum: Complex64 = rows.map(|(a, t)| a[i] * t[j]).sum();
            Complex::new(sum.re, sum.im)
        };
        let coupling = (product(0, 2) + product(2, 0)).scale(0.5);
        Ok([product(0, 0), product(1, 1), product(2, 2), coupling])
    }
}
