//! Influence coefficients of boundary elements on an elastic half-plane, step by step.
//!
//! A unit traction acts on a source element during one time step. The coefficient is the mean displacement of a
//! receiver element n step ends later. With `c_S` = μ = 1 and τ = t/|x|
//!
//! * G = 1/(π l) ∫∫ w(x) f(t/|x|)/|x| dt dx = 1/(π l) ∫ f(τ) A(τ) dτ
//! * A(τ) = ∫ w(x) dx over t₀/τ < x < t₁/τ
//!
//! with l the length of the receiver, f the self-similar surface kernel (Cagniard–de Hoop; Achenbach 1973, ch. 7;
//! Kausel 2006) and w the overlap length of the two elements shifted by x. For separate elements every term of A is
//! positive, so that no digits are lost. Differences of the closed-form double primitive would lose up to fourteen
//! digits.
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

/// Influence coefficients of element pairs for one soil and one time step.
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
    /// Coefficients `c_k` of zz and xx: the response is 1/(πμ) ∫ Σ `c_k` x^(2k) t^(−2k−1) dt behind the Rayleigh wave.
    pub(super) late_series: [[f64; LATE_SERIES_TERMS]; 2],
    /// Distance that a shear wave travels in a step, `c_S` Δt, m.
    pub(super) travel_per_step: f64,
    /// Shear modulus μ, Pa.
    shear_modulus: f64,
}

