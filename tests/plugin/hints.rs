//! GOAL: a known number of steps makes no more convolution weights than the steps need. SCENE: four elements on the
//! half-plane, with late weights as exponentials and without (as with damping). REFERENCE: the lags that the march
//! requests without a known end.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::bem::{ContactElement, Ground, PatchKernel, Strip, WeightsGround, WeightsSource};
use basemat::history::{
    ConvolutionWeights, HistoryMethod, LateWeights, PairClasses, SharedSpectra,
};
use basemat::{Observer, Result, unobserved};

use super::scene::soil;

/// The closed form, and the lags requested from it.
#[derive(Clone)]
struct Counted {
    late: bool,
    /// Coefficients of one kind, of all classes together.
    made: Arc<AtomicUsize>,
    /// Latest lag that was announced.
    prepared: Arc<AtomicUsize>,
    kernel: Option<Arc<PatchKernel>>,
}

impl Counted {
    fn own(&self) -> &PatchKernel {
        self.kernel.as_ref().unwrap()
    }
}

impl ConvolutionWeights for Counted {
    fn classes(&self) -> &PairClasses {
        self.own().classes()
    }

    fn prepare(&self, lags: usize, _: &mut Observer<'_>) -> Result<()> {
        self.prepared.fetch_max(lags, Ordering::Relaxed);
        Ok(())
    }

    fn coefficients(
        &self,
        class: usize,
        first_lag: usize,
        values: &mut [&mut [f64]],
    ) -> Result<()> {
        self.made.fetch_add(values[0].len(), Ordering::Relaxed);
        self.own().coefficients(class, first_lag, values)
    }

    fn last_coupling_lag(&self, class: usize) -> Result<Option<usize>> {
        self.own().last_coupling_lag(class)
    }

    fn late_weights(&self) -> Option<&dyn LateWeights> {
        self.own().late_weights().filter(|_| self.late)
    }

    fn spectra(&self) -> Option<&SharedSpectra> {
        None
    }
}

impl WeightsSource for Counted {
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

/// Requests of a march.
struct March {
    /// Coefficients before the first step and in all.
    made: [usize; 2],
    prepared: usize,
    history: HistoryMethod,
}

fn march(late: bool, steps: usize, known: bool) -> March {
    let counter = || Arc::new(AtomicUsize::new(0));
    let source = Counted { late, made: counter(), prepared: counter(), kernel: None };
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let mut ground = WeightsGround::new(source.clone(), elements).unwrap();
    ground.prepare(2e-3, known.then_some(steps), &mut unobserved).unwrap();
    let made = || source.made.load(Ordering::Relaxed);
    let before = made();
    let mut displacement = [0.0; 8];
    for step in 0..steps {
        ground.history(&mut displacement).unwrap();
        ground.commit(&[1.0 + step as f64; 8]);
    }
    let prepared = source.prepared.load(Ordering::Relaxed);
    let history = ground.description().history.unwrap().kind;
    March { made: [before, made()], prepared, history }
}

#[test]
fn a_known_end_makes_no_more_weights_than_steps_need() {
    for (steps, late) in [(2_000_usize, true), (2_000, false), (50_000, true), (50_000, false)] {
        let (without, with) = (march(late, steps, false), march(late, steps, true));
        let March { made, history, .. } = with;
        println!("late {late}, {steps} steps: {:?}, told {made:?} {history}", without.made);
        assert_eq!(without.history, history);
        assert_eq!(history == HistoryMethod::Exponentials, late);
        // All before the first step.
        assert_eq!(made[0], made[1]);
        if late {
            assert_eq!(made, without.made);
        } else {
            // Without a known end, some are made again while memory grows.
            assert!(
                without.made[0] == 0 && made[1] <= without.made[1],
                "{made:?} {:?}",
                without.made
            );
            assert_eq!(with.prepared, steps.next_power_of_two());
        }
    }
}
