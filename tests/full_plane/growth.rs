//! GOAL: the stability figures in the documentation of the full plane, one by one.
//! SCENE: flat surfaces and a trench over β = c₁Δt/l, ν and the length of the free surface.
//! REFERENCE: the tables of the documentation, and marches from a random perturbation.

use basemat::bem::Ground;
use basemat::bem::full_plane::{
    Boundary, BoundaryCondition, BoundaryKernel, BoundaryMarch, ConvolutionQuadrature, CqMethod,
    FullPlaneGround, Given, Segment, Stability, TimeKernel,
};
use basemat::{Result, Soil};

use super::{flat, point_between, soil};
use basemat_problems::boundary_passivity::boundary_passivity;
use basemat_problems::{assert_close, dense::largest, random};

/// Convolution quadrature of this method, or the time kernel.
type KernelMethod = Option<CqMethod>;

const TIME_KERNEL: KernelMethod = None;
const BDF1: KernelMethod = Some(CqMethod::Bdf1);
const BDF2: KernelMethod = Some(CqMethod::Bdf2);

fn kernel(
    method: KernelMethod,
    segments: &[Segment],
    soil: Soil,
    step: f64,
) -> Result<Box<dyn BoundaryKernel>> {
    Ok(match method {
        None => Box::new(TimeKernel::new(soil, segments, step)?),
        Some(method) => Box::new(ConvolutionQuadrature::new(soil, segments, step, method)?),
    })
}

/// Unit elements of a flat surface, marched at β = c₁Δt/l.
#[derive(Debug, Clone, Copy)]
struct GrowthCase {
    method: KernelMethod,
    poisson: f64,
    elements: usize,
    /// Free elements on either side.
    free: usize,
    beta: f64,
}

impl GrowthCase {
    /// Case of the first table: twenty elements, no free surface beside them.
    fn table(method: KernelMethod, beta: f64) -> Self {
        Self { method, poisson: 1.0 / 3.0, elements: 20, free: 0, beta }
    }

    fn step(self) -> f64 {
        self.beta / soil(self.poisson).pressure_wave_speed()
    }

    /// Growth with the base uplifted and bonded.
    fn assess(self) -> [Stability; 2] {
        let range = 0.0..f64::from(u32::try_from(self.elements).unwrap());
        let ground = FullPlaneGround::strip(soil(self.poisson), range, self.elements, self.free)
            .unwrap()
            .with_kernel(move |segments, soil, step| kernel(self.method, segments, soil, step));
        assert!(ground.elements().len() == self.elements);
        ground.assess(self.step(), 1e-4).unwrap()
    }

    /// Growth per step of a march from a random perturbation, over the second half of `steps`;
    /// all elements free of traction, or all bonded.
    fn march(self, is_bonded: bool, steps: usize) -> f64 {
        let count = self.elements + 2 * self.free;
        let kernel = kernel(self.method, &flat(count), soil(self.poisson), self.step()).unwrap();
        let prescribed = if is_bonded { Given::Displacement } else { Given::Traction };
        let mut march = BoundaryMarch::new(kernel, &vec![prescribed; 2 * count]).unwrap();
        march.prepare(steps).unwrap();
        let mut random = random::Random(11);
        let start: Vec<f64> = (0..2 * count).map(|_| random.within(-1.0, 1.0)).collect();
        march.step(&start).unwrap();
        // Means over eighths average the beat of complex modes.
        let window = steps / 8;
        mean_log_size(&mut march, is_bonded, 3 * window);
        let middle = mean_log_size(&mut march, is_bonded, window);
        mean_log_size(&mut march, is_bonded, 3 * window);
        let end = mean_log_size(&mut march, is_bonded, window);
        ((end - middle) / (4 * window) as f64).exp_m1()
    }
}

/// Mean of ln of the largest unknown over further steps without load.
fn mean_log_size(march: &mut BoundaryMarch, is_bonded: bool, steps: usize) -> f64 {
    let no_load = vec![0.0; march.displacement().len()];
    let mut sum = 0.0;
    for _ in 0..steps {
        march.step(&no_load).unwrap();
        let dofs = if is_bonded { march.traction() } else { march.displacement() };
        sum += largest(dofs).ln();
    }
    sum / steps as f64
}

