//! GOAL: with a known number of steps no more convolution weights are computed than the steps need.
//! SCENE: four elements on the half-plane, with late weights as exponentials and without (as with damping).
//! REFERENCE: the lags that are requested when the end is not known.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::bem::{ContactElement, Ground, PatchKernel, Strip, WeightsGround, WeightsSource};
use basemat::history::{
    ConvolutionWeights, HistoryMethod, LateWeights, PairClasses, SharedSpectra,
};
use basemat::{Observer, Result, unobserved};

use super::scene::soil;

/// Convolution weights of the half-plane that count the requested coefficients.
#[derive(Clone, Default)]
struct CountingWeights {
    has_late_weights: bool,
    /// Number of requested coefficients of one kind, in all classes together.
    computed: Arc<AtomicUsize>,
    /// Largest number of lags to prepare.
    prepared_lags: Arc<AtomicUsize>,
    kernel: Option<Arc<PatchKernel>>,
}

impl CountingWeights {
    fn kernel(&self) -> &PatchKernel {
        self.kernel.as_ref().unwrap()
    }
}

impl ConvolutionWeights for CountingWeights {
    fn classes(&self) -> &PairClasses {
        self.kernel().classes()
    }

    fn prepare(&self, lags: usize, _: &mut Observer<'_>) -> Result<()> {
        self.prepared_lags.fetch_max(lags, Ordering::Relaxed);
        Ok(())
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        self.computed.fetch_add(values[0].len(), Ordering::Relaxed);
        self.kernel().coefficients(class, first_lag, values)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        self.kernel().last_coupling_lag(class)
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        self.kernel().late_weights().filter(|_| self.has_late_weights)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        None
    }
}

impl WeightsSource for CountingWeights {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        let kernel = Some(Arc::new(PatchKernel::new(soil(), elements.to_vec(), time_step)?));
        Ok(Arc::new(Self { kernel, ..self.clone() }))
    }

    fn static_compliance(&self, _: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        matrix.fill(0.0);
        Ok(())
    }
}

/// Requests of weights in a number of steps.
struct Requests {
    computed_before_first_step: usize,
    computed: usize,
    prepared_lags: usize,
    method: HistoryMethod,
}

/// Requests of a run of `steps` steps, whose number may be known before the first step.
fn requests(has_late_weights: bool, steps: usize, is_known: bool) -> Requests {
    let source = CountingWeights { has_late_weights, ..CountingWeights::default() };
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let mut ground = WeightsGround::new(source.clone(), elements).unwrap();
    ground.prepare(2e-3, is_known.then_some(steps), &mut unobserved).unwrap();
    let computed_before_first_step = source.computed.load(Ordering::Relaxed);
    let mut displacement = [0.0; 8];
    for step in 0..steps {
        ground.history(&mut displacement).unwrap();
        ground.commit(&[1.0 + step as f64; 8]);
    }
    Requests {
        computed_before_first_step,
        computed: source.computed.load(Ordering::Relaxed),
        prepared_lags: source.prepared_lags.load(Ordering::Relaxed),
        method: ground.description().history.unwrap().kind,
    }
}

#[test]
fn a_known_end_requests_no_more_weights_than_steps_need() {
    for (steps, has_late_weights) in
        [(2_000_usize, true), (2_000, false), (50_000, true), (50_000, false)]
    {
        let unknown_end = requests(has_late_weights, steps, false);
        let known_end = requests(has_late_weights, steps, true);
        let label = format!(
            "late {has_late_weights}, {steps} steps: {} weights, {} with a known end, {}",
            unknown_end.computed, known_end.computed, known_end.method
        );
        println!("{label}");
        assert_eq!(unknown_end.method, known_end.method);
        assert_eq!(known_end.method == HistoryMethod::Exponentials, has_late_weights);
        assert_eq!(known_end.computed_before_first_step, known_end.computed);
        if has_late_weights {
            let before = unknown_end.computed_before_first_step;
            assert_eq!(known_end.computed_before_first_step, before);
            assert_eq!(known_end.computed, unknown_end.computed);
        } else {
            // Without a known end, some are computed again while memory grows.
            assert_eq!(unknown_end.computed_before_first_step, 0, "{label}");
            assert!(known_end.computed <= unknown_end.computed, "{label}");
            assert_eq!(known_end.prepared_lags, steps.next_power_of_two());
        }
    }
}
