//! GOAL: the stability figures in the documentation of the full plane, one by one.
//! SCENE: flat surfaces and a trench over β = c₁Δt/l, ν and the length of the free surface.
//! REFERENCE: the tables of the documentation, and marches from a random perturbation.

use basemat::bem::Ground;
use basemat::bem::full_plane::{
    Boundary, BoundaryCondition, BoundaryKernel, BoundaryMarch, ConvolutionQuadrature, CqMethod,
    FullPlaneGround, Given, Segment, Stability, TimeKernel,
};
use basemat::{Result, Soil};

use super::{flat, soil};
use basemat_problems::boundary_passivity::boundary_passivity;
use basemat_problems::{close, random};

/// Which coefficients: by convolution quadrature, or else the time kernel.
type Method = Option<CqMethod>;

const TIME: Method = None;
const BDF1: Method = Some(CqMethod::Bdf1);
const BDF2: Method = Some(CqMethod::Bdf2);

fn kernel(
    method: Method,
    segments: &[Segment],
    soil: Soil,
    step: f64,
) -> Result<Box<dyn BoundaryKernel>> {
    Ok(match method {
        None => Box::new(TimeKernel::new(soil, segments, step)?),
        Some(method) => Box::new(ConvolutionQuadrature::new(soil, segments, step, method)?),
    })
}

/// Unit elements at β = c₁Δt/l.
#[derive(Debug, Clone, Copy)]
struct Case {
    method: Method,
    poisson: f64,
    elements: usize,
    /// Free ones on either side.
    free: usize,
    beta: f64,
}

impl Case {
    /// Twenty elements, no free surface beside them.
    fn table(method: Method, beta: f64) -> Self {
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
    /// all elements free of traction, or all held.
    fn march(self, held: bool, steps: usize) -> f64 {
        let count = self.elements + 2 * self.free;
        let kernel = kernel(self.method, &flat(count), soil(self.poisson), self.step()).unwrap();
        let given = if held { Given::Displacement } else { Given::Traction };
        let mut march = BoundaryMarch::new(kernel, &vec![given; 2 * count]).unwrap();
        march.prepare(steps).unwrap();
        let mut random = random::Random(11);
        let start: Vec<f64> = (0..2 * count).map(|_| random.within(-1.0, 1.0)).collect();
        march.step(&start).unwrap();
        let rest = vec![0.0; 2 * count];
        let mut size = |from: usize, to: usize| {
            let mut sum = 0.0;
            for _ in from..to {
                march.step(&rest).unwrap();
                let dofs = if held { march.traction() } else { march.displacement() };
                sum += dofs.iter().fold(0.0_f64, |m, x| m.max(x.abs())).ln();
            }
            sum / (to - from) as f64
        };
        // Means over eighths smooth the beat of modes that turn.
        let eighth = steps / 8;
        size(0, 3 * eighth);
        let middle = size(3 * eighth, 4 * eighth);
        size(4 * eighth, 7 * eighth);
        ((size(7 * eighth, 8 * eighth) - middle) / (4 * eighth) as f64).exp_m1()
    }
}

const BETAS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 5.0];

/// Growth, in percent of itself where several modes grow alike; `None` stands for bounded.
#[track_caller]
fn check_growth(name: &str, found: &Stability, wanted: Option<f64>) {
    println!("{name}: {found:?}");
    match wanted {
        None => assert!(found.is_bounded(), "{name}: {found:?}"),
        Some(growth) => close(name, found.growth_per_step, growth, 0.0, 0.015),
    }
}

/// Checks a row of the module's first table: growth free and bonded, and passivity.
fn check_row(
    method: Method,
    free: [Option<f64>; 6],
    bonded: [Option<f64>; 6],
    passivity: [f64; 6],
) {
    for (k, beta) in BETAS.into_iter().enumerate() {
        let case = Case::table(method, beta);
        let found = case.assess();
        check_growth(&format!("{method:?} free {beta}"), &found[0], free[k]);
        check_growth(&format!("{method:?} bonded {beta}"), &found[1], bonded[k]);
        let kernel = kernel(method, &flat(20), soil(1.0 / 3.0), case.step()).unwrap();
        let [figure, _] = boundary_passivity(kernel.as_ref());
        close(&format!("{method:?} passivity {beta}"), figure, passivity[k], 0.0, 0.03);
    }
}

