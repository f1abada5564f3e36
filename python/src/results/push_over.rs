//! Curve of a push-over as arrays.

use basemat::analyses::{PushOver, PushPoint};
use pyo3::prelude::*;

use crate::array::Array;

/// Load against displacement of a static push-over: what `Simulation.push_over_by_displacement` returns.
///
/// Arrays have one value for each state of the path. The first is the state under weight and loads, without the load pattern.
#[pyclass(name = "PushOver", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyPushOver {
    load_factor: Vec<f64>,
    displacement: Vec<f64>,
    base_rotation: Vec<f64>,
    rotation_across: Vec<f64>,
    uplifted_fraction: Vec<f64>,
    sliding_fraction: Vec<f64>,
    base_shear: Vec<f64>,
    base_moment: Vec<f64>,
    cause: Option<String>,
    in_plan: bool,
}

impl PyPushOver {
    /// Curve of the core; in plan forces and moments are those of the whole base.
    pub(crate) fn new(curve: PushOver, in_plan: bool) -> Self {
        let values_of = |value: fn(&PushPoint) -> f64| curve.points.iter().map(value).collect();
        Self {
            load_factor: values_of(|point| point.force),
            displacement: values_of(|point| point.displacement),
            base_rotation: values_of(|point| point.base_rotation),
            rotation_across: values_of(|point| point.rotation_across),
            uplifted_fraction: values_of(|point| point.uplifted_fraction),
            sliding_fraction: values_of(|point| point.sliding_fraction),
            base_shear: values_of(|point| point.base_shear),
            base_moment: values_of(|point| point.base_moment),
            cause: curve.cause,
            in_plan,
        }
    }
}

#[pymethods]
impl PyPushOver {
    /// Factors of the load pattern: array of shape (states,), the force N/m (in plan N) of a pattern of weight 1.
    #[getter]
    fn load_factor(&self) -> Array {
        self.load_factor.as_slice().into()
    }

    /// Displacements of the control, relative to the first state: array of shape (states,), m or rad.
    #[getter]
    fn displacement(&self) -> Array {
        self.displacement.as_slice().into()
    }

    /// Rotations of the base, relative to the first state, counter-clockwise, in plan about the axis along y by the right-hand
    /// rule: array of shape (states,), rad. With several foundations the largest rotation.
    #[getter]
    fn base_rotation(&self) -> Array {
        self.base_rotation.as_slice().into()
    }

    /// In plan rotations of the base about the axis along x by the right-hand rule, zero in the plane: array of shape
    /// (states,), rad.
    #[getter]
    fn rotation_across(&self) -> Array {
        self.rotation_across.as_slice().into()
    }

    /// Areas of open elements over the area of the base: array of shape (states,), each a ratio.
    #[getter]
    fn uplifted_fraction(&self) -> Array {
        self.uplifted_fraction.as_slice().into()
    }

    /// Areas of elements that slide against friction over the area of the base: array of shape (states,), each a ratio.
    #[getter]
    fn sliding_fraction(&self) -> Array {
        self.sliding_fraction.as_slice().into()
    }

    /// Horizontal forces on the soil along x: array of shape (states,), N/m, in plan N.
    #[getter]
    fn base_shear(&self) -> Array {
        self.base_shear.as_slice().into()
    }

    /// Moments on the soil, with the signs of `State.base_moment`: array of shape (states,), N·m/m, in plan N·m.
    #[getter]
    fn base_moment(&self) -> Array {
        self.base_moment.as_slice().into()
    }

    /// Text of the error that ended the curve before the last displacement; None if it has all of them.
    #[getter]
    fn cause(&self) -> Option<&str> {
        self.cause.as_deref()
    }

    /// Whether the ground is in plan: forces and moments are then those of the whole base.
    #[getter]
    fn in_plan(&self) -> bool {
        self.in_plan
    }

    fn __len__(&self) -> usize {
        self.displacement.len()
    }

    fn __repr__(&self) -> String {
        format!("PushOver({} states)", self.displacement.len())
    }
}
