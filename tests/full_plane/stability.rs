//! GOAL: growth and passivity of the full-plane boundary equations are found as they are.
//! SCENE: twenty unit elements, both kernels, over β = c₁Δt/l; a kernel with known zeros.
//! REFERENCE: marches, a quadrature in space and time, and exact figures.

use basemat::bem::full_plane::{
    BoundaryCondition, BoundaryKernel, ConvolutionQuadrature, CqMethod, Segment, Stability,
    TimeKernel,
};
use basemat::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
use basemat::{Error, Result};

use super::{flat, unit_soil};
use basemat_problems::boundary_passivity::boundary_passivity;
use basemat_problems::dense::inverse;
use basemat_problems::{close, random};

/// Space–time integrals of the full-plane solution on a flat surface of unit elements, by a Gauss
/// rule of its own: pieces end at the fronts, where sin² takes the root singularities away, and
/// are halved towards the load.
struct Quadrature {
    segments: Vec<Segment>,
    step: f64,
    plane: FullPlane,
    rule: Vec<[f64; 2]>,
}

impl Quadrature {
    fn new(count: usize, step: f64) -> Self {
        // Gauss–Legendre rule of 24 points by Newton's iteration.
        let size = 24_u32;
        let rule = (0..size)
            .map(|k| {
                let mut x =
                    (std::f64::consts::PI * (f64::from(k) + 0.75) / (f64::from(size) + 0.5)).cos();
                let mut slope = 1.0;
                for _ in 0..8 {
                    let (mut before, mut value) = (1.0, x);
                    for n in 2..=size {
                        let n = f64::from(n);
                        (before, value) =
                            (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n);
                    }
                    slope = f64::from(size) * (x * value - before) / (x * x - 1.0);
                    x -= value / slope;
                }
                [x, 2.0 / ((1.0 - x * x) * slope * slope)]
            })
            .collect();
        Self { segments: flat(count), step, plane: FullPlane::new(unit_soil()), rule }
    }

