//! Cross-sections of fibres, and beams of them.

use std::sync::Arc;

use basemat::fem::{BeamFormulation, BeamQuadrature, FiberBeam, FiberSection, SpaceFiberBeam};
use pyo3::prelude::*;

use super::connectivity::{Connectivity, PerElement, Vectors, one_of};
use super::fiber_material::FiberLaw;
use super::mesh::PyMesh;
use crate::array::{Count, Pairs, whole_numbers};
use crate::error::{OrRaise, WithOption, input_error};
use crate::list_arguments::ListOf;
use crate::names::choice;

/// Cross-section of fibres, each with an area and a law: for `Mesh.add_fiber_beams` and `Mesh.add_space_fiber_beams`.
///
/// It starts without fibres, and each method returns a section with more of them. Positions are y and z in the axes of the
/// beam (m), from the line between its nodes; y points to the left of a beam seen from its first node to the second, and a
/// positive curvature stretches the fibres at negative y. Beams in the plane do not depend on z, and their areas are
/// per metre of thickness. A ``material`` is a `Concrete`, `BilinearSteel`, `MenegottoPinto`, a linear elastic `Material`
/// or a `UserUniaxialMaterial`.
#[pyclass(name = "FiberSection", module = "basemat", frozen, dict)]
pub(crate) struct PyFiberSection(pub(super) FiberSection);

/// Two points of an array of shape (2, 2); an error calls it by its `name`.
fn two_points(name: &str, points: Pairs) -> PyResult<[[f64; 2]; 2]> {
    let point_count = points.0.len();
    let text = format!("{name} has {point_count} rows, but must have 2");
    points.0.try_into().map_err(|_| input_error(text))
}

/// The two numbers of fibres along a shape.
fn counts([first, second]: [Count; 2]) -> [usize; 2] {
    [first.0, second.0]
}

#[pymethods]
impl PyFiberSection {
    #[new]
    fn new() -> Self {
        Self(FiberSection::new())
    }

    /// Adds a fibre of a ``material`` at a ``position`` (y and z, m) with an ``area`` (m²).
    fn with_fiber(&self, position: [f64; 2], area: f64, material: FiberLaw) -> PyResult<Self> {
        self.0.clone().with_fiber(position, area, material.0).or_raise().map(Self)
    }

    /// Adds fibres of a ``material`` at ``positions`` (array of shape (n, 2) of y and z, m) with ``areas`` (m²; one number or an
    /// array of one per fibre).
    fn with_fibers(
        &self,
        positions: Pairs,
        areas: PerElement,
        material: FiberLaw,
    ) -> PyResult<Self> {
        let fiber_count = positions.0.len();
        let mut section = self.0.clone();
        for (index, &position) in positions.0.iter().enumerate() {
            let area = areas.at("areas", index, fiber_count)?;
            section = section.with_fiber(position, area, Arc::clone(&material.0)).or_raise()?;
        }
        Ok(Self(section))
    }

    /// Adds a rectangle of a ``material`` between two ``corners`` (array of shape (2, 2) of y and z, m), cut into ``counts``
    /// fibres along y and along z (two numbers).
    fn with_rectangle(
        &self,
        corners: Pairs,
        counts: [Count; 2],
        material: FiberLaw,
    ) -> PyResult<Self> {
        let corners = two_points("corners", corners)?;
        let counts = self::counts(counts);
        self.0.clone().with_rectangle(corners, counts, material.0).or_raise().map(Self)
    }

    /// Adds a ring of a ``material`` about ``center`` (y and z, m) between two ``radii`` (inside, 0 for a disc, and outside;
    /// m), cut into ``counts`` rings and sectors (two numbers).
    fn with_ring(
        &self,
        center: [f64; 2],
        radii: [f64; 2],
        counts: [Count; 2],
        material: FiberLaw,
    ) -> PyResult<Self> {
        let counts = self::counts(counts);
        self.0.clone().with_ring(center, radii, counts, material.0).or_raise().map(Self)
    }