/// Columns β of the module's first table.
const TABLE_BETAS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 5.0];

/// Checks a growth to 1.5 %, as several modes have nearly the same growth; `None` means bounded.
#[track_caller]
fn check_growth(name: &str, computed: &Stability, expected: Option<f64>) {
    println!("{name}: {computed:?}");
    match expected {
        None => assert!(computed.is_bounded(), "{name}: {computed:?}"),
        Some(growth) => assert_close(name, computed.growth_per_step, growth, 0.0, 0.015),
    }
}

/// Checks a row of the module's first table: growth free and bonded, and passivity.
fn check_row(
    method: KernelMethod,
    free: [Option<f64>; 6],
    bonded: [Option<f64>; 6],
    passivity: [f64; 6],
) {
    for (k, beta) in TABLE_BETAS.into_iter().enumerate() {
        let case = GrowthCase::table(method, beta);
        let assessed = case.assess();
        check_growth(&format!("{method:?} free {beta}"), &assessed[0], free[k]);
        check_growth(&format!("{method:?} bonded {beta}"), &assessed[1], bonded[k]);
        let kernel = kernel(method, &flat(20), soil(1.0 / 3.0), case.step()).unwrap();
        let smallest_eigenvalue = boundary_passivity(kernel.as_ref())[0];
        let name = format!("{method:?} passivity {beta}");
        assert_close(&name, smallest_eigenvalue, passivity[k], 0.0, 0.03);
    }
}

/// GOAL: the module's first table, time kernel.
#[test]
fn the_time_kernel_grows_with_short_steps() {
    check_row(
        TIME_KERNEL,
        [Some(1.02e-2), Some(2.86e-2), Some(6.78e-2), Some(9.95e-2), None, None],
        [Some(5.16e-2), Some(1.107e-1), Some(2.27e-2), None, None, None],
        [-0.420, -0.380, -0.384, -1.0, -0.403, -0.0319],
    );
}

/// GOAL: the module's first table, BDF2: bounded from β = 1/2.
#[test]
fn bdf2_is_bounded_from_one_half() {
    check_row(
        BDF2,
        [Some(7.18e-3), Some(8.27e-3), None, None, None, None],
        [Some(3.36e-2), None, None, None, None, None],
        [-0.448, -1.0, -1.06e-3, -1.61e-3, -1.76e-3, -1.81e-3],
    );
}

/// GOAL: the module's first table, BDF1: bounded at all its steps, and slightly active.
#[test]
fn bdf1_is_bounded_at_all_steps() {
    check_row(
        BDF1,
        [None; 6],
        [None; 6],
        [-1.95e-2, -2.26e-3, -2.45e-3, -2.43e-3, -2.18e-3, -1.80e-3],
    );
}

/// GOAL: the module's second table: whether a step leads to growth depends on β and ν.
/// SCENE: ten elements and five free ones on either side, time kernel.
#[test]
fn growth_depends_on_poissons_ratio() {
    let third = 1.0 / 3.0;
    for (beta, poisson, uplifted, bonded) in [
        (0.5, 0.0, None, None),
        (0.5, 0.25, Some(4.02e-2), Some(1.40e-2)),
        (0.5, third, Some(6.78e-2), Some(1.35e-2)),
        (1.0, 0.0, None, None),
        (1.0, 0.25, None, None),
        (1.0, third, Some(9.95e-2), None),
        (2.0, 0.0, Some(1.01e-1), None),
        (2.0, 0.25, Some(4.57e-2), None),
        (2.0, third, None, None),
        (5.0, 0.0, Some(1.68e-2), None),
        (5.0, 0.25, None, None),
        (5.0, third, None, None),
    ] {
        let case = GrowthCase { method: TIME_KERNEL, poisson, elements: 10, free: 5, beta };
        let assessed = case.assess();
        check_growth(&format!("uplifted {beta} {poisson}"), &assessed[0], uplifted);
        check_growth(&format!("bonded {beta} {poisson}"), &assessed[1], bonded);
    }
}

