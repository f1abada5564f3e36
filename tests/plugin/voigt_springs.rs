//! GOAL: convolution weights of a user support a structure, with every history and in shared stores.
//! SCENE: springs with dashpots as convolution weights, with exponentials for late lags; the half-plane by public types.
//! REFERENCE: the closed form of creep; the crate's spring ground and half-plane; typed errors.

use std::sync::Arc;

use basemat::bem::{
    ContactElement, ElasticGround, Grading, Ground, PatchKernel, SharedKernels, SpringGround,
    Strip, WeightsGround, WeightsSource,
};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, ExponentialSum,
    HistoryMethod, HistoryOptions, LateWeights, PairClasses, RelaxedFftHistory, TailProduct,
    by_kind,
};
use basemat::interface::Coulomb;
use basemat::{Error, Result, Simulation, unobserved};

use super::kernel::ten_elements;
use super::scene::{CompletedRun, assert_same_motion, push, soil};
use basemat_problems::block_on_springs::block;

/// Independent springs with dashpots (Kelvin–Voigt), integrated exactly.
#[derive(Clone, Copy)]
struct VoigtSprings {
    stiffness: f64,
    dashpots: f64,
    /// Whether exponentials for late lags are offered.
    has_late_weights: bool,
    has_identity: bool,
}

const VOIGT_SPRINGS: VoigtSprings =
    VoigtSprings { stiffness: 5e7, dashpots: 5e5, has_late_weights: true, has_identity: true };

/// Convolution weights of the springs.
struct VoigtWeights {
    springs: VoigtSprings,
    classes: PairClasses,
    /// Time step over relaxation time.
    rate: f64,
}

impl VoigtWeights {
    fn new(springs: VoigtSprings, elements: &[ContactElement], time_step: f64) -> Self {
        let classes = PairClasses::new(elements.to_vec()).unwrap();
        Self { springs, classes, rate: springs.stiffness * time_step / springs.dashpots }
    }

    /// Displacement under a unit traction at a lag.
    fn weight_at(&self, lag: usize) -> f64 {
        -(-self.rate).exp_m1() / self.springs.stiffness * (-self.rate * (lag - 1) as f64).exp()
    }
}

impl ConvolutionWeights for VoigtWeights {
    fn classes(&self) -> &PairClasses {
        &self.classes
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let [normal, tangential, coupling] = by_kind(values)?;
        let [source, receiver] = self.classes.representative(class)?;
        let length = if source == receiver { receiver.length() } else { 0.0 };
        for (i, value) in normal.iter_mut().enumerate() {
            *value = length * self.weight_at(first_lag + i);
        }
        tangential.copy_from_slice(normal);
        coupling.fill(0.0);
        Ok(())
    }

    fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
        Ok(Some(0))
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        self.springs.has_late_weights.then_some(self)
    }
}

impl LateWeights for VoigtWeights {
    fn window(&self) -> usize {
        1
    }

    /// One rate, and for each element one function, which is 1 there and 0 elsewhere.
    fn exponentials(&self, window: usize, _: usize, _: f64) -> Result<ExponentialSum> {
        let elements = self.classes.elements();
        let mut functions = Vec::new();
        let mut products = Vec::new();
        for (index, element) in elements.iter().enumerate() {
            let mut function = vec![0.0; elements.len()];
            function[index] = 1.0;
            functions.push(function);
            let weights = vec![self.weight_at(window + 1) / element.length()];
            let normal = weights.clone();
            products.push(TailProduct { functions: [index; 2], normal, tangential: weights });
        }
        ExponentialSum::new(vec![self.rate], functions, products)
    }
}

impl WeightsSource for VoigtSprings {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        Ok(Arc::new(VoigtWeights::new(*self, elements, time_step)))
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        matrix.fill(0.0);
        for component in 0..2 * elements.len() {
            matrix[component * (2 * elements.len() + 1)] = 1.0 / self.stiffness;
        }
        Ok(())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        self.has_identity.then(|| vec![self.stiffness, self.dashpots])
    }
}

/// GOAL: all histories give the closed form under a constant pressure.
/// REFERENCE: s(t) = p/k (1 − exp(−k t/c)).
#[test]
fn springs_creep_under_a_constant_pressure() {
    let elements = ten_elements(Grading::Cosine);
    let kernel: Arc<dyn ConvolutionWeights> =
        Arc::new(VoigtWeights::new(VOIGT_SPRINGS, &elements, 1e-4));
    let exponentials = ExponentialHistory::with_horizon(Arc::clone(&kernel), 1e-10, 3000).unwrap();
    assert_eq!((exponentials.fit().poles, exponentials.fit().functions), (1, 10));
    let histories: [Box<dyn ConvolutionHistory>; 3] = [
        Box::new(DirectHistory::new(Arc::clone(&kernel))),
        Box::new(RelaxedFftHistory::new(Arc::clone(&kernel))),
        Box::new(exponentials),
    ];
    let mut step_compliance = vec![f64::NAN; 400];
    kernel.step_compliance(&mut step_compliance).unwrap();
    for (number, mut history) in histories.into_iter().enumerate() {
        let mut displacement = vec![f64::NAN; 20];
        for step in 1..=500 {
            history.evaluate(&mut displacement).unwrap();
            let computed = displacement[3] + 1e5 * step_compliance[3 * 21];
            let expected = 1e5 / 5e7 * -(-0.01 * f64::from(step)).exp_m1();
            let error = (computed / expected - 1.0).abs();
            assert!(error < 1e-12, "{number}, {step}: {computed} {expected}");
            history.push(&[1e5; 20]);
        }
    }
}

