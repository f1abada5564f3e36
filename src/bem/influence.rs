//! Influence coefficients of boundary elements on an elastic half-plane, step by step.
//!
//! A unit traction acts on a source element during one time step. The coefficient is the mean displacement of a
//! receiver element n step ends later. With `c_S` = μ = 1 and τ = t/|x|
//!
//! * G = 1/(π l) ∫∫ w(x) f(t/|x|)/|x| dt dx = 1/(π l) ∫ f(τ) A(τ) dτ
//! * A(τ) = ∫ w(x) dx over t₀/τ < x < t₁/τ
//!
//! with l the length of the receiver, f the self-similar surface kernel (Cagniard–de Hoop; Achenbach 1973, ch. 7;
//! Kausel 2006) and w the length of overlap of the two elements shifted by x. For separate elements every term of A is
//! positive, so no digits are lost; differences of the closed-form double primitive lose up to fourteen digits here.
//!
//! | symbol | meaning |
//! |---|---|
//! | a, `τ_R` | `c_S`/`c_P`, `c_S`/`c_R` |
//! | t₀, t₁ | `c_S` (n−1)Δt, `c_S` nΔt, m |
//! | `c_k` | f = Σ `c_k` τ^(−2k−1) for τ > `τ_R` |
//! | `M_k` | (1/l) ∫ w x^(2k) dx |

use super::strip::Overlap;
use crate::error::{Result, positive, require, same_length};
use crate::fundamental::Surface;
use crate::fundamental::branch::{Branch, Branches, KernelWeight};
use crate::fundamental::rayleigh::{LATE_SERIES_TERMS, Rayleigh, late_coefficients};
use crate::geometry::ContactElement;
use crate::history::STRIP_KINDS;
use crate::linalg::gauss;
use crate::soil::Soil;

/// Step influence coefficients for one soil and one time step.
///
/// ```
/// use basemat::bem::{ContactElement, InfluenceKernel};
/// let soil = basemat::Soil::new(80.0e6, 0.25, 2000.0)?;
/// let kernel = InfluenceKernel::new(soil, 1.0e-3)?;
/// let left = ContactElement::new(0.0, 1.0);
/// let right = ContactElement::new(1.0, 2.0);
/// let influence = kernel.coefficients(left, right, 3)?;
/// assert!(influence.zz > 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct InfluenceKernel {
    pub(super) branches: Branches,
    /// `c_k` of zz and xx: 1/(πμ) ∫ Σ `c_k` x^(2k) t^(−2k−1) dt behind the Rayleigh wave.
    pub(super) late_series: [[f64; LATE_SERIES_TERMS]; 2],
    /// Way of a shear wave in a step, `c_S` Δt, m.
    pub(super) travel_per_step: f64,
    /// μ, Pa.
    shear_modulus: f64,
}

/// Smallest t₀/x, in Rayleigh arrivals, from which the series at late times is used.
const LATE_SERIES_ARRIVALS: f64 = 3.0;

impl InfluenceKernel {
    /// Kernel for a soil and a time step in seconds.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the time step is finite and above zero.
    pub fn new(soil: Soil, time_step: f64) -> Result<Self> {
        positive("time step", time_step)?;
        let travel_per_step = soil.shear_wave_speed() * time_step;
        positive("shear wave travel in a step", travel_per_step)?;
        let rayleigh = Rayleigh::new(soil);
        Ok(Self {
            branches: Branches::new(rayleigh),
            late_series: late_coefficients(&rayleigh),
            travel_per_step,
            shear_modulus: soil.shear_modulus(),
        })
    }

    /// Unit of the coefficients, 1/(πμ), 1/Pa.
    pub(super) fn unit(&self) -> f64 {
        1.0 / (std::f64::consts::PI * self.shear_modulus)
    }

