//! Ground under the base: boundary elements, and the trait through which the integrator uses them.
//!
//! # Contact vectors
//!
//! Slices called `traction` and `displacement` have 2Q entries for Q elements. The first Q are the normal components
//! (pressure p, positive in compression; displacement, positive **down**). The other Q are the tangential components
//! (traction τ on the soil and displacement, positive to the right). All are means over the elements, from left to
//! right.
//!
//! A ground in plan has three directions. Its vectors have 3Q entries: down, along x (to the right) and along y (away
//! from the reader). In plan, read 3Q for 2Q everywhere. Its elements are rectangles ([`ContactElement::in_plan`]), in
//! any order.

/// Implements the methods of a [`Ground`] that a wrapper of a [`WeightsGround`] does not change.
macro_rules! forward_weights_ground {
    ($wrapper:ident.$ground:ident) => {
        forward! {
            $wrapper.$ground;
            fn elements(&$wrapper) -> &[$crate::bem::ContactElement];
            fn step_compliance(&$wrapper, matrix: &mut [f64]) -> $crate::error::Result<()>;
            fn history(&mut $wrapper, displacement: &mut [f64]) -> $crate::error::Result<()>;
            fn commit(&mut $wrapper, traction: &[f64]);
            fn static_compliance(&$wrapper, matrix: &mut [f64]) -> $crate::error::Result<()>;
            fn increment_error_bound(&$wrapper) -> f64;
            fn save(&$wrapper) -> $crate::error::Result<Vec<f64>>;
            fn restore(&mut $wrapper, steps: usize, values: &[f64]) -> $crate::error::Result<()>;
            fn free_field(
                &$wrapper,
                motion: &dyn $crate::motion::FreeField,
                time: f64,
                displacement: &mut [f64]
            );
        }
    };
}

mod elastic_ground;
mod elastic_source;
#[cfg(feature = "embedded")]
pub mod embedded;
#[cfg(feature = "full-plane")]
pub mod full_plane;
mod influence;
mod late_exponentials;
pub mod layered;
mod patch_kernel;
pub mod plan;
mod shared;
mod spring;
mod static_kernel;
mod strip;
mod strip_impedance;
mod weights_ground;

#[doc(inline)]
pub use crate::error::{GroundError, PlanError};
pub use elastic_ground::ElasticGround;
pub use influence::InfluenceKernel;
pub use patch_kernel::PatchKernel;
pub use shared::SharedKernels;
pub use spring::SpringGround;
pub(crate) use static_kernel::StaticKernel;
pub use strip::{Grading, Strip};
pub use weights_ground::WeightsGround;

use std::any::Any;
use std::sync::Arc;

#[doc(inline)]
pub use crate::geometry::ContactElement;

use crate::error::{CheckpointError, Error, Observer, Result};
use crate::geometry::Patch;
use crate::history::{ConvolutionWeights, HistoryChoice};
use crate::motion::FreeField;
use crate::soil::{Soil, WaterTable};

/// Ground under the base; implement this trait for your ground.
///
/// A ground returns the mean displacement of every element at the end of a step. It is the sum of the step compliance
/// (a matrix) times the tractions of this step, which are constant over the step, and of the history, the effect of all
/// earlier tractions. Tractions and displacements are **changes** from the static state.
///
/// # Elastic parts in the mid-step form
///
/// The traction τ of a step, constant over it, is the traction in the **middle** of the step. A spring of stiffness k
/// (Pa/m) therefore has the mean displacement (s₀ + s₁)/2 = τ/k, and at the end of the step
///
/// ```math
/// s_1 = \frac{2}{k}\, \tau - s_0 :
/// ```
///
/// its step compliance is 2/k, twice the static one, and its history −s₀. With s₁ = τ/k and no history each step would
/// dissipate (Δτ)²/2k without any damping: the response would converge at first order, and the loss would count as
/// radiated by the soil. A spring with a dashpot c in parallel has the step compliance 1/(k/2 + c/Δt) and the history
/// (c/Δt − k/2)/(c/Δt + k/2) s₀. [`SpringGround::of_elements`] creates a bed of such springs, which can be a part of your
/// ground. For parts without stiffness (dashpots, waves, creep), use the exact displacement under a constant traction.
///
/// A run warns of an elastic part with s₁ = τ/k:
/// [`Mistake::FirstOrderGround`](crate::coupled::Mistake::FirstOrderGround). For this check `build` prepares a user's
/// ground without waves for a step 64 times shorter, and may commit a traction. It then prepares the ground again.
///
/// Every ground is [`Any`], so that [`Simulation::ground`](crate::Simulation::ground) can be downcast to your own type.
#[auto_impl::auto_impl(Box)]
pub trait Ground: Any + Send {
    /// The elements, which do not overlap: from left to right in the plane, in any order in plan.
    ///
    /// Elements with walls are in the order of the outline: down the left wall, along the base, up the right wall.
    ///
    /// All elements are in the plane, or all are [in plan](ContactElement::in_plan). Elements in plan have displacements
    /// in three directions, and forces, moments and energies refer to the whole body, in N, N m and J.
    fn elements(&self) -> &[ContactElement];

