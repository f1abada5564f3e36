//! A ground made of coefficients.

use std::sync::Arc;

use super::plan::Unions;
use super::{Ground, SharedKernels, WeightsSource};
use crate::error::{CheckpointError, Error, Observer, Progress, Result, Watch};
use crate::geometry::{ContactElement, PLANE, SPACE, check_order};
use crate::history::{
    ChosenHistory, ConvolutionHistory, ConvolutionWeights, HistoryChoice, HistoryMethod,
    HistoryOptions, RESERVED_STEPS, SavedChoice,
};

/// Any soil that knows its step coefficients and its static compliance, as a ground.
///
/// [`ElasticGround`](super::ElasticGround) is made of it, and so can be a soil of your own: a
/// [`WeightsSource`] and its [`ConvolutionWeights`]. All kinds of histories, their choice, shared kernels
/// and checkpoints come with it.
///
/// A bed of independent Kelvin–Voigt springs, exactly integrated: under a pressure held for one step
/// an element goes down by (1 − z)/k, and comes back by a factor z = exp(−k Δt/c) in each that
/// follows.
///
/// ```
/// use std::sync::Arc;
///
/// use basemat::bem::{ContactElement, WeightsGround, WeightsSource, Strip};
/// use basemat::history::{ConvolutionWeights, PairClasses};
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::{Result, Simulation};
///
/// /// Stiffness and dashpots per area, Pa/m and Pa s/m.
/// #[derive(Clone, Copy)]
/// struct Bed {
///     stiffness: f64,
///     dashpots: f64,
/// }
///
/// struct BedKernel {
///     bed: Bed,
///     time_step: f64,
///     classes: PairClasses,
/// }
///
/// impl ConvolutionWeights for BedKernel {
///     fn classes(&self) -> &PairClasses {
///         &self.classes
///     }
///
///     fn coefficients(
///         &self,
///         class: usize,
///         first_lag: usize,
///         values: [&mut [f64]; 3],
///     ) -> Result<()> {
///         let [normal, tangential, coupling] = values;
///         let Bed { stiffness, dashpots } = self.bed;
///         let rate = stiffness * self.time_step / dashpots;
///         let [source, receiver] = self.classes.representative(class)?;
///         // Integrals over the receiver; nothing moves but the loaded element.
///         let at_once = if source == receiver {
///             receiver.length() * -(-rate).exp_m1() / stiffness
///         } else {
///             0.0
///         };
///         for (i, value) in normal.iter_mut().enumerate() {
///             *value = at_once * (-rate * (first_lag - 1 + i) as f64).exp();
///         }
///         tangential.copy_from_slice(normal);
///         coupling.fill(0.0);
///         Ok(())
///     }
///
///     fn last_coupling_lag(&self, _class: usize) -> Result<Option<usize>> {
///         Ok(Some(0))
///     }
/// }
///
/// impl WeightsSource for Bed {
///     fn kernel(&self, elements: &[ContactElement], time_step: f64) -> Result<Arc<dyn ConvolutionWeights>> {
///         let classes = PairClasses::new(elements.to_vec())?;
///         Ok(Arc::new(BedKernel { bed: *self, time_step, classes }))
///     }
///
///     fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
///         matrix.fill(0.0);
///         for component in 0..2 * elements.len() {
///             matrix[component * (2 * elements.len() + 1)] = 1.0 / self.stiffness;
///         }
///         Ok(())
///     }
/// }
///
/// let bed = Bed { stiffness: 40.0e6, dashpots: 4.0e5 };
/// let run = Simulation::builder(0.005)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(WeightsGround::new(bed, Strip::uniform(-2.0..2.0, 8)?.elements())?)
///     .interface(Coulomb::new(0.4)?)
///     .motion(el_centro_1940())
///     .build()?
///     .run(400, |_| {})?;
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct WeightsGround {
    source: Box<dyn WeightsSource>,
    elements: Vec<ContactElement>,
    /// Front and back ends of elements in plan, m, and their parts inside the outline.
    depths: Option<(Vec<[f64; 2]>, Vec<f64>)>,
    /// Cells of elements in plan that are more than one.
    unions: Option<Unions>,
    options: HistoryOptions,
    own_history: Option<Box<MakeHistory>>,
    shared: SharedKernels,
    prepared: Option<Prepared>,
}

