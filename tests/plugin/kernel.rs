//! A kernel of one's own: closed forms, a tail of its own, and one that computes blocks of lags.

use std::sync::{Arc, Mutex};

use basemat::bem::{
    ContactElement, ElasticGround, Grading, Ground, PatchKernel, SharedKernels, SpringGround,
    Strip, WeightsGround, WeightsSource,
};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, ExponentialSum,
    HistoryMethod, HistoryOptions, LateWeights, PairClasses, RelaxedFftHistory, SharedSpectra,
    TailProduct, by_kind,
};
use basemat::interface::Coulomb;
use basemat::results::Run;
use basemat::{Error, Observer, Result, Simulation, unobserved};

use super::scene::{assert_same_motion, push, soil};
use basemat_problems::block_on_springs::block;

/// Coefficients that fade with distance and lag; reciprocal, not passive.
#[derive(Clone)]
struct Fading {
    classes: PairClasses,
    /// Last lag of the coupling.
    ends: Option<usize>,
    spectra: Option<SharedSpectra>,
}

impl Fading {
    fn new(elements: Vec<ContactElement>, ends: Option<usize>) -> Self {
        let classes = PairClasses::new(elements).unwrap();
        Self { classes, ends, spectra: None }
    }

    fn at(&self, class: usize, lag: usize) -> [f64; 3] {
        let [source, receiver] = self.classes.representative(class).unwrap();
        let distance = receiver.center()[0] - source.center()[0];
        let weight = source.length() * receiver.length() / (1.0 + distance * distance);
        let fade = |rate: f64| weight * (-rate * lag as f64).exp();
        let ended = self.ends.is_some_and(|last| lag > last);
        [fade(0.004), 0.7 * fade(0.01), if ended { 0.0 } else { distance * fade(0.003) }]
    }
}

impl ConvolutionWeights for Fading {
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
        for i in 0..normal.len() {
            [normal[i], tangential[i], coupling[i]] = self.at(class, first_lag + i);
        }
        Ok(())
    }

    fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
        Ok(self.ends)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        self.spectra.as_ref()
    }
}

/// The same, computed in blocks of the lags 1, 2, 3 to 4, 5 to 8, … when they are prepared.
struct InBlocks {
    kernel: Fading,
    /// Per class, what there is so far.
    ready: Mutex<Vec<Vec<[f64; 3]>>>,
}

impl InBlocks {
    fn new(kernel: Fading) -> Self {
        let ready = Mutex::new(vec![Vec::new(); kernel.classes.count()]);
        Self { kernel, ready }
    }
}

impl ConvolutionWeights for InBlocks {
    fn classes(&self) -> &PairClasses {
        &self.kernel.classes
    }

    fn prepare(&self, lags: usize, _: &mut Observer<'_>) -> Result<()> {
        for (class, ready) in self.ready.lock().unwrap().iter_mut().enumerate() {
            for lag in ready.len() + 1..=lags.next_power_of_two() {
                ready.push(self.kernel.at(class, lag));
            }
        }
        Ok(())
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        let [normal, tangential, coupling] = by_kind(values)?;
        self.prepare(first_lag - 1 + normal.len(), &mut unobserved)?;
        let ready = &self.ready.lock().unwrap()[class];
        for (i, values) in ready[first_lag - 1..][..normal.len()].iter().enumerate() {
            [normal[i], tangential[i], coupling[i]] = *values;
        }
        Ok(())
    }
}

fn traction(step: usize, size: usize) -> Vec<f64> {
    (0..size).map(|i| (1e4 * (1.7 + (3 * step + 7 * i) as f64).sin()).sin() + 0.3).collect()
}