    /// Adds ``count`` bars of a ``material`` and of ``bar_area`` (m²) on a straight line between two ``ends`` (array of shape
    /// (2, 2) of y and z, m), ends included; a single bar in the middle. Bars do not replace the concrete around them.
    fn with_bars(
        &self,
        ends: Pairs,
        count: Count,
        bar_area: f64,
        material: FiberLaw,
    ) -> PyResult<Self> {
        let ends = two_points("ends", ends)?;
        self.0.clone().with_bars(ends, count.0, bar_area, material.0).or_raise().map(Self)
    }

    /// Adds an I-section of a ``material`` about the middle of its height, bent about its strong axis: ``sizes`` are its depth
    /// over all and its flange width, ``thicknesses`` those of web and flanges (two numbers each, m). Each flange has
    /// ``counts[0]`` layers of fibres along y, the web ``counts[1]``. Beams in space need `with_i_section_in_space`.
    fn with_i_section(
        &self,
        sizes: [f64; 2],
        thicknesses: [f64; 2],
        counts: [Count; 2],
        material: FiberLaw,
    ) -> PyResult<Self> {
        let counts = self::counts(counts);
        let section = self.0.clone().with_i_section(sizes, thicknesses, counts, material.0);
        section.or_raise().map(Self)
    }

    /// Adds an I-section of a ``material``, cut along y and along z, for beams in space; ``sizes`` and ``thicknesses`` are as for
    /// `with_i_section`.
    ///
    /// ``counts``: fibres along y and along z of each flange, then of the web (array of shape (2, 2)).
    fn with_i_section_in_space(
        &self,
        sizes: [f64; 2],
        thicknesses: [f64; 2],
        counts: [[Count; 2]; 2],
        material: FiberLaw,
    ) -> PyResult<Self> {
        let counts = counts.map(self::counts);
        let section = self.0.clone();
        let section = section.with_i_section_in_space(sizes, thicknesses, counts, material.0);
        section.or_raise().map(Self)
    }

    /// Replaces the elastic torsional ``stiffness`` G J (N m²), which beams in space need.
    fn with_torsional_stiffness(&self, stiffness: f64) -> PyResult<Self> {
        self.0.clone().with_torsional_stiffness(stiffness).or_raise().map(Self)
    }

    /// Number of fibres.
    #[getter]
    fn fiber_count(&self) -> usize {
        self.0.fiber_count()
    }

    /// Axial stiffness Σ E A of small strains, N.
    #[getter]
    fn axial_stiffness(&self) -> f64 {
        self.0.axial_stiffness()
    }
}

/// One section for all beams, or a list of one for each.
struct FiberSectionList(Vec<FiberSection>);

extracts!(FiberSectionList, object => {
    if let Ok(section) = object.cast::<PyFiberSection>() {
        return Ok(Self(vec![section.get().0.clone()]));
    }
    let sections = object.extract::<ListOf<'_, PyFiberSection>>()?;
    Ok(Self(sections.iter().map(|section| section.get().0.clone()).collect()))
});

/// Rule of integration along a beam by its name.
fn quadrature(name: &str, points: usize) -> PyResult<BeamQuadrature> {
    let choices = [
        ("lobatto", BeamQuadrature::Lobatto(points)),
        ("legendre", BeamQuadrature::Legendre(points)),
    ];
    choice("quadrature", name, &choices)
}

/// Formulation of a beam by its name.
fn formulation(name: &str) -> PyResult<BeamFormulation> {
    let choices = [
        ("displacement_based", BeamFormulation::DisplacementBased),
        ("force_based", BeamFormulation::ForceBased),
    ];
    choice("formulation", name, &choices)
}