short_debug! {
    WeightsGround;
    self;
    elements: self.elements.len(),
    history: self.options,
    prepared: self.prepared.is_some(),
}

/// Makes the history of a kernel.
type MakeHistory = dyn Fn(Arc<dyn ConvolutionWeights>) -> Box<dyn ConvolutionHistory> + Send;

/// Kernel and history for one time step.
struct Prepared {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Left open until the number of steps is known or the first step is made.
    history: Option<Kept>,
}

enum Kept {
    Chosen(ChosenHistory),
    Own(Box<dyn ConvolutionHistory>),
}

impl Kept {
    fn any(&self) -> &dyn ConvolutionHistory {
        match self {
            Self::Chosen(history) => history,
            Self::Own(history) => &**history,
        }
    }

    fn any_mut(&mut self) -> &mut dyn ConvolutionHistory {
        match self {
            Self::Chosen(history) => history,
            Self::Own(history) => &mut **history,
        }
    }
}

impl Prepared {
    /// The history, made now if it has not been.
    fn history(
        &mut self,
        options: HistoryOptions,
        steps: Option<usize>,
    ) -> Result<&mut dyn ConvolutionHistory> {
        let history = match self.history.take() {
            Some(history) => history,
            None => Kept::Chosen(ChosenHistory::new(options, &self.kernel, steps)?),
        };
        let history = self.history.insert(history);
        if let (Kept::Chosen(history), Some(steps)) = (&mut *history, steps) {
            history.expect_steps(steps);
        }
        Ok(history.any_mut())
    }

    /// Makes ready for `steps` steps. What is stopped leaves no trace.
    fn reserve(
        &mut self,
        options: HistoryOptions,
        steps: usize,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<()> {
        let before = self.history.as_mut().map(|history| match history {
            Kept::Chosen(history) => *history.expected(),
            Kept::Own(_) => None,
        });
        let mut watch = observer.map_or_else(Watch::nobody, |observer| Watch::new("", 1, observer));
        let mut outcome = Ok(());
        if steps > 0 {
            let history = self.history(options, Some(steps))?;
            if steps <= history.steps().saturating_add(RESERVED_STEPS) {
                outcome = match watch.observer() {
                    Some(observer) => history.reserve_observed(steps, observer),
                    None => history.reserve(steps),
                };
            }
        }
        let outcome = outcome.and_then(|()| watch.reach(1));
        if let Err(Error::Stopped(_)) = outcome {
            match (before, &mut self.history) {
                (Some(before), Some(Kept::Chosen(history))) => *history.expected() = before,
                (Some(_), _) => {}
                (None, history) => *history = None,
            }
        }
        outcome
    }

    /// What was chosen.
    fn choice(&self) -> Option<HistoryChoice> {
        match &self.history {
            Some(Kept::Chosen(history)) => Some(history.choice()),
            _ => None,
        }
    }
}

impl WeightsGround {
    /// The ground of `source` under `elements`, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`] for no elements, [`Error::Input`] for elements that overlap, are out of order
    /// or have no length.
    pub fn new(source: impl WeightsSource, elements: Vec<ContactElement>) -> Result<Self> {
        check_order(&elements)?;
        Ok(Self { depths: None, ..Self::in_plan(source, elements, Default::default(), None) })
    }

