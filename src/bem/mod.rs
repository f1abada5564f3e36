//! The soil under the base: boundary elements, and the trait through which the integrator uses them.
//!
//! # Contact vectors
//!
//! Slices called `traction` and `displacement` have 2Q entries for Q elements. The first Q are the normal components
//! (pressure p, positive in compression; displacement, positive **down**). The other Q are the tangential components
//! (traction τ on the soil and displacement, positive to the right). All are means over the elements, from left to
//! right.
//!
//! A ground [in plan](Ground::in_plan) has three directions. Its vectors have 3Q entries: down, along x (to the right)
//! and along y (away from the reader). In plan, read 3Q for 2Q everywhere. Its elements are rectangles, in any order.

mod elastic_ground;
mod elastic_source;
#[cfg(feature = "full-plane")]
pub mod full_plane;
mod influence;
mod late_exponentials;
pub mod layered;
pub mod plan;
mod shared;
mod spring;
mod static_kernel;
mod strip;
mod strip_impedance;
mod weights_ground;

pub use elastic_ground::ElasticGround;
pub use influence::InfluenceKernel;
pub use shared::SharedKernels;
pub use spring::SpringGround;
pub use static_kernel::PatchKernel;
pub(crate) use static_kernel::StaticKernel;
pub use strip::{Grading, Strip};
pub use weights_ground::WeightsGround;

use std::any::Any;
use std::sync::Arc;

pub use crate::geometry::ContactElement;

use crate::error::{CheckpointError, Error, Observer, Result};
use crate::geometry::{ContactLayout, PLANE, Patch, SPACE};
use crate::history::{ConvolutionWeights, HistoryChoice};
use crate::motion::FreeField;
use crate::soil::Soil;

/// Soil under the base; implement this for a ground of your own.
///
/// A ground returns the mean displacement of every element at the end of a step. It is the sum of the step compliance
/// (a matrix) times the tractions of this step, which are constant over the step, and of the history, the effect of all
/// earlier tractions. Tractions and displacements are **changes** from the static state.
///
/// Every ground is [`Any`], so that [`Simulation::ground`](crate::Simulation::ground) can be downcast to your own type.
#[auto_impl::auto_impl(Box)]
pub trait Ground: Any + Send {
    /// The elements, from left to right, not overlapping.
    ///
    /// In plan these are the elements' sides along x, in any order.
    fn elements(&self) -> &[ContactElement];

    /// Ends along y of an element in plan; `None` (the default) in the plane.
    ///
    /// A ground returns a place for every element or for none.
    ///
    /// In plan elements move in three directions, and forces, moments and energies refer to the whole body, in N, N m
    /// and J.
    fn in_plan(&self, _element: usize) -> Option<PlanElement> {
        None
    }

    /// Prepares for steps of `time_step` seconds, and clears all tractions.
    ///
    /// `steps` is the total number of steps, including the steps so far; `None` if no end is known. Weights are
    /// computed and memory is allocated here. [`build`](crate::coupled::SimulationBuilder::build) calls it, and so does
    /// a run that goes on beyond `steps`: before the first step, or later with [`Ground::save`] before and
    /// [`Ground::restore`] after the call.
    ///
    /// # Errors
    /// If this ground cannot take this time step or number of steps ([`Error::part`](crate::Error::part) makes an error
    /// of a ground of your own); [`Error::Stopped`] by the observer. The ground is then unchanged.
    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()>;

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with end-of-step displacements due to unit tractions.
    ///
    /// The tractions act during the step. If the ground is an energy method, the matrix is symmetric once rows are
    /// multiplied by element lengths; the integrator does not rely on it.
    ///
    /// # Errors
    /// If the ground is not prepared or the slice has the wrong length.
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()>;

    /// Overwrites `displacement` (2Q, m) with the effect of all committed tractions at the end of the next step.
    ///
    /// # Errors
    /// If the history cannot be evaluated.
    fn history(&mut self, displacement: &mut [f64]) -> Result<()>;

    /// Accepts the tractions (2Q, Pa) of the step that ends now.
    fn commit(&mut self, traction: &[f64]);

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with static displacements due to unit tractions.
    ///
    /// A rigid settlement may be added to all of them. The matrix need not be symmetric.
    ///
    /// # Errors
    /// If the slice has the wrong length.
    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()>;

    /// Static compliance of elements cut into halves, or in plan into quarters; `None` by default.
    ///
    /// The matrix is like [`Ground::static_compliance`], with the parts of each element in its place; in plan left
    /// front, right front, left back, right back. `build` uses it to find whether a flexible base needs more elements.
    ///
    /// # Errors
    /// If the matrix cannot be computed.
    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// Soil and history of the ground, for warnings and pages; nothing by default.
    fn description(&self) -> GroundDescription {
        GroundDescription::default()
    }

    /// Upper bound of the error of any element's displacement increment due to past tractions, m.
    ///
    /// Zero (the default) for a ground whose response is exact.
    fn increment_error_bound(&self) -> f64 {
        0.0
    }