    /// Computes the data of a pair of elements that do not depend on the lag.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both elements have finite ends, the left one first.
    pub(super) fn pair(
        &self,
        receiver: ContactElement,
        source: ContactElement,
    ) -> Result<PairInfluence<'_>> {
        let overlap = Overlap::new(receiver, source)?;
        let far = overlap.farthest();
        let mut moments = [0.0; LATE_SERIES_TERMS];
        let rule = gauss::largest();
        for i in 1..overlap.nodes.len() {
            let low = overlap.nodes[i - 1];
            let high = overlap.nodes[i];
            let slope = (overlap.even[i] - overlap.even[i - 1]) / (high - low);
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let inside = 0.5 * (high - low) * (1.0 + node);
                let width = overlap.even[i - 1] + slope * inside;
                let ratio = ((low + inside) / far).powi(2);
                let mut term = 0.5 * (high - low) * weight * width / overlap.length;
                for moment in &mut moments {
                    *moment += term;
                    term *= ratio;
                }
            }
        }
        Ok(PairInfluence { kernel: self, overlap, moments })
    }

    /// Mean displacements of the receiver due to a unit traction on the source, m/Pa.
    ///
    /// At lag n ≥ 1 they are the displacements at the end of the n-th step, with the traction during the first step.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a bad element or lag 0.
    pub fn coefficients(
        &self,
        receiver: ContactElement,
        source: ContactElement,
        lag: usize,
    ) -> Result<Surface> {
        require("lag", lag as f64, lag > 0, "at least 1")?;
        Ok(self.pair(receiver, source)?.coefficients(lag))
    }
}

/// A pair of elements and its step influence coefficients.
#[derive(Debug, Clone)]
pub(super) struct PairInfluence<'a> {
    kernel: &'a InfluenceKernel,
    overlap: Overlap,
    /// `M_k` divided by the 2k-th power of the largest offset.
    moments: [f64; LATE_SERIES_TERMS],
}