    /// The same for elements in plan, whose source knows where they are: `depths` are front and back ends along y (m), and
    /// parts of their areas inside the outline.
    pub(super) fn in_plan(
        source: impl WeightsSource,
        elements: Vec<ContactElement>,
        depths: (Vec<[f64; 2]>, Vec<f64>),
        unions: Option<Unions>,
    ) -> Self {
        Self {
            source: Box::new(source),
            elements,
            depths: Some(depths),
            unions,
            options: HistoryOptions::default(),
            own_history: None,
            shared: SharedKernels::default(),
            prepared: None,
        }
    }

    /// With other options of its history, or another method alone.
    ///
    /// # Errors
    /// [`Error::Input`] for a tolerance not from 1e-12 to 1e-2.
    pub fn with_history(mut self, options: impl Into<HistoryOptions>) -> Result<Self> {
        (self.options, self.own_history) = (options.into().checked()?, None);
        Ok(self)
    }

    /// With a history of one's own: `make` is called with the coefficients once the time step is
    /// known.
    #[must_use]
    pub fn with_own_history(
        mut self,
        make: impl Fn(Arc<dyn ConvolutionWeights>) -> Box<dyn ConvolutionHistory> + Send + 'static,
    ) -> Self {
        self.own_history = Some(Box::new(make));
        self
    }

    /// With coefficients from a store that other grounds take them from as well: what is equal in
    /// the cases of a sweep is then computed once.
    #[must_use]
    pub fn with_shared_kernels(mut self, kernels: &SharedKernels) -> Self {
        self.shared = kernels.clone();
        self
    }

    /// With other coefficients.
    pub(super) fn with_source(self, source: impl WeightsSource) -> Self {
        Self { source: Box::new(source), prepared: None, ..self }
    }

    /// Before the first step, with a history where none is to be chosen.
    fn begin(&self, kernel: Arc<dyn ConvolutionWeights>) -> Result<Prepared> {
        let history = self.own_history.as_ref().map(|make| Kept::Own(make(Arc::clone(&kernel))));
        let mut prepared = Prepared { kernel, history };
        if self.options.method != HistoryMethod::Auto {
            prepared.history(self.options, None)?;
        }
        Ok(prepared)
    }
}

impl Ground for WeightsGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn directions(&self) -> usize {
        if self.depths.is_some() { SPACE } else { PLANE }
    }

    fn depth(&self, element: usize) -> [f64; 2] {
        let ends = self.depths.as_ref().and_then(|(depths, _)| depths.get(element));
        ends.map_or([0.0, 1.0], |ends| *ends)
    }

    fn fraction_inside(&self, element: usize) -> f64 {
        let inside = self.depths.as_ref().and_then(|(_, inside)| inside.get(element));
        inside.map_or(1.0, |inside| *inside)
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        let kernel = self.shared.kernel(&*self.source, &self.elements, time_step)?;
        self.prepared = Some(self.begin(kernel)?);
        Ok(())
    }

    fn expect_steps(&mut self, steps: usize, observer: Option<&mut Observer<'_>>) -> Result<()> {
        let Some(prepared) = &mut self.prepared else { return Err(NOT_PREPARED) };
        let Some(observer) = observer else { return prepared.reserve(self.options, steps, None) };
        let exponentials =
            prepared.choice().is_some_and(|choice| choice.kind == HistoryMethod::Exponentials);
        let kernel = Arc::clone(&prepared.kernel);
        let method = HistoryMethod::RelaxedFft;
        let lags = self.options.prepared_steps(method, &*kernel, steps.max(1))?;
        // As many as a history takes, by a power of two.
        let lags = lags.checked_next_power_of_two().unwrap_or(lags);
        let spectra = lags.saturating_mul(kernel.classes().count()) / SPECTRA + 1;
        let mut whole = Progress { task: "step coefficients", done: 0, total: spectra };
        // Exponentials have all weights that they need.
        let weights = if exponentials {
            Ok(())
        } else {
            kernel.prepare_observed(lags, &mut |Progress { done, total, task }| {
                whole = Progress { task, done, total: total + spectra };
                observer(whole)
            })
        };
        let done = whole.total - spectra;
        let outcome = weights.and_then(|()| {
            prepared.reserve(
                self.options,
                steps,
                Some(&mut |part| {
                    whole.done = done + spectra * part.done / part.total.max(1);
                    observer(whole)
                }),
            )
        });
        outcome.map_err(|error| match error {
            Error::Stopped(_) => Error::Stopped(whole),
            other => other,
        })
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let Some(Prepared { kernel, .. }) = &self.prepared else { return Err(NOT_PREPARED) };
        match &self.unions {
            Some(unions) => unions.reduce(matrix, |cells| kernel.step_compliance(cells)),
            None => kernel.step_compliance(matrix),
        }
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let Some(prepared) = &mut self.prepared else { return Err(NOT_PREPARED) };
        let history = prepared.history(self.options, None)?;
        match &mut self.unions {
            Some(unions) => unions.gather(displacement, |cells| history.evaluate(cells)),
            None => history.evaluate(displacement),
        }
    }