    /// Saves the effect of the committed tractions on later steps, for [`Ground::restore`].
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`], unless a ground implements it.
    fn save(&self) -> Result<Vec<f64>> {
        Err(CheckpointError::Unsupported { part: "ground" }.into())
    }

    /// Restores the state in which `steps` steps had been committed and [`Ground::save`] returned `values`.
    ///
    /// All values are finite. The ground is unchanged on an error.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for values that cannot be a checkpoint of this ground,
    /// [`CheckpointError::Unsupported`] unless a ground implements it.
    fn restore(&mut self, _steps: usize, _values: &[f64]) -> Result<()> {
        Err(CheckpointError::Unsupported { part: "ground" }.into())
    }

    /// Overwrites `displacement` (2Q, m) with the soil's motion without structure at `time`.
    ///
    /// Normal components are positive **down**. The default evaluates `motion` at the element midpoints.
    fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]) {
        let layout = ContactLayout::new(directions(self), self.elements().len());
        if layout.components() == SPACE {
            for (e, element) in self.elements().iter().enumerate() {
                let [front, back] = self.in_plan(e).map_or(METRE, |place| place.depth);
                let place = [element.center(), 0.5 * (front + back)];
                let [east, north, up] = motion.displacement_at(place, time);
                for (place, value) in layout.places::<SPACE>(e).into_iter().zip([-up, east, north])
                {
                    displacement[place] = value;
                }
            }
            return;
        }
        let [down, along] = layout.split_mut(displacement);
        for (element, (down, along)) in self.elements().iter().zip(down.iter_mut().zip(along)) {
            let [horizontal, vertical] = motion.displacement(element.center(), time);
            *down = -vertical;
            *along = horizontal;
        }
    }
}

/// Ends of a contact element along y, and the fraction of its area inside the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanElement {
    /// Front and back end of the element along y, m.
    pub depth: [f64; 2],
    /// Fraction of the area inside the outline of the mat, above 0 and at most 1.
    ///
    /// A simulation's pressures, shear tractions and strengths refer to the area inside; a ground's tractions refer to
    /// the whole element.
    pub fraction_inside: f64,
}

/// Soil and history of a ground, for warnings and pages.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GroundDescription {
    /// Speed of shear waves near the surface, m/s, for the resolution of elements; `None` without waves.
    pub shear_wave_speed: Option<f64>,
    /// Soils of the ground; a run warns of an unusual soil:
    /// [`Warning::UnusualSoil`](crate::coupled::Warning::UnusualSoil).
    pub soils: Vec<Soil>,
    /// Number of cells whose passivity is checked, and of all cells; `None` if all are checked.
    ///
    /// If only a sample is checked, a run warns:
    /// [`Warning::SampledPassivity`](crate::coupled::Warning::SampledPassivity).
    pub sampled_cells: Option<[usize; 2]>,
    /// Convolution history; `None` without one.
    pub history: Option<HistoryChoice>,
}

/// Ends along y of an element in the plane, m: it is a metre deep.
const METRE: [f64; 2] = [0.0, 1.0];

/// Number of directions in which the elements of a ground move.
pub(crate) fn directions(ground: &(impl Ground + ?Sized)) -> usize {
    ground.in_plan(0).map_or(PLANE, |_| SPACE)
}

/// Error of a ground before its time step is known.
const NOT_PREPARED: Error = Error::Scene {
    quantity: "ground",
    needed: "`prepare` must be called with the time step first",
};

/// Returns the elements of a ground, or an error if they are not valid.
pub(crate) fn patch(ground: &dyn Ground) -> Result<Patch> {
    let elements = ground.elements().to_vec();
    let places: Vec<_> = (0..elements.len()).map(|element| ground.in_plan(element)).collect();
    if places.windows(2).any(|pair| pair[0].is_some() != pair[1].is_some()) {
        return Err(Error::Scene {
            quantity: "contact elements of the ground",
            needed: "all of them, or none, in plan",
        });
    }
    let depths = places.iter().map(|place| place.map_or(METRE, |place| place.depth)).collect();
    let inside = places.iter().map(|place| place.map_or(1.0, |place| place.fraction_inside));
    Patch::new(directions(ground), elements, depths, inside.collect())
}

/// Soil with convolution weights and a static compliance, as [`WeightsGround`] needs it.
pub trait WeightsSource: Any + Send {
    /// Convolution weights of `elements` (left to right, not overlapping) for steps of `time_step` seconds.
    ///
    /// Compute coefficients when they are requested, not in this call: other grounds may be waiting for the same
    /// kernel.
    ///
    /// # Errors
    /// If the soil has no weights for these elements or this step.
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>>;

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with static displacements due to unit tractions.
    ///
    /// Rows and columns are ordered as the [contact vectors](crate::bem). Displacements are means over the elements; a
    /// rigid settlement may be added to all of them.
    ///
    /// # Errors
    /// If the slice has the wrong length.
    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()>;

    /// Speed of shear waves near the surface, m/s, as in [`GroundDescription`].
    fn shear_wave_speed(&self) -> Option<f64> {
        None
    }

    /// Numbers that identify the soil among its type, so that equal soils share kernels; `None` by default.
    ///
    /// Equal numbers must mean equal bits of all coefficients. With `None`, [`SharedKernels`] shares no kernel of this
    /// soil.
    fn identity(&self) -> Option<Vec<f64>> {
        None
    }
}