/// All displacements of a march, with `hints` given along the way.
fn march(history: &mut dyn ConvolutionHistory, steps: usize, hints: &[(usize, usize)]) -> Vec<f64> {
    let mut all = Vec::new();
    let mut displacement = vec![f64::NAN; 20];
    for step in 0..steps {
        for (_, hint) in hints.iter().filter(|(at, _)| *at == step) {
            history.prepare(*hint, &mut unobserved).unwrap();
        }
        displacement.fill(f64::NAN);
        history.evaluate(&mut displacement).unwrap();
        all.extend_from_slice(&displacement);
        history.push(&traction(step, 20));
    }
    all
}

fn strips(grading: Grading) -> Vec<ContactElement> {
    Strip::new(-5.0..5.0, 10, grading).unwrap().elements()
}

/// GOAL: every exact history of a foreign kernel is the same sum.
/// SCENE: equal elements (wavenumbers) and graded ones (pairs); a coupling that ends at once, soon,
/// late, never; spectra shared or not; a kernel that computes blocks.
#[test]
fn exact_histories_of_a_foreign_kernel_agree() {
    let steps = 1100;
    for grading in [Grading::Uniform, Grading::Cosine] {
        for ends in [Some(0), Some(40), Some(300), None] {
            let kernel = Fading::new(strips(grading), ends);
            let shared = Fading { spectra: Some(SharedSpectra::default()), ..kernel.clone() };
            let wanted = march(&mut DirectHistory::new(Arc::new(kernel.clone())), steps, &[]);
            let largest = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let blocks = Arc::new(InBlocks::new(Fading { ends: None, ..kernel.clone() }));
            let whole = march(&mut RelaxedFftHistory::new(Arc::new(kernel.clone())), steps, &[]);
            for (a, b) in whole.iter().zip(&wanted) {
                assert!((a - b).abs() < 1e-13 * largest, "{grading:?} {ends:?}: {a} {b}");
            }
            // Neither hints nor shared spectra nor how the kernel computes moves a bit.
            for hints in [&[(0, steps)][..], &[(0, 33), (50, 340)], &[(64, 1000)]] {
                let mut again = RelaxedFftHistory::new(Arc::new(shared.clone()));
                assert_eq!(
                    march(&mut again, steps, hints),
                    whole,
                    "{grading:?} {ends:?} {hints:?}"
                );
            }
            if ends.is_none() {
                let direct = &mut DirectHistory::new(blocks.clone());
                assert_eq!(march(direct, steps, &[]), wanted, "{grading:?}");
                let relaxed = &mut RelaxedFftHistory::new(blocks);
                assert_eq!(march(relaxed, steps, &[]), whole, "{grading:?}");
            }
        }
    }
}

/// Spectra kept for another patch by mistake are left alone.
#[test]
fn spectra_of_another_patch_are_not_taken() {
    let spectra = Some(SharedSpectra::default());
    let other = Strip::uniform(0.0..1.0, 3).unwrap().elements();
    let other = Fading { spectra: spectra.clone(), ..Fading::new(other, None) };
    RelaxedFftHistory::new(Arc::new(other)).prepare(200, &mut unobserved).unwrap();
    for grading in [Grading::Uniform, Grading::Cosine] {
        let own = Fading::new(strips(grading), Some(90));
        let wanted = march(&mut RelaxedFftHistory::new(Arc::new(own.clone())), 200, &[]);
        let own = Arc::new(Fading { spectra: spectra.clone(), ..own });
        assert_eq!(march(&mut RelaxedFftHistory::new(own), 200, &[]), wanted);
    }
}

