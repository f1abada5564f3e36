//! The elastic half-plane as a ground.

use std::ops::Range;
use std::sync::Arc;

use super::patch::check_order;
use super::{ContactElement, Grading, Ground, History, PatchKernel, StaticKernel, Strip};
use crate::error::{Error, Result};
use crate::history::ConvolutionHistory;
use crate::soil::Soil;

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
    make_history: Box<MakeHistory>,
    prepared: Option<Prepared>,
}

/// Makes the history of a patch.
type MakeHistory = dyn Fn(Arc<PatchKernel>) -> Box<dyn ConvolutionHistory> + Send;

/// What a time step brings with it.
struct Prepared {
    kernel: Arc<PatchKernel>,
    history: Box<dyn ConvolutionHistory>,
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
        let statics = StaticKernel::new(&soil, 10.0 * span)?;
        let make_history = Box::new(|kernel| History::default().make(kernel));
        Ok(Self { soil, elements, statics, make_history, prepared: None })
    }

    /// With a history of this kind; [`History::Auto`] unless called.
    #[must_use]
    pub fn with_history_kind(mut self, history: History) -> Self {
        self.make_history = Box::new(move |kernel| history.make(kernel));
        self
    }

    /// With a history of one's own: `make` is called with the patch's coefficients once the time
    /// step is known.
    #[must_use]
    pub fn with_history(
        mut self,
        make: impl Fn(Arc<PatchKernel>) -> Box<dyn ConvolutionHistory> + Send + 'static,
    ) -> Self {
        self.make_history = Box::new(make);
        self
    }

    /// The soil.
    pub fn soil(&self) -> &Soil {
        &self.soil
    }
}

impl Ground for HalfPlaneGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, time_step: f64) -> Result<()> {
        let kernel = Arc::new(PatchKernel::new(self.soil, self.elements.clone(), time_step)?);
        let history = (self.make_history)(Arc::clone(&kernel));
        self.prepared = Some(Prepared { kernel, history });
        Ok(())
    }

    fn reserve(&mut self, steps: usize) -> Result<()> {
        match &mut self.prepared {
            Some(prepared) => prepared.history.reserve(steps),
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
            Some(prepared) => prepared.history.evaluate(displacement),
            None => Err(NOT_PREPARED),
        }
    }

    fn commit(&mut self, traction: &[f64]) {
        if let Some(prepared) = &mut self.prepared {
            prepared.history.push(traction);
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.statics.compliance(&self.elements, matrix)
    }
}

const NOT_PREPARED: Error = Error::Scene {
    quantity: "half-plane ground",
    needed: "`prepare` must be called with the time step first",
};
