//! The soil under the base: patches of boundary elements and what the integrator needs of them.
//!
//! # Contact vectors
//!
//! Slices called `traction` and `displacement` have 2Q entries for Q elements: first the Q normal
//! components (pressure p, positive in compression, and displacement **down**), then the Q
//! tangential ones (traction τ on the soil and displacement, positive to the right). They are
//! means over the elements, from left to right.
//!
//! A ground in plan has three [directions](Ground::directions): its vectors have 3Q entries, down, along x (to the
//! right) and along y (away from the reader). Its elements are rectangles, in any order.

mod elastic_ground;
mod elastic_source;
#[cfg(feature = "full-plane")]
pub mod full_plane;
mod influence;
mod late_exponentials;
pub mod layered;
pub mod plan;
mod prepared;
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

/// A soil as the time integrator sees it: implement this for a ground of your own.
///
/// A ground responds with the mean displacement of every element at the end of a step, as the sum
/// of a part by the step compliance (a matrix times the tractions of this step, which are constant over
/// the step) and a history part (all earlier tractions). Tractions here are **changes** against
/// the static state, and so are displacements.
///
/// Every ground is [`Any`], so that [`Simulation::ground`](crate::Simulation::ground) leads back to
/// your own type, and what it has found or kept.
#[auto_impl::auto_impl(Box)]
pub trait Ground: Any + Send {
    /// The elements, from left to right, not overlapping; of a ground in plan their sides along x, in any order.
    fn elements(&self) -> &[ContactElement];

    /// Directions in which elements move: two in the plane (the default), three in plan. Forces, moments and energies
    /// are then those of the whole body, in N, N m and J.
    fn directions(&self) -> usize {
        PLANE
    }

    /// Front and back end of an element along y, m, for a ground in plan. The default is a metre, as in the plane.
    fn depth(&self, _element: usize) -> [f64; 2] {
        [0.0, 1.0]
    }

    /// Part of an element's area that is inside the outline of the mat, above 0 and at most 1 (the default): pressures,
    /// shear tractions and strengths of a simulation refer to it. Tractions of a ground are those of the whole element.
    fn fraction_inside(&self, _element: usize) -> f64 {
        1.0
    }

    /// Prepares for steps of `time_step` seconds and forgets all tractions. Called once, first.
    ///
    /// # Errors
    /// If this ground cannot march with this step; [`Error::part`](crate::Error::part) makes an
    /// error of a ground of your own.
    fn prepare(&mut self, time_step: f64) -> Result<()>;

    /// Hint that up to `steps` steps will have been made in all, those so far included; zero if that is not known.
    /// Results do not depend on it, but for rounding where it decides how the history is computed.
    ///
    /// What depends on the number of steps is chosen, and memory reserved for them; not for more than 100 000 steps to
    /// come, as a run without end may be stopped long before. With an `observer` the convolution weights of all `steps`
    /// are computed first, those of the first step if `steps` is zero. The default does nothing.
    ///
    /// # Errors
    /// [`Error::Stopped`] by the observer, and the ground is as it was; as for
    /// [`Ground::history`].
    fn expect_steps(&mut self, _steps: usize, _observer: Option<&mut Observer<'_>>) -> Result<()> {
        Ok(())
    }

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with the displacement at the end of a step
    /// due to unit tractions during it. Symmetric when rows are weighted by element lengths if
    /// the ground is an energy method; nothing here relies on it.
    ///
    /// # Errors
    /// If the ground is not prepared or the slice has the wrong length.
    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()>;

    /// Overwrites `displacement` (2Q, m) with what all committed tractions give at the end of the
    /// next step.
    ///
    /// # Errors
    /// If the history cannot be evaluated.
    fn history(&mut self, displacement: &mut [f64]) -> Result<()>;

    /// Accepts the tractions (Pa) of the step that ends now; the caller gives all 2Q.
    fn commit(&mut self, traction: &[f64]);

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with the static displacement due to unit
    /// tractions, up to a rigid settlement. Symmetric in the same sense, or not.
    ///
    /// # Errors
    /// If the slice has the wrong length.
    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()>;