/// Lags must not depend on the order or size of requests.
#[test]
fn coefficients_do_not_depend_on_the_cut() {
    const LAGS: usize = 700;
    let patch = PatchKernel::new(soil(), strips(Grading::Cosine), 2e-3).unwrap();
    let blocks = InBlocks::new(Fading::new(strips(Grading::Cosine), None));
    for kernel in [&patch as &dyn ConvolutionWeights, &blocks] {
        for class in [0, 1, kernel.classes().count() - 1] {
            let fill = |first: usize, count: usize| {
                let [mut zz, mut xx, mut zx] = [(); 3].map(|()| vec![f64::NAN; count]);
                kernel.coefficients(class, first, &mut [&mut zz, &mut xx, &mut zx]).unwrap();
                [zz, xx, zx]
            };
            // The last first: nothing was prepared.
            let cut =
                [(400, 301), (1, 1), (2, 62), (64, 1), (65, 335)].map(|(a, b)| (a, fill(a, b)));
            kernel.prepare(LAGS, &mut unobserved).unwrap();
            let whole = fill(1, LAGS);
            for (first, values) in &cut {
                for (values, whole) in values.iter().zip(&whole) {
                    assert_eq!(values[..], whole[first - 1..][..values.len()], "from {first}");
                }
            }
        }
    }
}

/// Independent springs with dashpots, exactly integrated (Kelvin–Voigt).
#[derive(Clone, Copy)]
struct Voigt {
    stiffness: f64,
    dashpots: f64,
    /// Whether it says that its late lags are exponentials.
    late: bool,
    identity: bool,
}

const VOIGT: Voigt = Voigt { stiffness: 5e7, dashpots: 5e5, late: true, identity: true };

struct VoigtKernel {
    soil: Voigt,
    classes: PairClasses,
    rate: f64,
}

impl VoigtKernel {
    fn new(soil: Voigt, elements: &[ContactElement], time_step: f64) -> Self {
        let classes = PairClasses::new(elements.to_vec()).unwrap();
        Self { soil, classes, rate: soil.stiffness * time_step / soil.dashpots }
    }

    /// Mean under a unit traction at a lag.
    fn at(&self, lag: usize) -> f64 {
        -(-self.rate).exp_m1() / self.soil.stiffness * (-self.rate * (lag - 1) as f64).exp()
    }
}

impl ConvolutionWeights for VoigtKernel {
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
            *value = length * self.at(first_lag + i);
        }
        tangential.copy_from_slice(normal);
        coupling.fill(0.0);
        Ok(())
    }

    fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
        Ok(Some(0))
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        self.soil.late.then_some(self)
    }
}

impl LateWeights for VoigtKernel {
    fn window(&self) -> usize {
        1
    }

    /// One rate; one function for each element, which is 1 there and 0 elsewhere.
    fn exponentials(&self, window: usize, _: usize, _: f64) -> Result<ExponentialSum> {
        let elements = self.classes.elements();
        let functions = (0..elements.len())
            .map(|own| (0..elements.len()).map(|e| f64::from(u8::from(e == own))).collect())
            .collect();
        let product = |own: usize| {
            let weights = vec![self.at(window + 1) / elements[own].length()];
            TailProduct { functions: [own; 2], normal: weights.clone(), tangential: weights }
        };
        let products = (0..elements.len()).map(product).collect();
        ExponentialSum::new(vec![self.rate], functions, products)
    }
}

impl WeightsSource for Voigt {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        Ok(Arc::new(VoigtKernel::new(*self, elements, time_step)))
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        matrix.fill(0.0);
        for component in 0..2 * elements.len() {
            matrix[component * (2 * elements.len() + 1)] = 1.0 / self.stiffness;
        }
        Ok(())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        self.identity.then(|| vec![self.stiffness, self.dashpots])
    }
}

