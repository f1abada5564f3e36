//! Grounds that are determined by convolution weights.

use std::sync::Arc;

use super::plan::{STEP_END_SPRING_RATIO, Unions};
use super::{Ground, GroundDescription, NOT_PREPARED, SharedKernels, WeightsSource};
use crate::error::{CheckpointError, Observer, Result};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_order};
use crate::history::{ChosenHistory, ConvolutionHistory, ConvolutionWeights, HistoryOptions};

/// Ground for any soil that has convolution weights and a static compliance.
///
/// [`ElasticGround`](super::ElasticGround) is based on it. A user's soil is a [`WeightsSource`] with its
/// [`ConvolutionWeights`]. All methods of history, their choice, shared kernels and checkpoints then need no more code.
///
/// The example is a bed of independent Kelvin–Voigt springs, integrated exactly. A unit pressure during one step
/// causes the settlement (1 − z)/k with z = exp(−k Δt/c). In each later step this settlement decreases by the factor z.
///
/// ```
/// use std::sync::Arc;
///
/// use basemat::bem::{ContactElement, WeightsGround, WeightsSource, Strip};
/// use basemat::history::{ConvolutionWeights, PairClasses, by_kind};
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
///         values: &mut [&mut [f64]],
///     ) -> Result<()> {
///         let [normal, tangential, coupling] = by_kind(values)?;
///         let Bed { stiffness, dashpots } = self.bed;
///         let rate = stiffness * self.time_step / dashpots;
///         let [source, receiver] = self.classes.representative(class)?;
///         // Integrals over the receiver; only the loaded element is displaced.
///         let step_settlement = if source == receiver {
///             receiver.length() * -(-rate).exp_m1() / stiffness
///         } else {
///             0.0
///         };
///         for (i, value) in normal.iter_mut().enumerate() {
///             *value = step_settlement * (-rate * (first_lag - 1 + i) as f64).exp();
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
    /// Relation of contact elements in plan to cells; `None` if each cell is one element.
    unions: Option<Unions>,
    options: HistoryOptions,
    /// Function that creates the user's history; `None` for a history according to `options`.
    custom_history: Option<Box<MakeHistory>>,
    shared_kernels: SharedKernels,
    prepared_history: Option<PreparedHistory>,
}

short_debug! {
    WeightsGround;
    self;
    elements: self.elements.len(),
    history: self.options,
    prepared: self.prepared_history.is_some(),
}

/// Weights and history for one time step.
struct PreparedHistory {
    time_step: f64,
    weights: Arc<dyn ConvolutionWeights>,
    chosen_history: ChosenHistory,
}

/// Function that creates the history of convolution weights.
type MakeHistory = dyn Fn(Arc<dyn ConvolutionWeights>) -> Box<dyn ConvolutionHistory> + Send;

impl WeightsGround {
    /// Ground of `source` under `elements`, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no elements, [`Error::Input`](crate::Error::Input) for elements that
    /// overlap, are out of order or have no length, [`Error::Memory`](crate::Error::Memory) for more elements than
    /// their matrices allow.
    pub fn new(source: impl WeightsSource, elements: Vec<ContactElement>) -> Result<Self> {
        check_order(&elements)?;
        Ok(Self::with_unions(source, elements, None))
    }

    /// Ground of `source` under elements, some of them unions of cells.
    pub(super) fn with_unions(
        source: impl WeightsSource,
        elements: Vec<ContactElement>,
        unions: Option<Unions>,
    ) -> Self {
        Self {
            source: Box::new(source),
            elements,
            unions,
            options: HistoryOptions::default(),
            custom_history: None,
            shared_kernels: SharedKernels::default(),
            prepared_history: None,
        }
    }

    /// Sets the options of the ground's history, or its method alone.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tolerance outside 1e-12 to 1e-2.
    pub fn with_history(mut self, options: impl Into<HistoryOptions>) -> Result<Self> {
        self.options = options.into().checked()?;
        self.custom_history = None;
        Ok(self)
    }

    /// Sets a user's history.
    ///
    /// `make_history` is called with the convolution weights in each preparation, when the time step is known.
    #[must_use]
    pub fn with_own_history(
        mut self,
        make_history: impl Fn(Arc<dyn ConvolutionWeights>) -> Box<dyn ConvolutionHistory>
        + Send
        + 'static,
    ) -> Self {
        self.custom_history = Some(Box::new(make_history));
        self
    }

    /// Uses convolution weights from a store shared with other grounds.
    ///
    /// A sweep then computes weights that several cases have in common only once.
    #[must_use]
    pub fn with_shared_kernels(mut self, kernels: &SharedKernels) -> Self {
        self.shared_kernels = kernels.clone();
        self
    }

    /// Replaces the source of convolution weights.
    pub(super) fn with_source(self, source: impl WeightsSource) -> Self {
        Self { source: Box::new(source), prepared_history: None, ..self }
    }