/// Run of a block on this ground.
fn run_block(ground: impl Ground + 'static, time_step: f64, steps: usize) -> CompletedRun {
    let mut simulation = Simulation::builder(time_step)
        .structure(block())
        .ground(ground)
        .interface(Coulomb::new(0.4).unwrap())
        .motion(push())
        .gravity(9.81)
        .build()
        .unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    CompletedRun { run, simulation }
}

fn voigt_ground() -> WeightsGround {
    let elements = Strip::uniform(-2.0..2.0, 8).unwrap().elements();
    WeightsGround::new(VOIGT_SPRINGS, elements).unwrap()
}

#[test]
fn a_block_moves_alike_with_every_history() {
    let auto = run_block(voigt_ground(), 2e-3, 600);
    let choice = auto.simulation.ground().description().history.unwrap();
    assert_eq!(choice.kind, HistoryMethod::Exponentials);
    for method in [HistoryMethod::Auto, HistoryMethod::Direct, HistoryMethod::Exponentials] {
        let ground = voigt_ground().with_history(method).unwrap();
        let CompletedRun { run, simulation } = run_block(ground, 2e-3, 600);
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        assert_same_motion(&simulation, &auto.simulation, 1e-6);
    }
}

/// Difference of the largest base shear from that on the crate's springs, relative to that.
fn difference_from_spring_ground(time_step: f64, steps: usize) -> f64 {
    let springs = SpringGround::new(-2.0..2.0, 8, 5e7, 5e7).unwrap();
    let springs = springs.with_dashpots(5e5, 5e5).unwrap();
    let expected = run_block(springs, time_step, steps).run.whole.base_shear.largest().value;
    let computed = run_block(voigt_ground(), time_step, steps).run.whole.base_shear.largest().value;
    println!("{computed} {expected}");
    (computed / expected - 1.0).abs()
}

/// REFERENCE: the spring ground, whose rule of second order is another one.
#[test]
fn a_block_moves_as_on_the_spring_ground() {
    let coarse = difference_from_spring_ground(2e-3, 600);
    let fine = difference_from_spring_ground(5e-4, 2400);
    println!("{coarse:e} {fine:e}");
    assert!(fine < 2e-3 && fine < 0.5 * coarse, "{coarse:e} {fine:e}");
}

/// The half-plane by public types only.
struct HalfPlaneSource(ElasticGround);

impl WeightsSource for HalfPlaneSource {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        Ok(Arc::new(PatchKernel::new(soil(), elements.to_vec(), time_step)?))
    }

    fn static_compliance(&self, _: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        self.0.static_compliance(matrix)
    }
}

fn half_plane() -> ElasticGround {
    ElasticGround::new(soil(), Strip::graded(-2.0..2.0, 6).unwrap()).unwrap()
}

/// A ground of the half-plane's weights has the same bits as the half-plane.
#[test]
fn a_ground_of_half_plane_weights_has_the_bits_of_the_half_plane() {
    let elements = half_plane().elements().to_vec();
    let by_weights = WeightsGround::new(HalfPlaneSource(half_plane()), elements).unwrap();
    let computed = run_block(by_weights, 5e-3, 300).simulation;
    let expected = run_block(half_plane(), 5e-3, 300).simulation;
    assert_eq!(computed.state(), expected.state());
}

/// Number of kernels in the store after a ground has been prepared.
fn kernels_after_preparing(kernels: &SharedKernels, springs: VoigtSprings, step: f64) -> usize {
    let ground = WeightsGround::new(springs, ten_elements(Grading::Uniform)).unwrap();
    ground.with_shared_kernels(kernels).prepare(step, None, &mut unobserved).unwrap();
    kernels.count()
}

#[test]
fn kernels_are_shared_by_type_and_identity() {
    let kernels = SharedKernels::default();
    let other_dashpots = VoigtSprings { dashpots: 1e5, ..VOIGT_SPRINGS };
    let without_identity = VoigtSprings { has_identity: false, ..VOIGT_SPRINGS };
    assert_eq!(kernels_after_preparing(&kernels, VOIGT_SPRINGS, 1e-3), 1);
    assert_eq!(kernels_after_preparing(&kernels, VOIGT_SPRINGS, 1e-3), 1);
    assert_eq!(kernels_after_preparing(&kernels, VOIGT_SPRINGS, 2e-3), 2);
    assert_eq!(kernels_after_preparing(&kernels, other_dashpots, 1e-3), 3);
    assert_eq!(kernels_after_preparing(&kernels, without_identity, 5e-3), 3);
}