/// GOAL: all histories give the closed form under a pressure that is held.
/// REFERENCE: s(t) = p/k (1 − exp(−k t/c)).
#[test]
fn a_held_pressure_on_the_voigt_bed() {
    let elements = strips(Grading::Cosine);
    let kernel: Arc<dyn ConvolutionWeights> = Arc::new(VoigtKernel::new(VOIGT, &elements, 1e-4));
    let exponentials = ExponentialHistory::with_horizon(Arc::clone(&kernel), 1e-10, 3000).unwrap();
    assert_eq!((exponentials.fit().poles, exponentials.fit().functions), (1, 10));
    let histories: [Box<dyn ConvolutionHistory>; 3] = [
        Box::new(DirectHistory::new(Arc::clone(&kernel))),
        Box::new(RelaxedFftHistory::new(Arc::clone(&kernel))),
        Box::new(exponentials),
    ];
    let mut instantaneous = vec![f64::NAN; 400];
    kernel.step_compliance(&mut instantaneous).unwrap();
    for (number, mut history) in histories.into_iter().enumerate() {
        let mut s = vec![f64::NAN; 20];
        for step in 1..=500 {
            history.evaluate(&mut s).unwrap();
            let found = s[3] + 1e5 * instantaneous[3 * 21];
            let wanted = 1e5 / 5e7 * -(-0.01 * f64::from(step)).exp_m1();
            assert!((found / wanted - 1.0).abs() < 1e-12, "{number}, {step}: {found} {wanted}");
            history.push(&[1e5; 20]);
        }
    }
}

fn run(ground: impl Ground + 'static, time_step: f64, steps: usize) -> (Simulation, Run) {
    let mut simulation = Simulation::builder(time_step)
        .structure(block())
        .ground(ground)
        .interface(Coulomb::new(0.4).unwrap())
        .motion(push())
        .gravity(9.81)
        .build()
        .unwrap();
    let run = simulation.run(steps, |_| {}).unwrap();
    (simulation, run)
}

fn bed() -> WeightsGround {
    WeightsGround::new(VOIGT, Strip::uniform(-2.0..2.0, 8).unwrap().elements()).unwrap()
}

/// GOAL: a foreign kernel carries a structure, whatever the history.
/// REFERENCE: the spring bed, whose rule of second order is another one.
#[test]
fn a_block_on_the_voigt_bed() {
    let kinds = [HistoryMethod::Auto, HistoryMethod::Direct, HistoryMethod::Exponentials];
    let [auto, direct, exponentials] =
        kinds.map(|kind| run(bed().with_history(kind).unwrap(), 2e-3, 600));
    assert_eq!(auto.0.ground().description().history.unwrap().kind, HistoryMethod::Exponentials);
    for (simulation, run) in [&auto, &direct, &exponentials] {
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        assert_same_motion(simulation, &auto.0, 1e-6);
    }
    let difference = |time_step: f64, steps| {
        let springs = SpringGround::new(-2.0..2.0, 8, 5e7, 5e7).unwrap();
        let springs = springs.with_dashpots(5e5, 5e5).unwrap();
        let peak = |run: Run| run.whole.base_shear.largest().value;
        let (own, other) =
            (peak(run(bed(), time_step, steps).1), peak(run(springs, time_step, steps).1));
        println!("{own} {other}");
        (own / other - 1.0).abs()
    };
    let (coarse, fine) = (difference(2e-3, 600), difference(5e-4, 2400));
    println!("{coarse:e} {fine:e}");
    assert!(fine < 2e-3 && fine < 0.5 * coarse, "{coarse:e} {fine:e}");
}

/// The half-plane from outside: the same bits as the crate's own ground.
#[test]
fn a_kernel_ground_is_what_the_half_plane_is_made_of() {
    struct Outside(ElasticGround);
    impl WeightsSource for Outside {
        fn kernel(
            &self,
            elements: &[ContactElement],
            dt: f64,
        ) -> Result<Arc<dyn ConvolutionWeights>> {
            Ok(Arc::new(PatchKernel::new(soil(), elements.to_vec(), dt)?))
        }
        fn static_compliance(&self, _: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
            self.0.static_compliance(matrix)
        }
    }
    let ground = || ElasticGround::new(soil(), Strip::graded(-2.0..2.0, 6).unwrap()).unwrap();
    let elements = ground().elements().to_vec();
    let own = WeightsGround::new(Outside(ground()), elements).unwrap();
    let (own, other) = (run(own, 5e-3, 300).0, run(ground(), 5e-3, 300).0);
    assert_eq!(own.state(), other.state());
}

