//! The elastic half-plane as a ground.

use std::ops::Range;
use std::sync::Arc;

use super::choice::{HistoryChoice, HistoryOptions, SavedChoice};
use super::patch::check_order;
use super::strip::strips_under;
use super::{
    ContactElement, Grading, Ground, History, PatchKernel, SharedKernels, StaticKernel, Strip,
};
use crate::error::{CheckpointError, Error, Result};
use crate::history::{ConvolutionHistory, ExponentialHistory};
use crate::soil::Soil;
use crate::structure::Structure;

/// Homogeneous elastic half-plane with one or several strips on its surface.
///
/// The soil operator is the energetic space–time Galerkin one: element means of the displacement
/// at step ends under tractions constant over element and step, from the closed-form half-plane
/// kernel. It is passive for every step, mesh and Poisson's ratio, and radiation is exact.
///
/// ```
/// use basemat::{Soil, bem::{Ground, HalfPlaneGround}};
/// let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
/// let mut ground = HalfPlaneGround::strip(soil, -5.0..5.0, 20)?;
/// ground.prepare(1.0e-4)?;
/// let mut matrix = vec![0.0; 40 * 40];
/// ground.instantaneous(&mut matrix)?;
/// // Before waves reach the edges, a pressure moves the surface by p·t/(ρ c₁); a step of 0.1 ms
/// // leaves all but the outer few percent of a half-metre element in that state.
/// let plane_wave = 1.0e-4 / (1900.0 * soil.pressure_wave_speed());
/// assert!((matrix[0] / plane_wave - 1.0).abs() < 0.05);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct HalfPlaneGround {
    soil: Soil,
    elements: Vec<ContactElement>,
    statics: StaticKernel,
    options: HistoryOptions,
    own_history: Option<Box<MakeHistory>>,
    shared: SharedKernels,
    prepared: Option<Prepared>,
}

short_debug! {
    HalfPlaneGround;
    self;
    soil: self.soil,
    elements: self.elements.len(),
    history: self.options,
    prepared: self.prepared.is_some(),
}

/// Makes the history of a patch.
type MakeHistory = dyn Fn(Arc<PatchKernel>) -> Box<dyn ConvolutionHistory> + Send;

/// What a time step brings with it.
struct Prepared {
    kernel: Arc<PatchKernel>,
    /// Left open until the number of steps is known or the first step is made.
    history: Option<Box<dyn ConvolutionHistory>>,
    choice: Option<HistoryChoice>,
}

impl Prepared {
    /// The history, made now if it has not been.
    fn history(
        &mut self,
        options: HistoryOptions,
        steps: Option<usize>,
    ) -> Result<&mut dyn ConvolutionHistory> {
        let history = if let Some(history) = self.history.take() {
            history
        } else {
            let (history, choice) = options.make(&self.kernel, steps)?;
            self.choice = Some(choice);
            history
        };
        Ok(self.history.insert(history).as_mut())
    }
}

impl HalfPlaneGround {
    /// One strip over `range` (m) of `count` equal elements.
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn strip(soil: Soil, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(soil, &[Strip::uniform(range, count)?])
    }

    /// One strip graded towards its edges, where tractions are singular.
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn graded_strip(soil: Soil, range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(soil, &[Strip::new(range, count, Grading::Cosine)?])
    }

    /// Strips of `count` equal elements under each foundation of `structure`, as wide as that is.
    ///
    /// ```
    /// use basemat::{Soil, bem::{Ground, HalfPlaneGround}, structure::RigidBlock};
    /// let block = RigidBlock::new(6.0, 4.0, 2400.0)?;
    /// let ground = HalfPlaneGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 12)?;
    /// assert_eq!((ground.elements()[0].left, ground.elements()[11].right), (-3.0, 3.0));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`HalfPlaneGround::new`] and [`Strip::new`]; [`Error::Size`] or [`Error::Index`] for a
    /// structure without foundations.
    pub fn under(soil: Soil, structure: &dyn Structure, count: usize) -> Result<Self> {
        Self::new(soil, &strips_under(structure, count)?)
    }

    /// Several strips from left to right, which talk through the soil.
    ///
    /// # Errors
    /// [`Error::Size`] for no strips, [`Error::Input`] for strips that overlap or are out of order.
    pub fn new(soil: Soil, strips: &[Strip]) -> Result<Self> {
        let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
        check_order(&elements)?;
        // The logarithm needs a length that fixes the datum; one well above the patch keeps the
        // static matrix positive definite, and the settlement it stands for cancels in all results.
        let span = elements[elements.len() - 1].right - elements[0].left;
        let statics = StaticKernel::new(soil, 10.0 * span)?;
        let options = HistoryOptions::default();
        let shared = SharedKernels::default();
        Ok(Self { soil, elements, statics, options, own_history: None, shared, prepared: None })
    }

    /// With a history of this kind; [`History::Auto`] unless called.
    #[must_use]
    pub fn with_history_kind(mut self, history: History) -> Self {
        (self.options.kind, self.own_history) = (history, None);
        self
    }