/// GOAL: marches on a longer free surface grow where those on a shorter one do not.
#[test]
fn long_surfaces_grow_where_short_ones_do_not() {
    for (method, beta) in [(BDF2, 0.1), (TIME_KERNEL, 0.5)] {
        let longer_surface = GrowthCase::table(method, beta);
        let shorter_surface = GrowthCase { elements: 6, ..longer_surface };
        assert!(shorter_surface.assess()[0].is_bounded(), "{shorter_surface:?}");
        assert!(!longer_surface.assess()[0].is_bounded(), "{longer_surface:?}");
    }
    // Five and twenty free elements on either side of ten.
    let shorter_surface =
        GrowthCase { method: TIME_KERNEL, poisson: 0.25, elements: 10, free: 5, beta: 1.0 };
    let longer_surface = GrowthCase { free: 20, ..shorter_surface };
    assert!(shorter_surface.march(false, 800) < 1e-4);
    assert_close("50 elements", longer_surface.march(false, 800), 0.02, 0.005, 0.0);
}

/// A trench with square corners, 1 wide and deep, in elements of a half.
fn trench() -> Vec<Segment> {
    let corners: [[f64; 2]; 6] =
        [[-2.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [3.0, 0.0]];
    let mut segments = Vec::new();
    for ends in corners.windows(2) {
        let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
        // Distance in elements from the corner.
        let mut x = 0.0;
        while x < 2.0 * length - 0.5 {
            segments.push(Segment {
                from: point_between(ends[0], ends[1], 0.5 * x / length),
                to: point_between(ends[0], ends[1], 0.5 * (x + 1.0) / length),
            });
            x += 1.0;
        }
    }
    segments
}

/// GOAL: in a narrow trench the time kernel grows for every step, convolution quadrature for none.
#[test]
fn trenches_need_convolution_quadrature() {
    let segments = trench();
    assert!(segments.len() == 14 && !Boundary::new(segments.clone(), &[0]).unwrap().is_flat());
    let conditions = [BoundaryCondition::TractionFree; 14];
    for beta in [0.25, 0.5, 1.0, 2.0, 5.0] {
        for method in [TIME_KERNEL, BDF2, BDF1] {
            let step = 0.5 * beta / soil(1.0 / 3.0).pressure_wave_speed();
            let kernel = kernel(method, &segments, soil(1.0 / 3.0), step).unwrap();
            let assessed = Stability::assess(kernel.as_ref(), &conditions, 1e-4).unwrap();
            let expected_bounded = method != TIME_KERNEL;
            assert_eq!(assessed.is_bounded(), expected_bounded, "{method:?} {beta}: {assessed:?}");
            assert!(expected_bounded || assessed.growth_per_step > 0.05, "{beta}: {assessed:?}");
        }
    }
}

/// GOAL: the predicted growth is the growth of a march, or both are bounded.
#[test]
fn marches_grow_as_predicted() {
    for (method, beta, is_bonded, steps) in [
        (TIME_KERNEL, 0.5, false, 600),
        (TIME_KERNEL, 0.5, true, 1000),
        (BDF2, 0.1, true, 800),
        (TIME_KERNEL, 2.0, false, 1000),
        (BDF2, 0.5, false, 1000),
        (BDF2, 0.5, true, 1000),
    ] {
        let case = GrowthCase::table(method, beta);
        let assessed = case.assess();
        let predicted_stability = &assessed[usize::from(is_bonded)];
        let marched_growth = case.march(is_bonded, steps);
        println!(
            "{case:?} bonded {is_bonded}: marched {marched_growth:.4e}, {predicted_stability:?}"
        );
        if predicted_stability.is_bounded() {
            assert!(marched_growth < 1e-4);
        } else {
            assert_close("growth", marched_growth, predicted_stability.growth_per_step, 0.0, 0.03);
        }
    }
}