/// GOAL: the module's first table, time kernel.
#[test]
fn time_kernel_grows_for_short_steps() {
    check_row(
        TIME,
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

/// GOAL: the module's first table, BDF1: bounded for every step of it, and slightly active.
#[test]
fn bdf1_is_bounded() {
    check_row(
        BDF1,
        [None; 6],
        [None; 6],
        [-1.95e-2, -2.26e-3, -2.45e-3, -2.43e-3, -2.18e-3, -1.80e-3],
    );
}

/// GOAL: the module's second table: which steps grow does not follow from β alone.
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
        let found = Case { method: TIME, poisson, elements: 10, free: 5, beta }.assess();
        check_growth(&format!("uplifted {beta} {poisson}"), &found[0], uplifted);
        check_growth(&format!("bonded {beta} {poisson}"), &found[1], bonded);
    }
}

/// GOAL: a longer free surface grows where a shorter one does not.
#[test]
fn long_surfaces_grow_where_short_ones_do_not() {
    let case = |method, beta, elements| Case { elements, ..Case::table(method, beta) };
    for (method, beta) in [(BDF2, 0.1), (TIME, 0.5)] {
        let [[short, _], [long, _]] = [6, 20].map(|count| case(method, beta, count).assess());
        assert!(short.is_bounded() && !long.is_bounded(), "{method:?}: {short:?}; {long:?}");
    }
    // Time kernel, ν = 1/4, β = 1, five and twenty free elements beside ten.
    let case = |free| Case { method: TIME, poisson: 0.25, elements: 10, free, beta: 1.0 };
    assert!(case(5).march(false, 800) < 1e-4);
    close("50 elements", case(20).march(false, 800), 0.02, 0.005, 0.0);
}

/// A trench with square corners, 1 wide and deep, in elements of a half.
fn trench() -> Vec<Segment> {
    let corners: [[f64; 2]; 6] =
        [[-2.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [3.0, 0.0]];
    let mut segments = Vec::new();
    for ends in corners.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |x: f64| [0, 1].map(|i| from[i] + 0.5 * x / length * (to[i] - from[i]));
        let mut x = 0.0;
        while x < 2.0 * length - 0.5 {
            segments.push(Segment { from: at(x), to: at(x + 1.0) });
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
        for method in [TIME, BDF2, BDF1] {
            let step = 0.5 * beta / soil(1.0 / 3.0).pressure_wave_speed();
            let kernel = kernel(method, &segments, soil(1.0 / 3.0), step).unwrap();
            let found = Stability::assess(kernel.as_ref(), &conditions, 1e-4).unwrap();
            assert_eq!(found.is_bounded(), method != TIME, "{method:?} {beta}: {found:?}");
            assert!(method != TIME || found.growth_per_step > 0.05, "{beta}: {found:?}");
        }
    }
}

/// GOAL: what is predicted is what a march does, growing or not.
#[test]
fn marches_grow_as_predicted() {
    for (method, beta, held, steps) in [
        (TIME, 0.5, false, 600),
        (TIME, 0.5, true, 1000),
        (BDF2, 0.1, true, 800),
        (TIME, 2.0, false, 1000),
        (BDF2, 0.5, false, 1000),
        (BDF2, 0.5, true, 1000),
    ] {
        let case = Case::table(method, beta);
        let found = case.assess();
        let predicted = &found[usize::from(held)];
        let marched = case.march(held, steps);
        println!("{case:?} held {held}: marched {marched:.4e}, {predicted:?}");
        if predicted.is_bounded() {
            assert!(marched < 1e-4);
        } else {
            close("growth", marched, predicted.growth_per_step, 0.0, 0.03);
        }
    }
}