/// Weights without the last lag of their coupling.
struct UnknownCoupling(VoigtWeights);

impl ConvolutionWeights for UnknownCoupling {
    fn classes(&self) -> &PairClasses {
        self.0.classes()
    }

    fn coefficients(&self, class: usize, first: usize, values: &mut [&mut [f64]]) -> Result<()> {
        self.0.coefficients(class, first, values)
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        Some(&self.0)
    }
}

#[track_caller]
fn assert_exponentials_are_errors(error: Option<&Error>) {
    assert!(
        matches!(error, Some(Error::Scene { quantity: "history by exponentials", .. })),
        "{error:?}"
    );
}

#[test]
fn without_late_weights_exponentials_are_errors() {
    let springs = VoigtSprings { has_late_weights: false, ..VOIGT_SPRINGS };
    let ground = WeightsGround::new(springs, ten_elements(Grading::Uniform)).unwrap();
    let mut exponentials = ground.with_history(HistoryMethod::Exponentials).unwrap();
    let preparation = exponentials.prepare(1e-3, None, &mut unobserved);
    assert_exponentials_are_errors(preparation.as_ref().err());
    // Auto chooses transforms.
    let coarse = HistoryOptions { tolerance: Some(1e-6), ..HistoryOptions::default() };
    let ground = WeightsGround::new(springs, ten_elements(Grading::Uniform)).unwrap();
    let mut auto = ground.with_history(coarse).unwrap();
    auto.prepare(1e-3, Some(5000), &mut unobserved).unwrap();
    let choice = auto.description().history.unwrap();
    assert_eq!((choice.kind, choice.error_bound), (HistoryMethod::RelaxedFft, 0.0));

    let weights = VoigtWeights::new(VOIGT_SPRINGS, &ten_elements(Grading::Uniform), 1e-4);
    let kernel = Arc::new(UnknownCoupling(weights));
    let history = ExponentialHistory::with_horizon(kernel, 1e-6, 3000);
    assert_exponentials_are_errors(history.as_ref().err());
}

/// A product of these functions with these weights.
fn tail_product(functions: [usize; 2], normal: &[f64], tangential: &[f64]) -> TailProduct {
    TailProduct { functions, normal: normal.to_vec(), tangential: tangential.to_vec() }
}

/// A sum of one rate and one product.
fn one_rate_sum(rate: f64, functions: &[Vec<f64>], product: TailProduct) -> Result<ExponentialSum> {
    ExponentialSum::new(vec![rate], functions.to_vec(), vec![product])
}

#[test]
fn exponentials_of_wrong_sizes_are_errors() {
    let unit_functions = [vec![1.0; 10]];
    let valid_product = tail_product([0, 0], &[1.0], &[1.0]);
    assert!(one_rate_sum(0.1, &unit_functions, valid_product.clone()).is_ok());
    for rate in [-0.1, f64::NAN] {
        let result = one_rate_sum(rate, &unit_functions, valid_product.clone());
        assert!(matches!(result, Err(Error::Input { .. })));
    }
    let functions_of_unequal_length = [vec![1.0; 10], vec![1.0; 9]];
    assert!(matches!(
        one_rate_sum(0.1, &functions_of_unequal_length, valid_product),
        Err(Error::Size { .. })
    ));
    let unknown_function = one_rate_sum(0.1, &unit_functions, tail_product([0, 1], &[], &[]));
    assert!(matches!(unknown_function, Err(Error::Index { .. })));
    for (normal, tangential) in [(&[1.0][..], &[][..]), (&[1.0; 2], &[1.0; 2])] {
        let result = one_rate_sum(0.1, &unit_functions, tail_product([0, 0], normal, tangential));
        assert!(matches!(result, Err(Error::Size { .. })));
    }
    let not_finite = one_rate_sum(0.1, &unit_functions, tail_product([0, 0], &[f64::NAN], &[1.0]));
    assert!(matches!(not_finite, Err(Error::Input { .. })));
}

/// The history is the same for every number of steps; its description has whether the end is known.
#[test]
fn the_history_does_not_depend_on_the_length_of_a_run() {
    for steps in [2_000_000, 500, usize::MAX] {
        let mut simulation = Simulation::builder(5e-3)
            .structure(block())
            .ground(ElasticGround::new(soil(), Strip::uniform(-2.0..2.0, 8).unwrap()).unwrap())
            .interface(Coulomb::new(0.4).unwrap())
            .motion(push())
            .build()
            .unwrap();
        simulation.run(steps, |_| std::ops::ControlFlow::Break(())).unwrap();
        let choice = simulation.ground().description().history.unwrap();
        assert_eq!(choice.kind, HistoryMethod::Exponentials, "{steps} steps");
        assert_eq!(choice.steps, Some(steps).filter(|steps| *steps < usize::MAX));
        let says_unknown_end = choice.to_string().contains("no known end");
        assert_eq!(says_unknown_end, steps == usize::MAX, "{choice}");
    }
}
