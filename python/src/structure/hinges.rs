//! Concentrated hinges of a mesh, their yield surfaces and states.

use basemat::fem::{AxialMomentSurface, Hinge, HingeState, InteractionHinge, SpaceHinge};
use pyo3::prelude::*;

use super::connectivity::{Connectivity, PerElement};
use super::fiber_material::FiberLaw;
use super::mesh::PyMesh;
use crate::array::{Array, Pairs, Rows};
use crate::error::{OrRaise, raise_user_exceptions};

/// Axial forces N (tension is positive) and moments M that a section can carry together: a convex set about zero.
#[pyclass(name = "AxialMomentSurface", module = "basemat", frozen, dict)]
pub(crate) struct PyAxialMomentSurface(AxialMomentSurface);

#[pymethods]
impl PyAxialMomentSurface {
    /// Rectangular section of a ductile material: |M|/M_p + (N/N_p)² ≤ 1 with ``axial_strength`` N_p (N) and
    /// ``plastic_moment`` M_p (N m), in the plane per metre of thickness.
    #[staticmethod]
    fn rectangle(axial_strength: f64, plastic_moment: f64) -> PyResult<Self> {
        AxialMomentSurface::rectangle(axial_strength, plastic_moment).or_raise().map(Self)
    }

    /// Ellipse: (M/M_p)² + (N/N_p)² ≤ 1 with ``axial_strength`` N_p (N) and ``plastic_moment`` M_p (N m), in the plane per
    /// metre of thickness.
    #[staticmethod]
    fn ellipse(axial_strength: f64, plastic_moment: f64) -> PyResult<Self> {
        AxialMomentSurface::ellipse(axial_strength, plastic_moment).or_raise().map(Self)
    }

    /// Convex polygon with these ``corners`` [N, M] around zero, in either sense: array of shape (n, 2), N and N m, in the
    /// plane per metre of thickness.
    #[staticmethod]
    fn polygon(corners: Pairs) -> PyResult<Self> {
        AxialMomentSurface::polygon(&corners.0).or_raise().map(Self)
    }

    /// Least and largest moment (N m) beside an ``axial_force`` (N); None for a force beyond the strength.
    fn moments_at(&self, axial_force: f64) -> Option<[f64; 2]> {
        self.0.moments_at(axial_force)
    }
}

#[pymethods]
impl PyMesh {
    /// Adds hinges in the plane between ``nodes`` at one place (array of shape (hinges, 2)), whose moment yields by
    /// ``moment_law``: a `BilinearMoment`, or a law of fibres with the moment in place of the stress and the rotation in
    /// place of the strain, such as a `MenegottoPinto`.
    ///
    /// ``displacement_stiffness`` (N/m per metre; one number or an array of one per hinge): stiffness of the springs between
    /// the displacements of the nodes, 10² to 10⁴ times that of the members. ``rigid_arm``: whether the nodes may lie at a
    /// distance, which a rigid arm from the first node bridges; False by default. The stiffness of hinges does not count in
    /// Rayleigh damping. `Simulation.hinge_state` returns rotation and moment.
    #[pyo3(signature = (nodes, moment_law, displacement_stiffness, *, rigid_arm=false))]
    fn add_hinges(
        &mut self,
        nodes: Connectivity,
        moment_law: FiberLaw,
        displacement_stiffness: PerElement,
        rigid_arm: bool,
    ) -> PyResult<Vec<usize>> {
        let ends = nodes.rows::<2>()?;
        let hinge_count = ends.len();
        self.add_all(ends.iter().enumerate().map(|(index, &hinge_nodes)| {
            let stiffness =
                displacement_stiffness.at("displacement_stiffness", index, hinge_count)?;
            let hinge = Hinge::new(hinge_nodes, stiffness, moment_law.0.clone()).or_raise()?;
            Ok(if rigid_arm { hinge.with_rigid_arm() } else { hinge })
        }))
    }

    /// Adds hinges in the plane between ``nodes`` at one place (array of shape (hinges, 2)), whose axial force and moment yield
    /// together on a ``surface``, an `AxialMomentSurface`, by associated flow.
    ///
    /// ``axis``: direction [x, y] of the member from the first to the second node. ``displacement_stiffness``: stiffness along
    /// and across the axis (two numbers, N/m per metre); ``rotational_stiffness``: N m/rad per metre. ``hardening_ratio``: ratio
    /// of the stiffness beyond the surface to that within, from 0 (default) to below 1. ``rigid_arm``: as for `add_hinges`.
    #[pyo3(signature = (nodes, axis, displacement_stiffness, rotational_stiffness, surface, *, hardening_ratio=0.0, rigid_arm=false))]
    fn add_interaction_hinges(
        &mut self,
        nodes: Connectivity,
        axis: [f64; 2],
        displacement_stiffness: [f64; 2],
        rotational_stiffness: f64,
        surface: &PyAxialMomentSurface,
        hardening_ratio: f64,
        rigid_arm: bool,
    ) -> PyResult<Vec<usize>> {
        self.add_all(nodes.rows::<2>()?.iter().map(|&hinge_nodes| {
            let hinge = InteractionHinge::new(
                hinge_nodes,
                axis,
                displacement_stiffness,
                rotational_stiffness,
                surface.0.clone(),
            )
            .and_then(|hinge| hinge.with_hardening(hardening_ratio))
            .or_raise()?;
            Ok(if rigid_arm { hinge.with_rigid_arm() } else { hinge })
        }))
    }