#[test]
fn kernels_are_shared_by_type_and_identity() {
    let kernels = SharedKernels::default();
    let prepare = |soil: Voigt, time_step: f64| {
        let ground = WeightsGround::new(soil, strips(Grading::Uniform)).unwrap();
        ground.with_shared_kernels(&kernels).prepare(time_step, None, &mut unobserved).unwrap();
        kernels.count()
    };
    assert_eq!([prepare(VOIGT, 1e-3), prepare(VOIGT, 1e-3)], [1, 1]);
    assert_eq!(prepare(VOIGT, 2e-3), 2);
    assert_eq!(prepare(Voigt { dashpots: 1e5, ..VOIGT }, 1e-3), 3);
    assert_eq!(prepare(Voigt { identity: false, ..VOIGT }, 5e-3), 3);
}

/// Says nothing of where its coupling ends.
struct Coupled(VoigtKernel);
impl ConvolutionWeights for Coupled {
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

#[test]
fn without_late_weights_exponentials_are_refused() {
    let none = Voigt { late: false, ..VOIGT };
    let ground = || WeightsGround::new(none, strips(Grading::Uniform)).unwrap();
    let refused = ground().with_history(HistoryMethod::Exponentials).unwrap().prepare(
        1e-3,
        None,
        &mut unobserved,
    );
    assert!(
        matches!(refused, Err(Error::Scene { quantity: "history by exponentials", .. })),
        "{refused:?}"
    );
    // Auto takes the transforms.
    let coarse = HistoryOptions { tolerance: Some(1e-6), ..HistoryOptions::default() };
    let mut auto = ground().with_history(coarse).unwrap();
    auto.prepare(1e-3, Some(5000), &mut unobserved).unwrap();
    let choice = auto.description().history.unwrap();
    assert_eq!((choice.kind, choice.error_bound), (HistoryMethod::RelaxedFft, 0.0));

    let kernel = Coupled(VoigtKernel::new(VOIGT, &strips(Grading::Uniform), 1e-4));
    let refused = ExponentialHistory::with_horizon(Arc::new(kernel), 1e-6, 3000).err();
    assert!(
        matches!(refused, Some(Error::Scene { quantity: "history by exponentials", .. })),
        "{refused:?}"
    );
}

#[test]
fn a_tail_that_does_not_fit_is_refused() {
    let product = |functions, normal: &[f64], tangential: &[f64]| TailProduct {
        functions,
        normal: normal.to_vec(),
        tangential: tangential.to_vec(),
    };
    let new = |rate: f64, functions: &[Vec<f64>], product: TailProduct| {
        ExponentialSum::new(vec![rate], functions.to_vec(), vec![product])
    };
    let ones = [vec![1.0; 10]];
    let fits = product([0, 0], &[1.0], &[1.0]);
    assert!(new(0.1, &ones, fits.clone()).is_ok());
    for rate in [-0.1, f64::NAN] {
        assert!(matches!(new(rate, &ones, fits.clone()), Err(Error::Input { .. })));
    }
    let uneven = [vec![1.0; 10], vec![1.0; 9]];
    assert!(matches!(new(0.1, &uneven, fits.clone()), Err(Error::Size { .. })));
    assert!(matches!(new(0.1, &ones, product([0, 1], &[], &[])), Err(Error::Index { .. })));
    for (normal, tangential) in [(&[1.0][..], &[][..]), (&[1.0; 2], &[1.0; 2])] {
        let refused = new(0.1, &ones, product([0, 0], normal, tangential));
        assert!(matches!(refused, Err(Error::Size { .. })));
    }
    let nan = product([0, 0], &[f64::NAN], &[1.0]);
    assert!(matches!(new(0.1, &ones, nan), Err(Error::Input { .. })));
}

/// One history whatever the number of steps; its description says whether an end is known.
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
        let says = choice.to_string().contains("no known end");
        assert_eq!(says, steps == usize::MAX, "{choice}");
    }
}