    /// Integrals over [low, high] > 0 of u_xx, u_zz, t_xz, t_zx at `time` after a step load.
    fn integral(&self, low: f64, high: f64, time: f64) -> [f64; 4] {
        let mut sums = [0.0; 4];
        if time <= 0.0 {
            return sums;
        }
        let mut cuts = vec![low, high];
        cuts.extend([time, 2.0 * time].iter().filter(|cut| **cut > low && **cut < high));
        if low == 0.0 {
            let first = cuts[1..].iter().fold(high, |least, cut| least.min(*cut));
            cuts.extend((1..36).map(|k| first * 0.5_f64.powi(k)));
        }
        cuts.sort_by(f64::total_cmp);
        for ends in cuts.windows(2) {
            let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
            for [node, weight] in &self.rule {
                let angle = 0.5 * std::f64::consts::PI * node;
                let x = middle + half * angle.sin();
                let weight = weight * 0.5 * std::f64::consts::PI * angle.cos() * half;
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

impl BoundaryKernel for Quadrature {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        let count = self.segments.len();
        g.fill(0.0);
        h.fill(0.0);
        let (old, new) = (lag as f64 * self.step, (lag + 1) as f64 * self.step);
        for offset in 0..count {
            let middle = offset as f64;
            let (low, high) = if offset == 0 { (0.0, 0.5) } else { (middle - 0.5, middle + 0.5) };
            let before = self.integral(low, high, old);
            let after = self.integral(low, high, new);
            let [xx, zz, xz, zx] = [0, 1, 2, 3].map(|k| after[k] - before[k]);
            for row in 0..count {
                // The element to the right of the point, and its mirror image.
                let mut put = |column: usize, sign: f64, twice: f64| {
                    g[row * 2 * count + column] = twice * xx;
                    g[(count + row) * 2 * count + count + column] = twice * zz;
                    if offset > 0 {
                        // h is the transpose of the traction at the element.
                        h[row * 2 * count + count + column] = sign * zx;
                        h[(count + row) * 2 * count + column] = sign * xz;
                    } else if lag == 0 {
                        h[row * 2 * count + column] = 0.5;
                        h[(count + row) * 2 * count + count + column] = 0.5;
                    }
                };
                if offset == 0 {
                    put(row, 1.0, 2.0);
                } else {
                    if row + offset < count {
                        put(row + offset, 1.0, 1.0);
                    }
                    if row >= offset {
                        put(row - offset, -1.0, 1.0);
                    }
                }
            }
        }
        Ok(())
    }
}

/// Growth per step of a march of F from a random perturbation: slope of ln of the largest
/// unknown over the last third of `steps`.
fn marched_growth(kernel: &dyn BoundaryKernel, prescribed: bool, steps: usize) -> f64 {
    let order = 2 * kernel.segments().len();
    let size = order * order;
    let lags: Vec<_> = (0..steps)
        .map(|lag| {
            let (mut g, mut h) = (vec![0.0; size], vec![0.0; size]);
            kernel.coefficients(lag, &mut g, &mut h).unwrap();
            if prescribed { g } else { h }
        })
        .collect();
    let inverse = inverse(&lags[0], order);
    let mut random = random::Random(7);
    let mut dofs: Vec<Vec<f64>> = vec![(0..order).map(|_| random.within(-1.0, 1.0)).collect()];
    let mut sizes = vec![];
    for step in 1..steps {
        let mut rhs = vec![0.0; order];
        for (lag, unknown) in (1..=step).zip(dofs.iter().rev()) {
            for (row, rhs) in rhs.iter_mut().enumerate() {
                let line = &lags[lag][row * order..][..order];
                *rhs -= line.iter().zip(unknown).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        let next: Vec<f64> = (0..order)
            .map(|row| inverse[row * order..][..order].iter().zip(&rhs).map(|(a, b)| a * b).sum())
            .collect();
        sizes.push(next.iter().fold(0.0_f64, |m, x| m.max(x.abs())).ln());
        dofs.push(next);
    }
    // Means over sixths smooth the beat of modes that turn.
    let window = steps / 6;
    let mean = |end: usize| sizes[end - window..end].iter().sum::<f64>() / window as f64;
    ((mean(sizes.len()) - mean(sizes.len() - window)) / window as f64).exp_m1()
}

fn cq(beta: f64, method: CqMethod) -> ConvolutionQuadrature {
    ConvolutionQuadrature::new(unit_soil(), &flat(20), beta / 2.0, method).unwrap()
}

fn time_kernel(beta: f64) -> TimeKernel {
    TimeKernel::new(unit_soil(), &flat(20), beta / 2.0).unwrap()
}

const FREE: [BoundaryCondition; 20] = [BoundaryCondition::TractionFree; 20];
const BONDED: [BoundaryCondition; 20] = [BoundaryCondition::PrescribedDisplacement; 20];

/// GOAL: the kernel that is assessed is the right one: against the quadrature above.
#[test]
fn time_kernel_agrees_with_quadrature() {
    let kernel = TimeKernel::new(unit_soil(), &flat(4), 0.25).unwrap();
    let other = Quadrature::new(4, 0.25);
    for lag in [0, 1, 2, 5, 8, 13, 40, 300] {
        let (mut g, mut h) = ([0.0; 64], [0.0; 64]);
        let (mut g_other, mut h_other) = ([0.0; 64], [0.0; 64]);
        kernel.coefficients(lag, &mut g, &mut h).unwrap();
        other.coefficients(lag, &mut g_other, &mut h_other).unwrap();
        for k in 0..64 {
            close(&format!("g lag {lag} entry {k}"), g[k], g_other[k], 1e-9, 0.0);
            close(&format!("h lag {lag} entry {k}"), h[k], h_other[k], 1e-9, 0.0);
        }
    }
}

/// GOAL: what the argument principle finds is what a march does (20 elements, ν = 1/3).
#[test]
fn growth_is_that_of_the_march() {
    for (beta, conditions, steps) in [(0.5, FREE, 400), (0.5, BONDED, 800)] {
        let kernel = time_kernel(beta);
        let found = Stability::assess(&kernel, &conditions, 1e-3).unwrap();
        let marched = marched_growth(&kernel, conditions == BONDED, steps);
        close(&format!("growth at {beta}"), found.growth_per_step, marched, 0.0, 0.03);
    }
    let kernel = cq(0.25, CqMethod::Bdf2);
    let found = Stability::assess(&kernel, &FREE, 1e-3).unwrap();
    let marched = marched_growth(&kernel, false, 1200);
    // Two pairs of modes of nearly equal growth: after 1200 steps the slower still counts.
    close("growth of BDF2 at 0.25", found.growth_per_step, marched, 0.0, 0.1);
    assert!(found.growth_per_step > 0.98 * marched);
    // And what is called bounded is.
    let kernel = cq(0.5, CqMethod::Bdf2);
    assert!(Stability::assess(&kernel, &FREE, 1e-3).unwrap().is_bounded());
    assert!(marched_growth(&kernel, false, 1200) < 1e-3);
}

/// GOAL: the passivity figure: BDF2 at β = ½ is slightly active, the time kernel badly so.
#[test]
fn passivity_tells_active_operators() {
    let [figure, _] = boundary_passivity(&cq(0.5, CqMethod::Bdf2));
    assert!((-1e-2..-1e-5).contains(&figure), "{figure:e}");
    let [figure, _] = boundary_passivity(&time_kernel(0.5));
    assert!(figure < -0.1, "{figure:e}");
}

/// One element with H = ½(1 − aζ) in x and ½(1 − bζ) in z, G = c: every figure is known.
struct Known {
    segments: Vec<Segment>,
    decay: [f64; 2],
    compliance: f64,
}

impl BoundaryKernel for Known {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        g.fill(0.0);
        h.fill(0.0);
        let size = match lag {
            0 => [0.5, 0.5],
            1 => self.decay.map(|a| -0.5 * a),
            _ => return Ok(()),
        };
        (h[0], h[3]) = (size[0], size[1]);
        if lag == 0 {
            (g[0], g[3]) = (self.compliance, self.compliance);
        }
        Ok(())
    }
}

/// GOAL: exact figures: growth a − 1, modes; passivity of a spring (0) and of its negative.
#[test]
fn figures_of_a_kernel_with_known_zeros() {
    let known = |decay, compliance| Known { segments: flat(1), decay, compliance };
    let free = [BoundaryCondition::TractionFree];
    let fixed = [BoundaryCondition::PrescribedDisplacement];
    let found = Stability::assess(&known([1.1, 1.05], 1.0), &free, 1e-3).unwrap();
    close("growth", found.growth_per_step, 0.1, 1e-9, 0.0);
    assert_eq!(found.growing_modes, 2);
    let found = Stability::assess(&known([0.5, -1.002], 1.0), &free, 1e-3).unwrap();
    close("growth", found.growth_per_step, 0.002, 1e-9, 0.0);
    assert_eq!(found.growing_modes, 1);
    // Growth below what is looked for.
    assert!(Stability::assess(&known([0.5, 1.0005], 1.0), &free, 1e-3).unwrap().is_bounded());
    assert!(!Stability::assess(&known([0.5, 1.0005], 1.0), &free, 1e-4).unwrap().is_bounded());
    // u = 2t at once: (1−ζ)·2 has the real part 2(1 − cos θ), from 0 to 4.
    assert!(Stability::assess(&known([0.0, 0.0], 1.0), &fixed, 1e-3).unwrap().is_bounded());
    let [figure, _] = boundary_passivity(&known([0.0, 0.0], 1.0));
    assert!(figure.abs() < 1e-3, "{figure}");
    let [figure, angle] = boundary_passivity(&known([0.0, 0.0], -1.0));
    close("passivity", figure, -1.0, 1e-3, 0.0);
    close("angle", angle, std::f64::consts::PI, 1e-2, 0.0);
}

/// A kernel whose coefficients alternate for ever.
struct Rough(Vec<Segment>);

impl BoundaryKernel for Rough {
    fn segments(&self) -> &[Segment] {
        &self.0
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        let size = if lag == 0 { 0.5 } else { 0.1 / lag as f64 };
        let own = if lag.is_multiple_of(2) { size } else { -size };
        g.fill(0.0);
        h.fill(0.0);
        (g[0], g[3], h[0], h[3]) = (own, own, own, own);
        Ok(())
    }
}

/// GOAL: growth of coefficients that are not smooth is not judged.
#[test]
fn rough_coefficients_are_an_error() {
    let free = [BoundaryCondition::TractionFree];
    let found = Stability::assess(&Rough(flat(1)), &free, 1e-3);
    assert!(matches!(found, Err(Error::Part { .. })), "{found:?}");
}

/// GOAL: bad input gives typed errors.
#[test]
fn bad_input_is_an_error() {
    let kernel = Known { segments: flat(1), decay: [0.0; 2], compliance: 1.0 };
    let free = [BoundaryCondition::TractionFree];
    for growth in [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0, 1e-9] {
        let found = Stability::assess(&kernel, &free, growth);
        assert!(matches!(found, Err(Error::Input { .. })), "{growth}");
    }
    assert!(matches!(Stability::assess(&kernel, &[], 1e-3), Err(Error::Size { .. })));
    let none = Known { segments: vec![], decay: [0.0; 2], compliance: 1.0 };
    assert!(matches!(Stability::assess(&none, &[], 1e-3), Err(Error::Size { .. })));
    for compliance in [0.0, f64::NAN] {
        let kernel = Known { segments: flat(1), decay: [0.0; 2], compliance };
        let fixed = [BoundaryCondition::PrescribedDisplacement];
        let found = Stability::assess(&kernel, &fixed, 1e-3);
        assert!(matches!(found, Err(Error::Singular { .. })), "{found:?}");
    }
}