    /// Allows a history whose coefficients are within `tolerance` (relative, 1e-12 to 1e-2) of the
    /// exact ones: [`History::Auto`] may then take the exponentials, and [`History::Exponentials`]
    /// takes this tolerance instead of its own.
    ///
    /// # Errors
    /// [`Error::Input`] for a tolerance outside this range.
    pub fn with_history_tolerance(mut self, tolerance: f64) -> Result<Self> {
        self.options.tolerance = Some(ExponentialHistory::check_tolerance(tolerance)?);
        Ok(self)
    }

    /// With a limit (bytes) on the memory of the history that [`History::Auto`] chooses; 1 GiB
    /// unless called. It goes by [`Ground::reserve`] (of a simulation,
    /// [`expected_steps`](crate::coupled::SimulationBuilder::expected_steps) or the steps of the
    /// first run), and is no limit where the number of steps is not known.
    #[must_use]
    pub fn with_history_memory(mut self, bytes: usize) -> Self {
        self.options.memory = bytes;
        self
    }

    /// With a history of one's own: `make` is called with the patch's coefficients once the time
    /// step is known.
    #[must_use]
    pub fn with_history(
        mut self,
        make: impl Fn(Arc<PatchKernel>) -> Box<dyn ConvolutionHistory> + Send + 'static,
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

    /// The soil.
    pub fn soil(&self) -> Soil {
        self.soil
    }

    /// Before the first step, with a history where none is to be chosen.
    fn begin(&self, kernel: Arc<PatchKernel>) -> Result<Prepared> {
        let history = self.own_history.as_ref().map(|make| make(Arc::clone(&kernel)));
        let mut prepared = Prepared { kernel, history, choice: None };
        if self.options.kind != History::Auto {
            prepared.history(self.options, None)?;
        }
        Ok(prepared)
    }
}

impl Ground for HalfPlaneGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        let kernel = self.shared.kernel(self.soil, &self.elements, time_step)?;
        self.prepared = Some(self.begin(kernel)?);
        Ok(())
    }

    fn reserve(&mut self, steps: usize) -> Result<()> {
        match &mut self.prepared {
            Some(prepared) => prepared.history(self.options, Some(steps))?.reserve(steps),
            None => Err(NOT_PREPARED),
        }
    }

    fn instantaneous(&self, matrix: &mut [f64]) -> Result<()> {
        match &self.prepared {
            Some(prepared) => prepared.kernel.instantaneous(matrix),
            None => Err(NOT_PREPARED),
        }
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        match &mut self.prepared {
            Some(prepared) => prepared.history(self.options, None)?.evaluate(displacement),
            None => Err(NOT_PREPARED),
        }
    }

    fn commit(&mut self, traction: &[f64]) {
        let Some(prepared) = &mut self.prepared else { return };
        // Where Auto has nothing to go by, it takes a history that can always be made.
        if let Ok(history) = prepared.history(self.options, None) {
            history.push(traction);
        }
    }

    fn shear_wave_speed(&self) -> Option<f64> {
        Some(self.soil.shear_wave_speed())
    }

    fn history_choice(&self) -> Option<HistoryChoice> {
        self.prepared.as_ref()?.choice
    }

    fn increment_error_bound(&self) -> f64 {
        let history = self.prepared.as_ref().and_then(|prepared| prepared.history.as_ref());
        history.map_or(0.0, ConvolutionHistory::increment_error_bound)
    }

    /// Which history was chosen for how many steps, and what it says.
    fn save(&self) -> Result<Vec<f64>> {
        let prepared = self.prepared.as_ref().ok_or(NOT_PREPARED)?;
        let mut values = SavedChoice::new(prepared.choice).numbers().to_vec();
        if let Some(history) = &prepared.history {
            values.extend(history.save()?);
        }
        Ok(values)
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let prepared = self.prepared.as_mut().ok_or(NOT_PREPARED)?;
        let (saved, values) = SavedChoice::read(values)?;
        let own = SavedChoice::new(prepared.choice);
        let other = CheckpointError::OtherScene { quantity: "kind of history" };
        if let Some(history) = prepared.history.as_mut().filter(|_| own == saved) {
            return history.restore(steps, values);
        }
        if saved.kind == History::Auto {
            // Nothing had been chosen yet, so that it is still to be.
            if self.own_history.is_some() || steps > 0 || !values.is_empty() {
                return Err(other.into());
            }
            let kernel = Arc::clone(&prepared.kernel);
            self.prepared = Some(self.begin(kernel)?);
            return Ok(());
        }
        if prepared.history.is_some() && own.kind != saved.kind {
            return Err(other.into());
        }
        // What was chosen then is chosen again, and taken once it has the values.
        let (mut history, choice) = self.options.make(&prepared.kernel, saved.steps)?;
        if choice.kind != saved.kind {
            return Err(other.into());
        }
        history.restore(steps, values)?;
        (prepared.history, prepared.choice) = (Some(history), Some(choice));
        Ok(())
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.statics.compliance(&self.elements, matrix)
    }
}

const NOT_PREPARED: Error = Error::Scene {
    quantity: "half-plane ground",
    needed: "`prepare` must be called with the time step first",
};