    /// Static compliance, as [`Ground::static_compliance`], of the two halves of each element in its place; in plan of
    /// its four quarters: left front, right front, left back, right back. `None` (the default) if it is not known: by
    /// it `build` finds whether a flexible base needs more elements.
    ///
    /// # Errors
    /// If it cannot be computed.
    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// Speed of shear waves in the soil, m/s, which decides what elements resolve; `None` (the default) for
    /// a ground without waves.
    fn shear_wave_speed(&self) -> Option<f64> {
        None
    }

    /// The soils that it is made of; none (the default) if there are none to be named. A run warns of
    /// one that is unlike any: [`Warning::UnusualSoil`](crate::coupled::Warning::UnusualSoil).
    fn soils(&self) -> Vec<Soil> {
        Vec::new()
    }

    /// Numbers of cells in the sample whose passivity is checked, and of all; `None` (the default) if all are checked.
    /// A run warns: [`Warning::SampledPassivity`](crate::coupled::Warning::SampledPassivity).
    fn sampled_cells(&self) -> Option<[usize; 2]> {
        None
    }

    /// History that the ground keeps, and why; `None` (the default) if there is nothing to choose.
    fn history_choice(&self) -> Option<HistoryChoice> {
        None
    }

    /// Upper bound of the error of any element's displacement increment due to past tractions, m.
    ///
    /// Zero (the default) for a ground whose response is exact.
    fn increment_error_bound(&self) -> f64 {
        0.0
    }

    /// All that the committed tractions have left behind, for [`Ground::restore`].
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`], unless a ground implements it.
    fn save(&self) -> Result<Vec<f64>> {
        Err(CheckpointError::Unsupported { part: "ground" }.into())
    }

    /// Goes to where `steps` steps had been committed and [`Ground::save`] returned
    /// `values`, all finite. Unchanged on an error.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for values that cannot be a checkpoint of this ground,
    /// [`CheckpointError::Unsupported`] unless a ground implements it.
    fn restore(&mut self, _steps: usize, _values: &[f64]) -> Result<()> {
        Err(CheckpointError::Unsupported { part: "ground" }.into())
    }

    /// Overwrites `displacement` (2Q or 3Q, m; normal components **down**) with the motion of the soil
    /// without structure at `time`. The default samples `motion` at the element midpoints.
    fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]) {
        let layout = ContactLayout::new(self.directions(), self.elements().len());
        if layout.components() == SPACE {
            for (e, element) in self.elements().iter().enumerate() {
                let [front, back] = self.depth(e);
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

/// Error of a ground before its time step is known.
const NOT_PREPARED: Error = Error::Scene {
    quantity: "ground",
    needed: "`prepare` must be called with the time step first",
};

/// The elements of a ground, checked.
pub(crate) fn patch(ground: &dyn Ground) -> Result<Patch> {
    let elements = ground.elements().to_vec();
    let depths = (0..elements.len()).map(|element| ground.depth(element)).collect();
    let inside = (0..elements.len()).map(|element| ground.fraction_inside(element)).collect();
    Patch::new(ground.directions(), elements, depths, inside)
}

/// A soil that has convolution weights and a static compliance: all that
/// [`WeightsGround`] needs.
pub trait WeightsSource: Any + Send {
    /// The coefficients under `elements` (left to right, not overlapping) for steps of `time_step`
    /// seconds. They should be computed when coefficients are called for, not now: other grounds may be
    /// waiting for the same kernel.
    ///
    /// # Errors
    /// If the soil has none for these elements or this step.
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>>;

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa; 2Q numbers as in the module) with the
    /// mean static displacements of the elements due to unit tractions, up to a rigid settlement.
    ///
    /// # Errors
    /// If the slice has the wrong length.
    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()>;

    /// Speed of shear waves near the surface, m/s, as [`Ground::shear_wave_speed`].
    fn shear_wave_speed(&self) -> Option<f64> {
        None
    }

    /// Numbers that say which soil of its type it is, so that equal ones can share kernels
    /// ([`SharedKernels`]): equal numbers must mean equal bits of all
    /// coefficients. `None` (the default) if kernels are not to be shared.
    fn identity(&self) -> Option<Vec<f64>> {
        None
    }
}
