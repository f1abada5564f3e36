//! GOAL: growth and passivity of the full-plane boundary equations are computed correctly.
//! SCENE: twenty unit elements, both kernels, over β = c₁Δt/l; a kernel with known zeros.
//! REFERENCE: marches, a quadrature in space and time, and exact figures.

use basemat::bem::full_plane::{
    BoundaryCondition, BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment, Stability,
    TimeKernel,
};
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
use basemat::{Error, Result};

use super::{flat, mean, unit_soil};
use basemat_problems::boundary_passivity::boundary_passivity;
use basemat_problems::dense::{dot, inverse, largest};
use basemat_problems::{assert_close, random};

/// Points of the reference's Gauss–Legendre rule.
const GAUSS_POINTS: u32 = 24;

/// Coefficients of a flat surface of unit elements, by quadrature in space and time.
///
/// Pieces end at the fronts, where the substitution by a sine removes the root singularities; they are halved towards
/// the load.
struct QuadratureKernel {
    segments: Vec<Segment>,
    step: f64,
    plane: FullPlane,
    /// Nodes and weights on [−1, 1].
    rule: Vec<[f64; 2]>,
}

/// Node and weight of the Gauss–Legendre rule, by Newton's iteration.
fn gauss_node_and_weight(k: u32) -> [f64; 2] {
    let size = f64::from(GAUSS_POINTS);
    let mut x = (std::f64::consts::PI * (f64::from(k) + 0.75) / (size + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..8 {
        // Legendre's polynomials of two successive orders.
        let mut previous_polynomial = 1.0;
        let mut value = x;
        for n in 2..=GAUSS_POINTS {
            let n = f64::from(n);
            (previous_polynomial, value) =
                (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * previous_polynomial) / n);
        }
        slope = size * (x * value - previous_polynomial) / (x * x - 1.0);
        x -= value / slope;
    }
    [x, 2.0 / ((1.0 - x * x) * slope * slope)]
}

impl QuadratureKernel {
    fn new(count: usize, step: f64) -> Self {
        let rule = (0..GAUSS_POINTS).map(gauss_node_and_weight).collect();
        Self { segments: flat(count), step, plane: FullPlane::new(unit_soil()), rule }
    }

    /// Integrals over 0 ≤ low < high of u_xx, u_zz, t_xz, t_zx at `time` after a step load.
    fn integral(&self, low: f64, high: f64, time: f64) -> [f64; 4] {
        let mut sums = [0.0; 4];
        if time <= 0.0 {
            return sums;
        }
        let mut ends = vec![low, high];
        ends.extend([time, 2.0 * time].iter().filter(|front| **front > low && **front < high));
        if low == 0.0 {
            let first = ends[1..].iter().fold(high, |nearest, end| nearest.min(*end));
            ends.extend((1..36).map(|k| first * 0.5_f64.powi(k)));
        }
        ends.sort_by(f64::total_cmp);
        for piece in ends.windows(2) {
            let middle = 0.5 * (piece[0] + piece[1]);
            let half_width = 0.5 * (piece[1] - piece[0]);
            for [node, weight] in &self.rule {
                let angle = 0.5 * std::f64::consts::PI * node;
                let x = middle + half_width * angle.sin();
                let weight = weight * 0.5 * std::f64::consts::PI * angle.cos() * half_width;
                let u = self.plane.displacement([x, 0.0], time, LoadHistory::Step).unwrap();
                let t =
                    self.plane.traction([x, 0.0], [0.0, -1.0], time, LoadHistory::Step).unwrap();
                for (sum, value) in sums.iter_mut().zip([u[0][0], u[1][1], t[0][1], t[1][0]]) {
                    *sum += weight * value;
                }
            }
        }
        sums
    }
}

impl BoundaryKernel for QuadratureKernel {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        let count = self.segments.len();
        g.fill(0.0);
        h.fill(0.0);
        for offset in 0..count {
            let middle = offset as f64;
            let low = if offset == 0 { 0.0 } else { middle - 0.5 };
            let high = middle + 0.5;
            let before = self.integral(low, high, lag as f64 * self.step);
            let after = self.integral(low, high, (lag + 1) as f64 * self.step);
            let [xx, zz, xz, zx] = [0, 1, 2, 3].map(|k| after[k] - before[k]);
            for row in 0..count {
                // The element to the right of the point, and its mirror image to the left.
                for column in (0..count).filter(|column| column.abs_diff(row) == offset) {
                    let sign = if column < row { -1.0 } else { 1.0 };
                    // The integral covers half of the element around the point.
                    let halves = if offset == 0 { 2.0 } else { 1.0 };
                    g[row * 2 * count + column] = halves * xx;
                    g[(count + row) * 2 * count + count + column] = halves * zz;
                    if offset > 0 {
                        // h is the transpose of the traction at the element.
                        h[row * 2 * count + count + column] = sign * zx;
                        h[(count + row) * 2 * count + column] = sign * xz;
                    } else if lag == 0 {
                        h[row * 2 * count + column] = 0.5;
                        h[(count + row) * 2 * count + count + column] = 0.5;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Growth per step of a march from a random perturbation, with prescribed displacements or tractions.
///
/// Slope of ln of the largest unknown over the last third of `steps`.
fn marched_growth(kernel: &dyn BoundaryKernel, prescribed_displacement: bool, steps: usize) -> f64 {
    let order = 2 * kernel.segments().len();
    let size = order * order;
    let lags: Vec<_> = (0..steps)
        .map(|lag| {
            let mut g = vec![0.0; size];
            let mut h = vec![0.0; size];
            kernel.coefficients(lag, &mut g, &mut h).unwrap();
            if prescribed_displacement { g } else { h }
        })
        .collect();
    let inverse = inverse(&lags[0], order);
    let mut random = random::Random(7);
    let mut dofs: Vec<Vec<f64>> = vec![(0..order).map(|_| random.within(-1.0, 1.0)).collect()];
    let mut log_sizes = vec![];
    for step in 1..steps {
        let mut rhs = vec![0.0; order];
        for (lag, unknown) in (1..=step).zip(dofs.iter().rev()) {
            for (row, rhs) in rhs.iter_mut().enumerate() {
                *rhs -= dot(&lags[lag][row * order..][..order], unknown);
            }
        }
        let next_unknowns: Vec<f64> =
            (0..order).map(|row| dot(&inverse[row * order..][..order], &rhs)).collect();
        log_sizes.push(largest(&next_unknowns).ln());
        dofs.push(next_unknowns);
    }
    // Means over sixths average the beat of complex modes.
    let window = steps / 6;
    let end = log_sizes.len();
    let late_mean = mean(&log_sizes[end - window..]);
    let early_mean = mean(&log_sizes[end - 2 * window..end - window]);
    ((late_mean - early_mean) / window as f64).exp_m1()
}

fn bdf2_kernel(beta: f64) -> ConvolutionQuadrature {
    ConvolutionQuadrature::new(unit_soil(), &flat(20), beta / 2.0, CqMethod::Bdf2).unwrap()
}

fn time_kernel(beta: f64) -> TimeKernel {
    TimeKernel::new(unit_soil(), &flat(20), beta / 2.0).unwrap()
}

const FREE_SURFACE: [BoundaryCondition; 20] = [BoundaryCondition::TractionFree; 20];
const BONDED_SURFACE: [BoundaryCondition; 20] = [BoundaryCondition::PrescribedDisplacement; 20];

/// G, then H, of four elements at a lag.
fn entries_of_four(kernel: &dyn BoundaryKernel, lag: usize) -> Vec<f64> {
    let mut entries = vec![0.0; 2 * 64];
    let matrices = entries.split_at_mut(64);
    kernel.coefficients(lag, matrices.0, matrices.1).unwrap();
    entries
}

/// GOAL: the assessed kernel has the coefficients of the quadrature above.
#[test]
fn time_kernel_agrees_with_quadrature() {
    let kernel = TimeKernel::new(unit_soil(), &flat(4), 0.25).unwrap();
    let reference = QuadratureKernel::new(4, 0.25);
    for lag in [0, 1, 2, 5, 8, 13, 40, 300] {
        let computed = entries_of_four(&kernel, lag);
        let expected = entries_of_four(&reference, lag);
        for k in 0..2 * 64 {
            assert_close(&format!("lag {lag} entry {k}"), computed[k], expected[k], 1e-9, 0.0);
        }
    }
}

/// GOAL: the growth by the argument principle is that of a march (20 elements, ν = 1/3).
#[test]
fn growth_is_that_of_the_march() {
    for (beta, conditions, steps) in [(0.5, FREE_SURFACE, 400), (0.5, BONDED_SURFACE, 800)] {
        let kernel = time_kernel(beta);
        let assessed = Stability::assess(&kernel, &conditions, 1e-3).unwrap();
        let growth_of_the_march = marched_growth(&kernel, conditions == BONDED_SURFACE, steps);
        assert_close(
            &format!("growth at {beta}"),
            assessed.growth_per_step,
            growth_of_the_march,
            0.0,
            0.03,
        );
    }
    let kernel = bdf2_kernel(0.25);
    let assessed = Stability::assess(&kernel, &FREE_SURFACE, 1e-3).unwrap();
    let growth_of_the_march = marched_growth(&kernel, false, 1200);
    // Two pairs of modes have nearly the same growth: after 1200 steps the slower pair still contributes.
    assert_close("growth of BDF2 at 0.25", assessed.growth_per_step, growth_of_the_march, 0.0, 0.1);
    assert!(assessed.growth_per_step > 0.98 * growth_of_the_march);
    // A march with a kernel that is assessed as bounded is bounded.
    let kernel = bdf2_kernel(0.5);
    assert!(Stability::assess(&kernel, &FREE_SURFACE, 1e-3).unwrap().is_bounded());
    assert!(marched_growth(&kernel, false, 1200) < 1e-3);
}

/// GOAL: the smallest eigenvalue shows that BDF2 at β = ½ is slightly active, the time kernel strongly.
#[test]
fn active_operators_have_a_negative_passivity() {
    let eigenvalue = boundary_passivity(&bdf2_kernel(0.5))[0];
    assert!((-1e-2..-1e-5).contains(&eigenvalue), "{eigenvalue:e}");
    let eigenvalue = boundary_passivity(&time_kernel(0.5))[0];
    assert!(eigenvalue < -0.1, "{eigenvalue:e}");
}

/// One element with H = ½(1 − aζ) in x and ½(1 − bζ) in z, G = c: growth and passivity in closed form.
struct OneElementKernel {
    segments: Vec<Segment>,
    decay: [f64; 2],
    compliance: f64,
}

impl OneElementKernel {
    fn new(decay: [f64; 2], compliance: f64) -> Self {
        Self { segments: flat(1), decay, compliance }
    }
}

impl BoundaryKernel for OneElementKernel {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        g.fill(0.0);
        h.fill(0.0);
        [h[0], h[3]] = match lag {
            0 => [0.5, 0.5],
            1 => self.decay.map(|a| -0.5 * a),
            _ => return Ok(()),
        };
        if lag == 0 {
            [g[0], g[3]] = [self.compliance; 2];
        }
        Ok(())
    }
}

/// GOAL: exact figures: growth a − 1, number of modes, passivity of a spring (0) and of its negative.
#[test]
fn growth_and_passivity_of_a_kernel_with_known_zeros_are_exact() {
    let free = [BoundaryCondition::TractionFree];
    let fixed = [BoundaryCondition::PrescribedDisplacement];
    let kernel = OneElementKernel::new([1.1, 1.05], 1.0);
    let assessed = Stability::assess(&kernel, &free, 1e-3).unwrap();
    assert_close("growth", assessed.growth_per_step, 0.1, 1e-9, 0.0);
    assert_eq!(assessed.growing_modes, 2);
    let kernel = OneElementKernel::new([0.5, -1.002], 1.0);
    let assessed = Stability::assess(&kernel, &free, 1e-3).unwrap();
    assert_close("growth", assessed.growth_per_step, 0.002, 1e-9, 0.0);
    assert_eq!(assessed.growing_modes, 1);
    // Growth below the smallest growth of interest.
    let kernel = OneElementKernel::new([0.5, 1.0005], 1.0);
    assert!(Stability::assess(&kernel, &free, 1e-3).unwrap().is_bounded());
    assert!(!Stability::assess(&kernel, &free, 1e-4).unwrap().is_bounded());
    // u = 2t without memory: (1−ζ)·2 has the real part 2(1 − cos θ), from 0 to 4.
    let spring = OneElementKernel::new([0.0, 0.0], 1.0);
    assert!(Stability::assess(&spring, &fixed, 1e-3).unwrap().is_bounded());
    let eigenvalue = boundary_passivity(&spring)[0];
    assert!(eigenvalue.abs() < 1e-3, "{eigenvalue}");
    let [eigenvalue, angle] = boundary_passivity(&OneElementKernel::new([0.0, 0.0], -1.0));
    assert_close("passivity", eigenvalue, -1.0, 1e-3, 0.0);
    assert_close("angle", angle, std::f64::consts::PI, 1e-2, 0.0);
}

/// A kernel whose coefficients alternate in sign at all lags.
struct AlternatingKernel(Vec<Segment>);

impl BoundaryKernel for AlternatingKernel {
    fn segments(&self) -> &[Segment] {
        &self.0
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        let size = if lag == 0 { 0.5 } else { 0.1 / lag as f64 };
        let diagonal = if lag.is_multiple_of(2) { size } else { -size };
        for matrix in [g, h] {
            matrix.copy_from_slice(&[diagonal, 0.0, 0.0, diagonal]);
        }
        Ok(())
    }
}

/// GOAL: the assessment returns an error for coefficients that are not smooth.
#[test]
fn coefficients_that_are_not_smooth_are_an_error() {
    let free = [BoundaryCondition::TractionFree];
    let assessed = Stability::assess(&AlternatingKernel(flat(1)), &free, 1e-3);
    assert!(matches!(assessed, Err(Error::Part { .. })), "{assessed:?}");
}

/// GOAL: invalid input gives typed errors.
#[test]
fn invalid_input_is_an_error() {
    let kernel = OneElementKernel::new([0.0; 2], 1.0);
    let free = [BoundaryCondition::TractionFree];
    for growth in [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0, 1e-9] {
        let assessed = Stability::assess(&kernel, &free, growth);
        assert!(matches!(assessed, Err(Error::Input { .. })), "{growth}");
    }
    assert!(matches!(Stability::assess(&kernel, &[], 1e-3), Err(Error::Size { .. })));
    let kernel_without_elements =
        OneElementKernel { segments: vec![], decay: [0.0; 2], compliance: 1.0 };
    assert!(matches!(
        Stability::assess(&kernel_without_elements, &[], 1e-3),
        Err(Error::Size { .. })
    ));
    for compliance in [0.0, f64::NAN] {
        let kernel = OneElementKernel::new([0.0; 2], compliance);
        let fixed = [BoundaryCondition::PrescribedDisplacement];
        let assessed = Stability::assess(&kernel, &fixed, 1e-3);
        assert!(matches!(assessed, Err(Error::Singular { .. })), "{assessed:?}");
    }
}