    /// Empty history of `weights` for `steps` steps; `steps` is `None` if their number is unknown.
    fn empty_history(
        &self,
        weights: &Arc<dyn ConvolutionWeights>,
        steps: Option<usize>,
    ) -> Result<ChosenHistory> {
        match &self.custom_history {
            Some(make_history) => Ok(ChosenHistory::supplied(make_history(Arc::clone(weights)))),
            None => self.options.history(weights, steps),
        }
    }
}

impl Ground for WeightsGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()> {
        let weights = match &self.prepared_history {
            Some(prepared_history) if prepared_history.time_step == time_step => {
                Arc::clone(&prepared_history.weights)
            }
            _ => self.shared_kernels.kernel(&*self.source, &self.elements, time_step)?,
        };
        let mut chosen_history = self.empty_history(&weights, steps)?;
        match steps {
            Some(steps) => chosen_history.history.prepare(steps, observer)?,
            // The step compliance depends on the first lag only.
            None => weights.prepare(1, observer)?,
        }
        self.prepared_history = Some(PreparedHistory { time_step, weights, chosen_history });
        if let Some(unions) = &mut self.unions {
            unions.last_traction.fill(0.0);
        }
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let Some(PreparedHistory { weights, .. }) = &self.prepared_history else {
            return Err(NOT_PREPARED);
        };
        match &self.unions {
            Some(unions) => unions.reduce(matrix, STEP_END_SPRING_RATIO, |cell_matrix| {
                weights.step_compliance(cell_matrix)
            }),
            None => weights.step_compliance(matrix),
        }
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let Some(PreparedHistory { chosen_history, .. }) = &mut self.prepared_history else {
            return Err(NOT_PREPARED);
        };
        match &mut self.unions {
            Some(unions) => unions.gather(displacement, |cell_displacement| {
                chosen_history.history.evaluate(cell_displacement)
            }),
            None => chosen_history.history.evaluate(displacement),
        }
    }

    fn commit(&mut self, traction: &[f64]) {
        let Some(PreparedHistory { chosen_history, .. }) = &mut self.prepared_history else {
            return;
        };
        let cell_traction = self.unions.as_mut().map_or(traction, |unions| unions.spread(traction));
        chosen_history.history.push(cell_traction);
    }

    fn description(&self) -> GroundDescription {
        let prepared_history = self.prepared_history.as_ref();
        GroundDescription {
            shear_wave_speed: self.source.shear_wave_speed(),
            history: prepared_history.and_then(|prepared| prepared.chosen_history.choice()),
            ..Default::default()
        }
    }

    fn increment_error_bound(&self) -> f64 {
        let prepared_history = self.prepared_history.as_ref();
        prepared_history
            .map_or(0.0, |prepared| prepared.chosen_history.history.increment_error_bound())
    }

    fn save(&self) -> Result<Vec<f64>> {
        let history_values =
            self.prepared_history.as_ref().ok_or(NOT_PREPARED)?.chosen_history.save()?;
        let last_traction = self.unions.as_ref().map_or(&[][..], |unions| &unions.last_traction);
        Ok([&history_values[..], last_traction].concat())
    }

    /// Restores a history of the same kind.
    ///
    /// The checkpoint of a history by exponentials may be from a fit for another horizon (number of steps). The
    /// exponentials are then first fitted again for that horizon.
    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let prepared_history = self.prepared_history.as_mut().ok_or(NOT_PREPARED)?;
        let last_traction =
            self.unions.as_mut().map_or(&mut [][..], |unions| &mut unions.last_traction);
        let history_length = values.len().saturating_sub(last_traction.len());
        let history_values = &values[..history_length];
        if let Some(horizon) = prepared_history.chosen_history.restore(steps, history_values)? {
            let mut refitted_history =
                self.options.history(&prepared_history.weights, Some(horizon))?;
            if refitted_history.restore(steps, history_values)?.is_some() {
                return Err(CheckpointError::OtherScene { quantity: "kind of history" }.into());
            }
            prepared_history.chosen_history = refitted_history;
        }
        last_traction.copy_from_slice(&values[history_length..]);
        Ok(())
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let elements = &self.elements;
        match &self.unions {
            Some(unions) => unions.reduce(matrix, 1.0, |cell_matrix| {
                self.source.static_compliance(elements, cell_matrix)
            }),
            None => self.source.static_compliance(elements, matrix),
        }
    }

    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        let halves: Vec<_> = self.elements.iter().flat_map(ContactElement::parts).collect();
        let mut matrix = vec![0.0; (COMPONENTS_IN_PLANE * halves.len()).pow(2)];
        self.source.static_compliance(&halves, &mut matrix)?;
        Ok(Some(matrix))
    }
}