impl PairInfluence<'_> {
    /// The coefficients of one lag, from 1 on; zero before the pressure wave arrives.
    fn coefficients(&self, lag: usize) -> Surface {
        let travel_per_step = self.kernel.travel_per_step;
        let begin = (lag - 1) as f64 * travel_per_step;
        let end = lag as f64 * travel_per_step;
        let rayleigh_arrival = self.kernel.branches.rayleigh_arrival;
        if begin >= LATE_SERIES_ARRIVALS * rayleigh_arrival * self.overlap.farthest() {
            self.by_late_series(begin, end)
        } else {
            self.by_quadrature(begin, end)
        }
    }

    /// Overwrites the slices with lags `first`, `first + 1`, … of zz, xx and zx.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless the slices have one length; [`Error::Input`](crate::Error::Input)
    /// if `first` is 0.
    pub(super) fn fill(&self, first: usize, values: &mut [&mut [f64]; STRIP_KINDS]) -> Result<()> {
        let [zz, xx, zx] = values;
        require("first lag", first as f64, first > 0, "at least 1")?;
        same_length("xx coefficients", xx.len(), zz.len())?;
        same_length("zx coefficients", zx.len(), zz.len())?;
        for (i, ((zz, xx), zx)) in zz.iter_mut().zip(&mut **xx).zip(&mut **zx).enumerate() {
            let influence = self.coefficients(first.saturating_add(i));
            *zz = influence.zz;
            *xx = influence.xx;
            *zx = influence.zx;
        }
        Ok(())
    }

    /// The first lag from which zx is exactly zero: the Rayleigh wave has crossed the pair.
    pub(super) fn coupling_end(&self) -> usize {
        if !self.overlap.one_sided {
            return 1;
        }
        let InfluenceKernel { branches, travel_per_step, .. } = self.kernel;
        let crossing = branches.rayleigh_arrival * self.overlap.farthest() / travel_per_step;
        let mut lag = lag_from(crossing.floor());
        // A lag too large for an integer stays at the largest integer.
        while lag < usize::MAX && self.couples((lag.saturating_sub(1)) as f64 * travel_per_step) {
            lag += 1;
        }
        lag.max(1)
    }

    /// Whether zx may differ from zero in a step that begins at `begin`.
    fn couples(&self, begin: f64) -> bool {
        let branches = &self.kernel.branches;
        self.overlap.one_sided && begin < branches.rayleigh_arrival * self.overlap.farthest()
    }

    /// Σ `c_k` `M_k` ∫ t^(−2k−1) dt, each factor computed without cancellation.
    fn by_late_series(&self, begin: f64, end: f64) -> Surface {
        let kernel = self.kernel;
        let zz = &kernel.late_series[0];
        let xx = &kernel.late_series[1];
        let ratio = (begin / end).powi(2);
        let relative_distance = (self.overlap.farthest() / begin).powi(2);
        let first = self.moments[0] * (kernel.travel_per_step / begin).ln_1p();
        let mut sum = [zz[0] * first, xx[0] * first];
        // ∫ t^(−2k−1) dt = t₀^(−2k) (1 − r)(1 + r + … + r^(k−1))/(2k), r = (t₀/t₁)².
        let mut scale = relative_distance * kernel.travel_per_step * (begin + end) / (end * end);
        let mut series = 1.0;
        let mut power = ratio;
        let negligible = 1e-17 * first;
        for k in 1..LATE_SERIES_TERMS {
            let term = scale * series / (2 * k) as f64;
            sum[0] += zz[k] * self.moments[k] * term;
            sum[1] += xx[k] * self.moments[k] * term;
            if (zz[k].abs() + xx[k].abs()) * self.moments[k] * term < negligible {
                break;
            }
            scale *= relative_distance;
            series += power;
            power *= ratio;
        }
        let unit = kernel.unit();
        Surface { zz: sum[0] * unit, xx: sum[1] * unit, zx: 0.0 }
    }

    /// 1/(π μ l) ∫ f(τ) A(τ) dτ, between the τ at which the polynomial A changes.
    fn by_quadrature(&self, begin: f64, end: f64) -> Surface {
        let branches = &self.kernel.branches;
        let overlap = &self.overlap;
        let near = overlap.nearest();
        let far = overlap.farthest();
        let latest = if near > 0.0 { end / near } else { f64::INFINITY };
        let earliest = (begin / far).max(branches.pressure_arrival);
        if latest <= earliest {
            return Surface::default();
        }
        let mut breaks = [f64::INFINITY; 18];
        breaks[0] = earliest;
        let mut count = 1;
        for &x in overlap.nodes.iter().filter(|&&x| x > 0.0) {
            for tau in [begin / x, end / x] {
                if tau > earliest && tau < latest {
                    breaks[count] = tau;
                    count += 1;
                }
            }
        }
        breaks[..count].sort_unstable_by(f64::total_cmp);
        breaks[count] = latest;
        let couples = self.couples(begin);
        let duration = self.kernel.travel_per_step;
        // zz and xx are even in x; zx is odd.
        let mut even = [0.0; 2];
        let mut odd = [0.0; 2];
        for piece in breaks[..=count].windows(2) {
            let start = piece[0];
            let stop = piece[1];
            if stop <= start {
                continue;
            }
            let middle = 0.5 / start + 0.5 / stop;
            let passed = overlap.passed_overlap([begin, end], duration, middle, false);
            for branch in [Branch::Pressure, Branch::Shear, Branch::Tail] {
                branches.add_integral(branch, start, stop, &passed, &mut even);
            }
            if couples && start <= branches.rayleigh_arrival {
                let passed = overlap.passed_overlap([begin, end], duration, middle, true);
                branches.add_integral(Branch::OddLow, start, stop, &passed, &mut odd);
                branches.add_integral(Branch::OddHigh, start, stop, &passed, &mut odd);
                if stop > branches.rayleigh_arrival {
                    let pulse_overlap = passed.value(1.0 / branches.rayleigh_arrival);
                    odd[0] += branches.rayleigh_pulse * pulse_overlap;
                }
            }
        }
        let unit = 1.0 / (std::f64::consts::PI * self.kernel.shear_modulus * overlap.length);
        Surface { zz: even[0] * unit, xx: even[1] * unit, zx: odd[0] * unit }
    }
}

/// Converts a count to a lag; a count that is too large becomes the largest integer.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn lag_from(count: f64) -> usize {
    // Float to integer casts saturate.
    count.max(1.0) as usize
}