/// Smallest t₀/x, relative to the Rayleigh wave's arrival, for the late-time series, which then converges fast.
const LATE_SERIES_ARRIVALS: f64 = 3.0;
/// Terms of the late-time series below this fraction of the first term do not change a sum in double precision.
const NEGLIGIBLE_TERM_FRACTION: f64 = 1e-17;
/// Largest number of τ at which A(τ) changes: more than two for each of five nodes, and two limits.
const MAX_BREAK_COUNT: usize = 18;

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

    /// Common factor 1/(πμ) of the coefficients, 1/Pa.
    pub(super) fn compliance_factor(&self) -> f64 {
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
        let max_offset = overlap.max_offset();
        let w = &overlap.even_overlaps;
        let mut moments = [0.0; LATE_SERIES_TERMS];
        let rule = gauss::largest_rule();
        for i in 1..overlap.nodes.len() {
            let x0 = overlap.nodes[i - 1];
            let x1 = overlap.nodes[i];
            let slope = (w[i] - w[i - 1]) / (x1 - x0);
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let distance = 0.5 * (x1 - x0) * (1.0 + node);
                let overlap_length = w[i - 1] + slope * distance;
                let relative_offset_squared = ((x0 + distance) / max_offset).powi(2);
                let mut term = 0.5 * (x1 - x0) * weight * overlap_length / overlap.receiver_length;
                for moment in &mut moments {
                    *moment += term;
                    term *= relative_offset_squared;
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
    /// [`Error::Input`](crate::Error::Input) for an element without finite ends in order, or lag 0.
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
        let t0 = (lag - 1) as f64 * travel_per_step;
        let t1 = lag as f64 * travel_per_step;
        let rayleigh_arrival = self.kernel.branches.rayleigh_arrival;
        if t0 >= LATE_SERIES_ARRIVALS * rayleigh_arrival * self.overlap.max_offset() {
            self.by_late_series(t0, t1)
        } else {
            self.by_quadrature(t0, t1)
        }
    }

    /// Overwrites the slices with lags `first_lag`, `first_lag + 1`, … of zz, xx and zx.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless the slices have one length; [`Error::Input`](crate::Error::Input)
    /// if `first_lag` is 0.
    pub(super) fn fill(
        &self,
        first_lag: usize,
        values: &mut [&mut [f64]; STRIP_KINDS],
    ) -> Result<()> {
        let [zz, xx, zx] = values;
        require("first lag", first_lag as f64, first_lag > 0, "at least 1")?;
        same_length("xx coefficients", xx.len(), zz.len())?;
        same_length("zx coefficients", zx.len(), zz.len())?;
        for (i, ((zz, xx), zx)) in zz.iter_mut().zip(&mut **xx).zip(&mut **zx).enumerate() {
            let influence = self.coefficients(first_lag.saturating_add(i));
            *zz = influence.zz;
            *xx = influence.xx;
            *zx = influence.zx;
        }
        Ok(())
    }

    /// The first lag from which zx is exactly zero: the Rayleigh wave has crossed the pair.
    pub(super) fn coupling_end(&self) -> usize {
        if !self.overlap.is_one_sided {
            return 1;
        }
        let InfluenceKernel { branches, travel_per_step, .. } = self.kernel;
        let crossing = branches.rayleigh_arrival * self.overlap.max_offset() / travel_per_step;
        let mut lag = lag_from(crossing.floor());
        // A lag beyond the largest integer stays at the largest integer.
        while lag < usize::MAX
            && self.has_coupling((lag.saturating_sub(1)) as f64 * travel_per_step)
        {
            lag += 1;
        }
        lag.max(1)
    }

    /// Whether zx may differ from zero in a step from t₀ on.
    fn has_coupling(&self, t0: f64) -> bool {
        let branches = &self.kernel.branches;
        self.overlap.is_one_sided && t0 < branches.rayleigh_arrival * self.overlap.max_offset()
    }

    /// Displacements from t₀ to t₁ by the late-time series Σ `c_k` `M_k` ∫ t^(−2k−1) dt, without cancellation.
    fn by_late_series(&self, t0: f64, t1: f64) -> Surface {
        let kernel = self.kernel;
        let zz = &kernel.late_series[0];
        let xx = &kernel.late_series[1];
        let time_ratio_squared = (t0 / t1).powi(2);
        let relative_distance_squared = (self.overlap.max_offset() / t0).powi(2);
        let first_term = self.moments[0] * (kernel.travel_per_step / t0).ln_1p();
        let mut sums = [zz[0] * first_term, xx[0] * first_term];
        // ∫ t^(−2k−1) dt = t₀^(−2k) (1 − r)(1 + r + … + r^(k−1))/(2k), r = (t₀/t₁)².
        let mut scale = relative_distance_squared * kernel.travel_per_step * (t0 + t1) / (t1 * t1);
        let mut series = 1.0;
        let mut power = time_ratio_squared;
        let negligible = NEGLIGIBLE_TERM_FRACTION * first_term;
        for k in 1..LATE_SERIES_TERMS {
            let term = scale * series / (2 * k) as f64;
            sums[0] += zz[k] * self.moments[k] * term;
            sums[1] += xx[k] * self.moments[k] * term;
            if (zz[k].abs() + xx[k].abs()) * self.moments[k] * term < negligible {
                break;
            }
            scale *= relative_distance_squared;
            series += power;
            power *= time_ratio_squared;
        }
        let factor = kernel.compliance_factor();
        Surface { zz: sums[0] * factor, xx: sums[1] * factor, zx: 0.0 }
    }

    /// Displacements from t₀ to t₁: 1/(π μ l) ∫ f(τ) A(τ) dτ, integrated between the τ at which the polynomial A changes.
    fn by_quadrature(&self, t0: f64, t1: f64) -> Surface {
        let branches = &self.kernel.branches;
        let overlap = &self.overlap;
        let min_offset = overlap.min_offset();
        let max_tau = if min_offset > 0.0 { t1 / min_offset } else { f64::INFINITY };
        let min_tau = (t0 / overlap.max_offset()).max(branches.pressure_arrival);
        if max_tau <= min_tau {
            return Surface::default();
        }
        let mut breaks = [f64::INFINITY; MAX_BREAK_COUNT];
        breaks[0] = min_tau;
        let mut break_count = 1;
        for &x in overlap.nodes.iter().filter(|&&x| x > 0.0) {
            for tau in [t0 / x, t1 / x] {
                if tau > min_tau && tau < max_tau {
                    breaks[break_count] = tau;
                    break_count += 1;
                }
            }
        }
        breaks[..break_count].sort_unstable_by(f64::total_cmp);
        breaks[break_count] = max_tau;
        let has_coupling = self.has_coupling(t0);
        let travel_per_step = self.kernel.travel_per_step;
        // zz and xx are even in x; zx is odd.
        let mut even_integrals = [0.0; 2];
        let mut odd_integrals = [0.0; 2];
        for piece in breaks[..=break_count].windows(2) {
            let start = piece[0];
            let stop = piece[1];
            if stop <= start {
                continue;
            }
            let speed = 0.5 / start + 0.5 / stop;
            let even_overlap = overlap.passed_overlap([t0, t1], travel_per_step, speed, false);
            for branch in [Branch::Pressure, Branch::Shear, Branch::Tail] {
                branches.add_integral(branch, start, stop, &even_overlap, &mut even_integrals);
            }
            if has_coupling && start <= branches.rayleigh_arrival {
                let odd_overlap = overlap.passed_overlap([t0, t1], travel_per_step, speed, true);
                for branch in [Branch::OddLow, Branch::OddHigh] {
                    branches.add_integral(branch, start, stop, &odd_overlap, &mut odd_integrals);
                }
                if stop > branches.rayleigh_arrival {
                    let pulse_overlap = odd_overlap.value(1.0 / branches.rayleigh_arrival);
                    odd_integrals[0] += branches.rayleigh_pulse * pulse_overlap;
                }
            }
        }
        let factor =
            1.0 / (std::f64::consts::PI * self.kernel.shear_modulus * overlap.receiver_length);
        Surface {
            zz: even_integrals[0] * factor,
            xx: even_integrals[1] * factor,
            zx: odd_integrals[0] * factor,
        }
    }
}

/// Converts a number of steps to a lag; too large a number becomes the largest integer.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn lag_from(step_count: f64) -> usize {
    // Float to integer casts saturate.
    step_count.max(1.0) as usize
}
