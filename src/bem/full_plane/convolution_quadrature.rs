//! Convolution quadrature of the boundary equation [Lubich 1988].
//!
//! With the generating function δ(ζ) of a backward-differentiation formula, the coefficients of a transformed
//! operator K(s) are the coefficients of the power series K(δ(ζ)/Δt) = Σ ωₙ ζⁿ. Early lags follow from
//! Cauchy's integral over |ζ| = λ by an FFT of L points,
//!
//! ```text
//! ωₙ = λ^{−n}/L Σ_l K(δ(λ e^{2πil/L})/Δt) e^{−2πiln/L} − Σ_{j≥1} λ^{jL} ω_{n+jL} ,
//! ```
//!
//! where the second sum is the alias of the trapezoidal rule. L is so large that the lags of the alias are late
//! lags, which have the closed form of [`super::late_weights`]. Therefore λ need not be small: λ^L is 1/100, and
//! rounding loses at most two digits. The number of frequencies, L/2 + 1 by symmetry, depends on the travel time of
//! waves across the boundary, and not on the number of steps.

use std::collections::HashMap;
use std::f64::consts::TAU;

use basemat_fourier::RealPlanner;

use crate::error::{Error, Result, positive, require, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::soil::Soil;

use super::bessel::Complex64;
use super::cq_method::CqMethod;
use super::laplace::LaplacePlane;
use super::laplace_element::{ElementView, ViewBlock, integrate};
use super::late_weights::{LOG_TERM_COUNT, LogTerms, first_lag, lag_weights, log_terms};
use super::{BoundaryKernel, Segment};

/// Coefficients of the full-plane boundary equation by convolution quadrature.
///
/// Coefficients multiply **point values**. Σ ω_{N−m} f(mΔt) approximates the convolution at NΔt at the
/// method's order, for smooth f that starts smoothly from rest; a time-domain kernel instead assumes values
/// constant over each step. For nΔt well above the waves' travel time, ωₙ is Δt times the impulse response at
/// nΔt up to the relative order n⁻² (BDF2) or n⁻¹ (BDF1).
///
/// Early coefficients have an error of about 1e-13 of the largest one; late coefficients have this relative
/// error at any lag.
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment};
///
/// let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0)?;
/// let flat: Vec<_> =
///     (0..4).map(|i| f64::from(i)).map(|x| Segment { from: [x, 0.0], to: [x + 1.0, 0.0] }).collect();
/// let step = 1.0 / soil.shear_wave_speed();
/// let kernel = ConvolutionQuadrature::new(soil, &flat, step, CqMethod::Bdf2)?;
///
/// let (mut g, mut h) = ([0.0; 64], [0.0; 64]);
/// kernel.coefficients(0, &mut g, &mut h)?;
/// assert!((h[0] - 0.5).abs() < 1e-12);
/// // Once the waves have passed, G decays like 1/n.
/// kernel.coefficients(10_000, &mut g, &mut h)?;
/// let before = g[0];
/// kernel.coefficients(20_000, &mut g, &mut h)?;
/// assert!((before / g[0] - 2.0).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct ConvolutionQuadrature {
    soil: Soil,
    segments: Vec<Segment>,
    time_step: f64,
    method: CqMethod,
    /// Distinct views of elements from midpoints.
    views: Vec<ElementView>,
    /// Index of the view of each pair (row, column).
    view_indices: Vec<usize>,
    /// Closed form of the late lags of each view, for distances up to ρ c₂ Δt.
    late_terms: Vec<LogTerms>,
    /// Number ρ of steps in which an S wave travels the largest distance.
    rho: f64,
    /// Early lags: blocks of all views, lag after lag.
    early_blocks: Vec<[f64; 8]>,
    /// Number of early lags, L.
    early_lag_count: usize,
}

impl ConvolutionQuadrature {
    /// Computes the coefficients of the equation on `segments` with steps of `time_step` seconds.
    ///
    /// The constructor evaluates the Laplace-domain matrices L/2 + 1 times. L is about three times the number of steps
    /// in which an S wave crosses the boundary. Pairs with the same view are evaluated once.
    ///
    /// # Errors
    /// [`Error::Input`] for a time step or an element's length that is not finite and above zero, for coordinates
    /// that are not finite, or if an S wave needs 1e5 steps or more across the boundary; [`Error::Size`] without
    /// elements.
    pub fn new(soil: Soil, segments: &[Segment], time_step: f64, method: CqMethod) -> Result<Self> {
        positive("time step", time_step)?;
        if segments.is_empty() {
            return Err(Error::Size { quantity: "segments", found: 0, needed: 1 });
        }
        for segment in segments {
            positive("length of a boundary element", segment.length())?;
        }
        let DistinctViews { views, view_indices } = distinct_views(segments);
        let max_distance = views.iter().map(ElementView::max_distance).fold(0.0, f64::max);
        let rho = positive("boundary over wave travel in a step", max_distance)?
            / (soil.shear_wave_speed() * time_step);
        let quantity = "steps that an S wave needs across the boundary";
        require(quantity, rho, rho < MAX_CROSSING_STEPS, "below 1e5")?;
        let mut kernel = Self {
            soil,
            segments: segments.to_vec(),
            time_step,
            method,
            late_terms: views.iter().map(|view| log_terms(soil, view, max_distance)).collect(),
            views,
            view_indices,
            rho,
            early_blocks: vec![],
            early_lag_count: first_lag(method, rho).next_power_of_two(),
        };
        kernel.early_blocks = kernel.compute_early_blocks();
        Ok(kernel)
    }