    fn commit(&mut self, traction: &[f64]) {
        let Some(prepared) = &mut self.prepared else { return };
        // Where Auto has nothing to go by, it takes a history that can always be made.
        if let Ok(history) = prepared.history(self.options, None) {
            history.push(self.unions.as_mut().map_or(traction, |unions| unions.spread(traction)));
        }
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        self.source.shear_wave_speed()
    }

    fn history_choice(&self) -> Option<HistoryChoice> {
        self.prepared.as_ref()?.choice()
    }

    fn increment_error_bound(&self) -> f64 {
        let history = self.prepared.as_ref().and_then(|prepared| prepared.history.as_ref());
        history.map_or(0.0, |history| history.any().increment_error_bound())
    }

    /// Which history was chosen for how many steps, and what it says.
    fn save(&self) -> Result<Vec<f64>> {
        let prepared = self.prepared.as_ref().ok_or(NOT_PREPARED)?;
        let mut values = SavedChoice::new(prepared.choice()).numbers().to_vec();
        if let Some(history) = &prepared.history {
            values.extend(history.any().save()?);
        }
        Ok(values)
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let prepared = self.prepared.as_mut().ok_or(NOT_PREPARED)?;
        let (saved, values) = SavedChoice::read(values)?;
        let own = SavedChoice::new(prepared.choice());
        let other = CheckpointError::OtherScene { quantity: "kind of history" };
        if let Some(history) = prepared.history.as_mut().filter(|_| own == saved) {
            return history.any_mut().restore(steps, values);
        }
        if saved.kind == HistoryMethod::Auto {
            // Nothing had been chosen yet, so that it is still to be.
            if self.own_history.is_some() || steps > 0 || !values.is_empty() {
                return Err(other.into());
            }
            let kernel = Arc::clone(&prepared.kernel);
            self.prepared = Some(self.begin(kernel)?);
            return Ok(());
        }
        // The same history is chosen again, and taken once it has the values.
        let mut history = ChosenHistory::new(self.options, &prepared.kernel, saved.steps)?;
        if history.choice().kind != saved.kind {
            let later = history.succeeded(steps).ok().flatten();
            history = later.filter(|later| later.choice().kind == saved.kind).ok_or(other)?;
        }
        history.restore(steps, values)?;
        prepared.history = Some(Kept::Chosen(history));
        Ok(())
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let find = |matrix: &mut [f64]| self.source.static_compliance(&self.elements, matrix);
        match &self.unions {
            Some(unions) => unions.reduce(matrix, find),
            None => find(matrix),
        }
    }
}

/// Lags of a class of which spectra are made in the time of a sample of layered ground.
const SPECTRA: usize = 8192;

const NOT_PREPARED: Error = Error::Scene {
    quantity: "ground",
    needed: "`prepare` must be called with the time step first",
};