#[pymethods]
impl PyMesh {
    /// Adds beams of fibres in the plane on ``nodes`` (array of shape (beams, 2)): ``section``, a `FiberSection` or a list of
    /// one per beam, and ``mass_per_length`` (kg/m per metre of thickness; one number or an array of one per beam).
    ///
    /// Sections lie at ``points`` points, 2 to 5, of the ``quadrature`` "lobatto" (with points at both ends) or "legendre".
    /// ``formulation``: "displacement_based" (curvature is linear along a beam: divide members where they yield) or
    /// "force_based" (equilibrium is exact: one beam is a member). ``compression`` (N per metre; one number or an array of one
    /// per beam): axial force of P–Δ, none unless given. Sections stay plane, and shear does not deform them.
    /// `Simulation.beam_sections` returns curvatures, moments and stresses.
    #[pyo3(signature = (nodes, section, mass_per_length, *, points=5, quadrature="lobatto", formulation="displacement_based", compression=None))]
    fn add_fiber_beams(
        &mut self,
        nodes: Connectivity,
        section: FiberSectionList,
        mass_per_length: PerElement,
        #[pyo3(from_py_with = whole_numbers)] points: usize,
        quadrature: &str,
        formulation: &str,
        compression: Option<PerElement>,
    ) -> PyResult<Vec<usize>> {
        if self.has_depth() {
            let needed = "must be in the plane: add_space_fiber_beams adds them in space";
            return Err(input_error(format!("the mesh of beams by add_fiber_beams {needed}")));
        }
        let quadrature = self::quadrature(quadrature, points)?;
        let formulation = self::formulation(formulation)?;
        let ends = nodes.rows::<2>()?;
        let beam_count = ends.len();
        self.add_all(ends.iter().enumerate().map(|(beam_index, &beam_nodes)| {
            let beam_section = one_of(&section.0, "section", beam_index, beam_count)?;
            let beam_mass = mass_per_length.at("mass_per_length", beam_index, beam_count)?;
            let axial_force = match &compression {
                Some(compression) => Some(compression.at("compression", beam_index, beam_count)?),
                None => None,
            };
            let beam = FiberBeam::new(beam_nodes, beam_section, quadrature, beam_mass)
                .with(axial_force, FiberBeam::with_compression);
            Ok(beam.or_raise()?.with_formulation(formulation))
        }))
    }
    /// Adds beams of fibres in space on ``nodes`` (array of shape (beams, 2)): ``section``, a `FiberSection` with a torsional
    /// stiffness or a list of one per beam, ``mass_per_length`` (kg/m; one number or an array of one per beam) and
    /// ``orientation`` (x, y and z of a vector, or an array of shape (beams, 3)), whose part perpendicular to the beam is the y
    /// axis of the section.
    ///
    /// ``points``, ``quadrature``, ``formulation`` and ``compression`` (N; none unless given) are as for `Mesh.add_fiber_beams`.
    /// Axial force and both moments act on the fibres together; torsion is elastic.
    #[pyo3(signature = (nodes, section, mass_per_length, orientation, *, points=5, quadrature="lobatto", formulation="displacement_based", compression=None))]
    fn add_space_fiber_beams(
        &mut self,
        nodes: Connectivity,
        section: FiberSectionList,
        mass_per_length: PerElement,
        orientation: Vectors,
        #[pyo3(from_py_with = whole_numbers)] points: usize,
        quadrature: &str,
        formulation: &str,
        compression: Option<PerElement>,
    ) -> PyResult<Vec<usize>> {
        if !self.has_depth() {
            let needed = "must be in space: add_fiber_beams adds them in the plane";
            return Err(input_error(format!(
                "the mesh of beams by add_space_fiber_beams {needed}"
            )));
        }
        let quadrature = self::quadrature(quadrature, points)?;
        let formulation = self::formulation(formulation)?;
        let ends = nodes.rows::<2>()?;
        let beam_count = ends.len();
        self.add_all(ends.iter().enumerate().map(|(beam_index, &beam_nodes)| {
            let beam_section = one_of(&section.0, "section", beam_index, beam_count)?;
            let beam_mass = mass_per_length.at("mass_per_length", beam_index, beam_count)?;
            let vector = *one_of(&orientation.0, "orientation", beam_index, beam_count)?;
            let axial_force = match &compression {
                Some(compression) => Some(compression.at("compression", beam_index, beam_count)?),
                None => None,
            };
            let beam = SpaceFiberBeam::new(beam_nodes, beam_section, quadrature, beam_mass, vector)
                .with(axial_force, SpaceFiberBeam::with_compression);
            Ok(beam.or_raise()?.with_formulation(formulation))
        }))
    }
}