    /// The backward-differentiation formula.
    pub fn method(&self) -> CqMethod {
        self.method
    }

    /// Time step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Number of lags that are computed on Lubich's contour; later lags have a closed form.
    pub fn contour_lags(&self) -> usize {
        self.early_lag_count
    }

    /// Blocks of all views at δ(ζ)/Δt, with the free term.
    fn blocks(&self, zeta: Complex64) -> impl Iterator<Item = ViewBlock> {
        let plane = LaplacePlane::new(self.soil, self.method.symbol(zeta) / self.time_step);
        self.views.iter().map(move |view| {
            let mut block = integrate(&plane, view);
            if view.is_self {
                block[4] += 0.5;
                block[7] += 0.5;
            }
            block
        })
    }

    /// Early lags by Cauchy's integral, with the alias subtracted.
    fn compute_early_blocks(&self) -> Vec<[f64; 8]> {
        let lag_count = self.early_lag_count;
        let view_count = self.views.len();
        let point_count = lag_count as f64;
        let radius = CONTOUR_RADIUS_POWER.powf(1.0 / point_count);
        let frequency_count = lag_count / 2 + 1;
        let mut spectra = vec![Complex64::default(); 8 * view_count * frequency_count];
        for l in 0..frequency_count {
            let zeta = Complex64::from_polar(radius, TAU * l as f64 / point_count);
            for (view, block) in self.blocks(zeta).enumerate() {
                for (k, value) in block.iter().enumerate() {
                    // The inverse transform has the opposite sign in its exponent.
                    spectra[(8 * view + k) * frequency_count + l] = value.conj();
                }
            }
        }
        let inverse = RealPlanner::new().plan_fft_inverse(lag_count);
        let mut series = inverse.make_output_vec();
        let mut scratch = inverse.make_scratch_vec();
        let mut early_blocks = vec![[0.0; 8]; view_count * lag_count];
        for (index, spectrum) in spectra.chunks_exact_mut(frequency_count).enumerate() {
            if spectrum.iter().all(|value| *value == Complex64::default()) {
                continue;
            }
            spectrum[0].im = 0.0;
            spectrum[frequency_count - 1].im = 0.0;
            // All lengths come from the plan.
            if inverse.process_with_scratch(spectrum, &mut series, &mut scratch).is_err() {
                continue;
            }
            for (n, value) in series.iter().enumerate() {
                let block = &mut early_blocks[n * view_count + index / 8];
                block[index % 8] = value * radius.powf(-(n as f64)) / point_count;
            }
        }
        let mut alias_factor = CONTOUR_RADIUS_POWER;
        for j in 1..=ALIAS_TERM_COUNT {
            for n in 0..lag_count {
                let weights = lag_weights(self.method, n + j * lag_count, self.rho);
                let blocks = &mut early_blocks[n * view_count..][..view_count];
                for (view, block) in blocks.iter_mut().enumerate() {
                    let late_block = self.late_block(view, &weights);
                    for (entry, late_entry) in block.iter_mut().zip(late_block) {
                        *entry -= alias_factor * late_entry;
                    }
                }
            }
            alias_factor *= CONTOUR_RADIUS_POWER;
        }
        early_blocks
    }

    /// Late coefficients of a view, from the weights of their lag.
    fn late_block(&self, view: usize, weights: &[f64; LOG_TERM_COUNT]) -> [f64; 8] {
        let mut block = [0.0; 8];
        for (terms, weight) in self.late_terms[view].iter().zip(weights) {
            for (entry, term) in block.iter_mut().zip(terms) {
                *entry += weight * term;
            }
        }
        block
    }

    /// Error unless both slices have one number for each pair of components.
    fn check_lengths(&self, g: &[f64], h: &[f64]) -> Result<()> {
        let needed = 4 * self.segments.len() * self.segments.len();
        same_length("coefficients g", g.len(), needed)?;
        same_length("coefficients h", h.len(), needed)
    }
}