    /// Prepares for steps of `time_step` seconds, and clears all tractions.
    ///
    /// `steps` is the total number of steps, including the committed steps; `None` if it is unknown. The method
    /// computes weights and allocates memory. [`build`](crate::coupled::SimulationBuilder::build) calls it before the
    /// first step. A run beyond `steps` calls it again, with [`Ground::save`] before and [`Ground::restore`] after the
    /// call.
    ///
    /// # Errors
    /// If this ground does not support this time step or number of steps ([`Error::part`](crate::Error::part) creates an
    /// error of a user's ground); [`Error::Stopped`] by the observer. The ground is then unchanged.
    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()>;

    /// Overwrites `matrix` (2Q × 2Q, row-major, m/Pa) with end-of-step displacements due to unit tractions.
    ///
    /// The tractions act during the step. For an energy method, the matrix with its rows multiplied by the element lengths
    /// is symmetric. The integrator does not require this symmetry.
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

    /// Diagonals of step and static compliance, if all other entries are zero; `None` by default.
    ///
    /// Return them only if a traction displaces only the element on which it acts, in the direction in which it acts. Under
    /// a base of few rigid bodies, a run on many such elements in plan then needs no full matrices: a bed of 64 × 64 cells
    /// needs tens of megabytes instead of gigabytes. A run on all other grounds and bases uses the full matrices.
    ///
    /// # Errors
    /// If the ground is not prepared.
    fn diagonal_compliance(&self) -> Result<Option<DiagonalCompliance>> {
        Ok(None)
    }

    /// Static compliance of elements divided into halves, or in plan into quarters; `None` by default.
    ///
    /// The matrix is like [`Ground::static_compliance`], with the parts of each element in place of the element. In plan
    /// their order is left front, right front, left back, right back. `build` uses the matrix to check whether a
    /// flexible base needs more elements.
    ///
    /// # Errors
    /// If the matrix cannot be computed.
    fn finer_compliance(&self) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// Soil and history of the ground, for warnings and pages; nothing by default.
    ///
    /// `build` uses all fields but the history from calls before [`Ground::prepare`].
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
    /// Normal components are positive **down**. The default evaluates `motion` at the element midpoints. A run on a ground
    /// with walls uses [`FreeField::at_faces`] instead.
    fn free_field(&self, motion: &dyn FreeField, time: f64, displacement: &mut [f64]) {
        let element_count = self.elements().len();
        for (e, element) in self.elements().iter().enumerate() {
            let center = element.center();
            let surface_motion = motion.displacement_at([center[0], center[1]], time);
            let components = displacement.iter_mut().skip(e).step_by(element_count);
            for (component, surface_component) in components.zip(element.components(surface_motion))
            {
                *component = surface_component;
            }
        }
    }
}