    /// Adds hinges in space between ``nodes`` at one place (array of shape (hinges, 2)), whose bending moments yield together:
    /// (M_y/M_py)² + (M_z/M_pz)² ≤ 1 with ``plastic_moments`` M_py and M_pz (two numbers, N m).
    ///
    /// ``axis``: direction [x, y, z] of the member from the first to the second node; y of the section lies in the plane of the
    /// axis and ``orientation``. ``displacement_stiffness``: N/m; ``rotational_stiffness``: in torsion and in bending about y
    /// and z (three numbers, N m/rad). ``hardening_ratio`` (0 by default) and ``rigid_arm``: as for `add_interaction_hinges`.
    #[pyo3(signature = (nodes, axis, orientation, displacement_stiffness, rotational_stiffness, plastic_moments, *, hardening_ratio=0.0, rigid_arm=false))]
    fn add_space_hinges(
        &mut self,
        nodes: Connectivity,
        axis: [f64; 3],
        orientation: [f64; 3],
        displacement_stiffness: f64,
        rotational_stiffness: [f64; 3],
        plastic_moments: [f64; 2],
        hardening_ratio: f64,
        rigid_arm: bool,
    ) -> PyResult<Vec<usize>> {
        self.add_all(nodes.rows::<2>()?.iter().map(|&hinge_nodes| {
            let hinge = SpaceHinge::new(
                hinge_nodes,
                [axis, orientation],
                displacement_stiffness,
                rotational_stiffness,
                plastic_moments,
            )
            .and_then(|hinge| hinge.with_hardening(hardening_ratio))
            .or_raise()?;
            Ok(if rigid_arm { hinge.with_rigid_arm() } else { hinge })
        }))
    }
}

/// Deformation and forces of a hinge.
///
/// `Simulation.hinge_state` returns it. Vectors have components along ``axes``: along the member, and at right angles to it.
/// A deformation is the motion of the second node relative to the first; a positive deformation causes a positive force. In
/// the plane rotation and moment are about the third axis, forces are per metre of thickness, and other components are zero.
#[pyclass(name = "HingeState", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyHingeState {
    element: usize,
    position: [f64; 3],
    axes: [[f64; 3]; 3],
    displacement: [f64; 3],
    force: [f64; 3],
    rotation: [f64; 3],
    moment: [f64; 3],
    plastic_displacement: [f64; 3],
    plastic_rotation: [f64; 3],
}

impl PyHingeState {
    /// State that `read` returns for an element; raises exceptions of a law written in Python.
    pub(crate) fn of_element(
        element: usize,
        read: impl FnOnce(usize) -> basemat::Result<HingeState>,
    ) -> PyResult<Self> {
        let state = raise_user_exceptions(|| read(element).or_raise())?;
        Ok(Self {
            element,
            position: state.position,
            axes: state.axes,
            displacement: state.displacement,
            force: state.force,
            rotation: state.rotation,
            moment: state.moment,
            plastic_displacement: state.plastic_displacement,
            plastic_rotation: state.plastic_rotation,
        })
    }
}

#[pymethods]
impl PyHingeState {
    /// Number of the element.
    #[getter]
    fn element(&self) -> usize {
        self.element
    }

    /// Position x, y and z of the undeformed hinge: array of shape (3,), m.
    #[getter]
    fn position(&self) -> Array {
        self.position.as_slice().into()
    }

    /// Unit vectors along the member and at right angles to it: array of shape (3, 3), numbers without unit.
    #[getter]
    fn axes(&self) -> Rows {
        Rows(self.axes.iter().map(|axis| axis.to_vec()).collect())
    }

    /// Elongation and displacements at right angles to the member: array of shape (3,), m.
    #[getter]
    fn displacement(&self) -> Array {
        self.displacement.as_slice().into()
    }

    /// Axial force (tension is positive) and shear forces: array of shape (3,), N.
    #[getter]
    fn force(&self) -> Array {
        self.force.as_slice().into()
    }

    /// Rotation vector, twist first: array of shape (3,), rad.
    #[getter]
    fn rotation(&self) -> Array {
        self.rotation.as_slice().into()
    }

    /// Torque and bending moments: array of shape (3,), N m.
    #[getter]
    fn moment(&self) -> Array {
        self.moment.as_slice().into()
    }

    /// Displacement that remains if the force is unloaded elastically: array of shape (3,), m.
    #[getter]
    fn plastic_displacement(&self) -> Array {
        self.plastic_displacement.as_slice().into()
    }

    /// Rotation that remains if the moment is unloaded elastically: array of shape (3,), rad.
    #[getter]
    fn plastic_rotation(&self) -> Array {
        self.plastic_rotation.as_slice().into()
    }

    fn __repr__(&self) -> String {
        format!("HingeState(element {})", self.element)
    }
}
