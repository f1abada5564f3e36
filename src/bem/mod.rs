//! The soil under the base: patches of boundary elements and what the integrator needs of them.
//!
//! # Contact vectors
//!
//! Slices called `traction` and `displacement` have 2Q entries for Q elements: first the Q normal
//! components (pressure p, positive in compression, and displacement **down**), then the Q
//! tangential ones (traction τ on the soil and displacement, positive to the right). They are
//! means over the elements, from left to right.
//!
//! A ground [in plan](Ground::in_plan) has three directions: its vectors have 3Q entries, down, along x (to the
//! right) and along y (away from the reader). Its elements are rectangles, in any order.

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

    /// Place of an element in plan, of every element or of none; `None` (the default) in the plane.
    ///
    /// In plan elements move in three directions; forces, moments and energies are those of the whole body, in N, N m
    /// and J.
    fn in_plan(&self, _element: usize) -> Option<PlanElement> {
        None
    }

    /// Prepares for steps of `time_step` seconds, and clears all tractions.
    ///
    /// `steps` is the number of steps in all, those so far included; `None` if no end is known. Weights are computed
    /// and memory is allocated here. [`build`](crate::coupled::SimulationBuilder::build) calls it, and so does a run that
    /// goes on beyond `steps`: before the first step, or with [`Ground::save`] before and [`Ground::restore`] after it.
    ///
    /// # Errors
    /// If this ground cannot march with this step ([`Error::part`](crate::Error::part) makes an error of a ground of
    /// your own) or so many steps; [`Error::Stopped`] by the observer. The ground is then as it was.
    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()>;

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

/// Place of a contact element in plan: its ends along y, and its part inside the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanElement {
    /// Front and back end along y, m.
    pub depth: [f64; 2],
    /// Part of the area inside the outline of the mat, above 0 and at most 1.
    ///
    /// Pressures, shear tractions and strengths of a simulation refer to it; tractions of a ground are those of the
    /// whole element.
    pub fraction_inside: f64,
}

/// Soil and history of a ground.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GroundDescription {
    /// Speed of shear waves near the surface, m/s, for the resolution of elements; `None` without waves.
    pub shear_wave_speed: Option<f64>,
    /// Soils of the ground; a run warns of an unusual one:
    /// [`Warning::UnusualSoil`](crate::coupled::Warning::UnusualSoil).
    pub soils: Vec<Soil>,
    /// Numbers of cells in the sample whose passivity is checked, and of all; `None` if all are checked.
    ///
    /// A run warns of a sample: [`Warning::SampledPassivity`](crate::coupled::Warning::SampledPassivity).
    pub sampled_cells: Option<[usize; 2]>,
    /// Convolution history; `None` without one.
    pub history: Option<HistoryChoice>,
}

/// Ends along y of an element in the plane, m: a metre of depth.
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

/// The elements of a ground, checked.
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

    /// Speed of shear waves near the surface, m/s, as in [`GroundDescription`].
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