/// Overwrites free-field displacements (2Q, m) and, with walls, impulses (2Q, Pa s).
///
/// Calls [`FreeField::at_faces`] for elements with walls and [`Ground::free_field`] for all others. Returns whether
/// `motion` is defined at all elements.
pub(crate) fn fill_free_field(
    ground: &dyn Ground,
    motion: &dyn FreeField,
    elements: &Patch,
    time: f64,
    displacement: &mut [f64],
    impulse: &mut [f64],
) -> bool {
    if elements.has_walls() {
        return motion.at_faces(elements, time, displacement, impulse);
    }
    ground.free_field(motion, time, displacement);
    true
}

/// Diagonal compliances of a ground with independent elements: [`Ground::diagonal_compliance`].
#[derive(Debug, Clone, PartialEq)]
pub struct DiagonalCompliance {
    /// Diagonal of [`Ground::step_compliance`], 2Q, m/Pa.
    pub in_step: Vec<f64>,
    /// Diagonal of [`Ground::static_compliance`], 2Q, m/Pa.
    pub at_rest: Vec<f64>,
}

/// Soil and history of a ground, for warnings and pages.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GroundDescription {
    /// Speed of shear waves near the surface, m/s, for the resolution of elements; `None` without waves.
    pub shear_wave_speed: Option<f64>,
    /// Soils of the ground; a run warns of an unusual soil:
    /// [`Mistake::UnusualSoil`](crate::coupled::Mistake::UnusualSoil).
    pub soils: Vec<Soil>,
    /// Number of cells with a passivity check, and number of all cells; `None` if all cells are checked.
    ///
    /// A run warns if only a sample is checked:
    /// [`Warning::SampledPassivity`](crate::coupled::Warning::SampledPassivity).
    pub sampled_cells: Option<[usize; 2]>,
    /// Soil pressure at rest on each element, divided by gravity, kg/m²; empty for a ground without walls.
    ///
    /// The pressure acts on the walls of an embedded structure before the run. Pressures below the structure's base act
    /// with [`GravityStage::WishedInPlace`](crate::coupled::GravityStage::WishedInPlace) only. Walls have no pressure at
    /// rest if this list is empty.
    pub pressure_at_rest: Vec<f64>,
    /// Depth of the pressure's resultant below the middle of each element, m; empty if all depths are zero.
    ///
    /// The position of a wall's thrust follows from pressures that are distributed on each element as at rest
    /// ([`FaceForces::place`](crate::coupled::FaceForces::place)).
    pub depth_of_pressure_at_rest: Vec<f64>,
    /// Mean mass of the soil above each element, kg/m²; empty for a ground without walls, or of unknown weight.
    ///
    /// A run warns of wall pressures beyond the soil's resistance:
    /// [`Warning::WallPressure`](crate::coupled::Warning::WallPressure).
    pub mass_above: Vec<f64>,
    /// Water table in the soil; `None` without water.
    ///
    /// Pressures at rest and masses above are then effective, without the water.
    pub water_table: Option<WaterTable>,
    /// Numbers that identify the soils around walls, equal only for equal soils; `None` without them.
    ///
    /// `build` compares them with [`FreeField::soils`].
    pub identity: Option<Vec<f64>>,
    /// Convolution history; `None` without one.
    pub history: Option<HistoryChoice>,
}

/// Error of a ground without a time step, before `prepare`.
const NOT_PREPARED: Error = Error::Scene {
    quantity: "ground",
    needed: "`prepare` must be called with the time step first",
};

/// Soil with convolution weights and a static compliance, as [`WeightsGround`] needs it.
///
/// In the [mid-step form](Ground#elastic-parts-in-the-mid-step-form) the weights of an elastic part of compliance C
/// alternate without end: 2C, −2C, 2C, … A single weight C would add damping of first order in the time step. A
/// [`Ground`] can have an elastic part.
pub trait WeightsSource: Any + Send {
    /// Convolution weights of `elements` (left to right, not overlapping) for steps of `time_step` seconds.
    ///
    /// Compute coefficients when they are requested, not in this call: threads of other grounds may be waiting for the
    /// same weights.
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

    /// Numbers that identify the soil among soils of this type, for shared weights; `None` by default.
    ///
    /// Equal numbers must mean equal bits of all coefficients. With `None`, [`SharedKernels`] stores no weights of this
    /// soil.
    fn identity(&self) -> Option<Vec<f64>> {
        None
    }
}