/// Power λ^L for the radius λ of the contour, with which rounding loses at most two digits.
const CONTOUR_RADIUS_POWER: f64 = 0.01;

/// Number of alias terms; further terms, λ^{jL}/(jL) in size, are below rounding.
const ALIAS_TERM_COUNT: usize = 7;

/// Largest number of steps in which an S wave crosses the boundary: more steps would need too much memory.
const MAX_CROSSING_STEPS: f64 = 1e5;

/// Difference of offsets that counts as rounding, relative to the extent of the boundary.
const OFFSET_TOLERANCE: f64 = 1e-12;

/// Distinct views among all pairs of elements.
struct DistinctViews {
    views: Vec<ElementView>,
    /// Index of the view of each pair (row, column).
    view_indices: Vec<usize>,
}

/// Distinct views among all pairs of elements, up to rounding.
fn distinct_views(segments: &[Segment]) -> DistinctViews {
    let extent = segments
        .iter()
        .flat_map(|segment| [segment.from, segment.to])
        .flat_map(|[x, z]| [x - segments[0].from[0], z - segments[0].from[1]])
        .fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let tolerance = OFFSET_TOLERANCE * extent;
    let mut indices = HashMap::new();
    let mut views = vec![];
    let mut view_indices = Vec::with_capacity(segments.len() * segments.len());
    for (row, receiver) in segments.iter().enumerate() {
        let center = receiver.center();
        for (column, source) in segments.iter().enumerate() {
            let view = ElementView {
                start: [source.from[0] - center[0], source.from[1] - center[1]],
                end: [source.to[0] - center[0], source.to[1] - center[1]],
                is_self: row == column,
            };
            #[allow(
                clippy::cast_possible_truncation,
                reason = "below 1e13 by choice of `tolerance`"
            )]
            let key = [view.start, view.end]
                .map(|point| point.map(|offset| (offset / tolerance).round() as i64));
            view_indices.push(*indices.entry((key, view.is_self)).or_insert_with(|| {
                views.push(view);
                views.len() - 1
            }));
        }
    }
    DistinctViews { views, view_indices }
}

/// Overwrites `g` and `h`, with `WIDTH` numbers per entry, by the blocks of all pairs.
fn scatter<const WIDTH: usize>(
    segment_count: usize,
    view_indices: &[usize],
    view_block: impl Fn(usize) -> [[f64; WIDTH]; 8],
    g: &mut [f64],
    h: &mut [f64],
) {
    let layout = ContactLayout::new(COMPONENTS_IN_PLANE, segment_count);
    for row in 0..segment_count {
        for column in 0..segment_count {
            let block = view_block(view_indices[row * segment_count + column]);
            for i in 0..2 {
                for j in 0..2 {
                    let entry = layout.index_of(i, row) * layout.len() + layout.index_of(j, column);
                    let numbers = WIDTH * entry..WIDTH * entry + WIDTH;
                    g[numbers.clone()].copy_from_slice(&block[2 * i + j]);
                    h[numbers].copy_from_slice(&block[4 + 2 * i + j]);
                }
            }
        }
    }
}

impl BoundaryKernel for ConvolutionQuadrature {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        self.check_lengths(g, h)?;
        let segment_count = self.segments.len();
        let view_count = self.views.len();
        if lag < self.early_lag_count {
            let blocks = &self.early_blocks[lag * view_count..][..view_count];
            let view_block = |view: usize| blocks[view].map(|x| [x]);
            scatter(segment_count, &self.view_indices, view_block, g, h);
        } else {
            let weights = lag_weights(self.method, lag, self.rho);
            let blocks: Vec<_> =
                (0..view_count).map(|view| self.late_block(view, &weights)).collect();
            let view_block = |view: usize| blocks[view].map(|x| [x]);
            scatter(segment_count, &self.view_indices, view_block, g, h);
        }
        Ok(())
    }

    fn symbol(&self, zeta: [f64; 2], g: &mut [f64], h: &mut [f64]) -> Result<Option<[f64; 2]>> {
        let segment_count = self.segments.len();
        let number_count = 8 * segment_count * segment_count;
        same_length("symbol of g", g.len(), number_count)?;
        same_length("symbol of h", h.len(), number_count)?;
        let zeta = Complex64::new(zeta[0], zeta[1]);
        let s = self.method.symbol(zeta) / self.time_step;
        let blocks: Vec<_> = self.blocks(zeta).collect();
        let view_block = |view: usize| blocks[view].map(|x| [x.re, x.im]);
        scatter(segment_count, &self.view_indices, view_block, g, h);
        Ok(Some([s.re, s.im]))
    }
}
