//! Cross-section of fibres.

use std::ops::Range;
use std::sync::Arc;

use super::{UniaxialMaterial, UniaxialResponse};
use crate::error::{Error, Result, all_finite, positive};
use crate::fem::inelastic_force::FiberState;
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::small_matrix::add_outer;

/// Largest number of fibres whose responses are evaluated together.
const MAX_CHUNK_FIBERS: usize = 32;

/// Fibre of a section.
#[derive(Debug, Clone)]
struct Fiber {
    /// Coordinates y and z in the section, m.
    position: [f64; 2],
    /// Area, m².
    area: f64,
    material: Arc<dyn UniaxialMaterial>,
    /// Range of the fibre's internal variables among those of the section.
    variables: Range<usize>,
}

/// Cross-section of fibres, each with an area and a law.
///
/// Positions are [y, z] in the axes of the beam, m, from the line between its nodes. Beams in the plane bend along y (a positive
/// curvature stretches the fibres at negative y) and take no notice of z. Areas are in m²; in the plane, where all is
/// per metre of thickness, give the area per metre.
///
/// Beams in space also bend along z (a positive curvature about y stretches the fibres at positive z), and twist elastically
/// with [`with_torsional_stiffness`](FiberSection::with_torsional_stiffness). Fibres have the strain of their middles: cut
/// shapes into several fibres along each axis along which the section bends. A beam returns an error if rectangles that are not
/// divided leave out more than a third of the bending stiffness.
///
/// ```
/// use basemat::fem::{BilinearSteel, Concrete, FiberSection};
///
/// let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006)?;
/// let steel = BilinearSteel::new(500.0e6, 200.0e9, 0.01)?;
/// // A column of 0.6 m × 0.4 m with two layers of four bars.
/// let section = FiberSection::new()
///     .with_rectangle([[-0.3, -0.2], [0.3, 0.2]], [24, 1], concrete)?
///     .with_bars([[-0.25, -0.15], [-0.25, 0.15]], 4, 491.0e-6, steel)?
///     .with_bars([[0.25, -0.15], [0.25, 0.15]], 4, 491.0e-6, steel)?;
/// assert_eq!(section.fiber_count(), 32);
/// let axial = 0.24 * 30.0e9 + 8.0 * 491.0e-6 * 200.0e9;
/// assert!((section.axial_stiffness() / axial - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct FiberSection {
    fibers: Vec<Fiber>,
    /// Ranges of neighbouring fibres with one law, of a limited number of fibres.
    chunks: Vec<Range<usize>>,
    variable_count: usize,
    /// G J, N m²; `None` for a section of beams in the plane.
    pub(super) torsional_stiffness: Option<f64>,
    /// Bending stiffness along y and z of rectangular fibres about their own middles, N m², which the strains leave out.
    pub(super) neglected_stiffness: [f64; 2],
}

/// Resultants of a section and their derivatives with respect to its N deformations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::fem) struct SectionResponse<const N: usize> {
    /// Axial force (N) and bending moments (N m), conjugate to the deformations.
    pub(in crate::fem) forces: [f64; N],
    /// Tangent, symmetric.
    pub(in crate::fem) tangent: [[f64; N]; N],
}

/// Strain of a fibre due to unit deformations of its section: axial strain, curvature (1/m).
pub(in crate::fem) fn plane_strains([y, _]: [f64; 2]) -> [f64; 2] {
    [1.0, -y]
}

/// Strain of a fibre due to axial strain and the curvatures about z and about y (1/m).
pub(in crate::fem) fn space_strains([y, z]: [f64; 2]) -> [f64; 3] {
    [1.0, -y, z]
}

impl FiberSection {
    /// Section without fibres.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a fibre at `position` [y, z] (m) with an `area` (m²).
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the position, [`Error::Input`] unless area and modulus of the material are positive.
    pub fn with_fiber(
        self,
        position: [f64; 2],
        area: f64,
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        self.with_fibers(&[(position, area)], &shared(material))
    }

    /// Adds fibres of one material, as (position, area).
    pub(super) fn with_fibers(
        mut self,
        fibers: &[([f64; 2], f64)],
        material: &Arc<dyn UniaxialMaterial>,
    ) -> Result<Self> {
        positive("modulus of a fibre", material.modulus())?;
        for &(position, area) in fibers {
            all_finite("position of a fibre", &position)?;
            positive("area of a fibre", area)?;
            let first = self.variable_count;
            self.variable_count += material.variable_count();
            let variables = first..self.variable_count;
            self.fibers.push(Fiber { position, area, material: Arc::clone(material), variables });
        }
        let mut start = self.fibers.len() - fibers.len();
        while start < self.fibers.len() {
            let end = self.fibers.len().min(start + MAX_CHUNK_FIBERS);
            self.chunks.push(start..end);
            start = end;
        }
        Ok(self)
    }

    /// Adds bending stiffness that the strains of fibres leave out, N m².
    pub(super) fn with_neglected_stiffness(mut self, stiffness: [f64; 2]) -> Self {
        for (sum, value) in self.neglected_stiffness.iter_mut().zip(stiffness) {
            *sum += value;
        }
        self
    }

    /// Sets the torsional stiffness G J (N m²) for beams in space.
    ///
    /// The section twists elastically: its torque, G J times the twist rate, has no part in the stresses of the fibres. J is
    /// as for [`BeamSection::new`](crate::fem::BeamSection::new). Cracked concrete has a fraction of the uncracked stiffness.
    ///
    /// # Errors
    /// [`Error::Input`] unless it is positive.
    pub fn with_torsional_stiffness(self, torsional_stiffness: f64) -> Result<Self> {
        let quantity = "torsional stiffness of a section of fibres";
        let torsional_stiffness = Some(positive(quantity, torsional_stiffness)?);
        Ok(Self { torsional_stiffness, ..self })
    }

    /// Number of fibres.
    pub fn fiber_count(&self) -> usize {
        self.fibers.len()
    }

    /// Axial stiffness Σ E A of small strains, N.
    pub fn axial_stiffness(&self) -> f64 {
        self.fibers.iter().map(|fiber| fiber.material.modulus() * fiber.area).sum()
    }

    /// Number of internal variables.
    pub(in crate::fem) fn variable_count(&self) -> usize {
        self.variable_count
    }

    /// Overwrites the internal variables by those of fibres without strain.
    pub(in crate::fem) fn initialize(&self, variables: &mut [f64]) {
        for fiber in &self.fibers {
            fiber.material.initialize(&mut variables[fiber.variables.clone()]);
        }
    }

    /// Stiffness of small strains; `strains`: see [`plane_strains`].
    pub(in crate::fem) fn elastic_stiffness<const N: usize>(
        &self,
        strains: fn([f64; 2]) -> [f64; N],
    ) -> [[f64; N]; N] {
        let mut stiffness = [[0.0; N]; N];
        for fiber in &self.fibers {
            let factor = fiber.area * fiber.material.modulus();
            add_outer(factor, &strains(fiber.position), &mut stiffness);
        }
        stiffness
    }

    /// Resultants and tangent at the deformations of the section.
    ///
    /// # Errors
    /// Any of a material, in an [`Error::Item`] that names the fibre.
    pub(in crate::fem) fn response<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &[f64],
        strains: fn([f64; 2]) -> [f64; N],
    ) -> Result<SectionResponse<N>> {
        let mut response = SectionResponse { forces: [0.0; N], tangent: [[0.0; N]; N] };
        let mut rows = [[0.0; N]; MAX_CHUNK_FIBERS];
        let mut fiber_strains = [0.0; MAX_CHUNK_FIBERS];
        let mut fiber_responses = [UniaxialResponse::default(); MAX_CHUNK_FIBERS];
        for chunk in &self.chunks {
            let fibers = &self.fibers[chunk.clone()];
            let count = fibers.len();
            let (Some(first), Some(last)) = (fibers.first(), fibers.last()) else {
                continue;
            };
            for (k, fiber) in fibers.iter().enumerate() {
                rows[k] = strains(fiber.position);
                fiber_strains[k] = fiber_strain(&rows[k], deformations);
            }
            let variables = &variables[first.variables.start..last.variables.end];
            first
                .material
                .responses(&fiber_strains[..count], variables, &mut fiber_responses[..count])
                .map_err(|(k, fault)| within_fiber(chunk.start + k, fault))?;
            for ((fiber, row), fiber_response) in fibers.iter().zip(&rows).zip(&fiber_responses) {
                for (force, entry) in response.forces.iter_mut().zip(row) {
                    *force += fiber.area * fiber_response.stress * entry;
                }
                add_outer(fiber.area * fiber_response.tangent, row, &mut response.tangent);
            }
        }
        Ok(response)
    }

    /// Energy per length of the beam, J/m.
    ///
    /// # Errors
    /// As for [`FiberSection::response`].
    pub(in crate::fem) fn energy<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &[f64],
        strains: fn([f64; 2]) -> [f64; N],
    ) -> Result<InternalEnergy> {
        let mut sum = InternalEnergy::default();
        for (index, fiber) in self.fibers.iter().enumerate() {
            let strain = fiber_strain(&strains(fiber.position), deformations);
            let energy = fiber
                .material
                .energy(strain, &variables[fiber.variables.clone()])
                .map_err(|fault| within_fiber(index, fault))?;
            sum.stored += fiber.area * energy.stored;
            sum.dissipated += fiber.area * energy.dissipated;
        }
        Ok(sum)
    }

    /// Remainder of a step per length of the beam, J/m; `path`: deformations at its start, mid-step and end.
    ///
    /// # Errors
    /// As for [`FiberSection::response`].
    pub(in crate::fem) fn remainder<const N: usize>(
        &self,
        path: [&[f64; N]; 3],
        variables: &[f64],
        strains: fn([f64; 2]) -> [f64; N],
    ) -> Result<f64> {
        let mut sum = 0.0;
        for (index, fiber) in self.fibers.iter().enumerate() {
            let row = strains(fiber.position);
            let fiber_strains = path.map(|deformations| fiber_strain(&row, deformations));
            let remainder = fiber
                .material
                .remainder(fiber_strains, &variables[fiber.variables.clone()])
                .map_err(|fault| within_fiber(index, fault))?;
            sum += fiber.area * remainder;
        }
        Ok(sum)
    }

    /// Strain and stress of each fibre.
    ///
    /// # Errors
    /// As for [`FiberSection::response`].
    pub(in crate::fem) fn fiber_states<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &[f64],
        strains: fn([f64; 2]) -> [f64; N],
    ) -> Result<Vec<FiberState>> {
        let mut states = Vec::with_capacity(self.fibers.len());
        for (index, fiber) in self.fibers.iter().enumerate() {
            let strain = fiber_strain(&strains(fiber.position), deformations);
            let response = fiber
                .material
                .response(strain, &variables[fiber.variables.clone()])
                .map_err(|fault| within_fiber(index, fault))?;
            states.push(FiberState::new(fiber.position, fiber.area, strain, response.stress));
        }
        Ok(states)
    }

    /// Commits the fibres at the deformations of the section.
    pub(in crate::fem) fn commit<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &mut [f64],
        strains: fn([f64; 2]) -> [f64; N],
    ) {
        for fiber in &self.fibers {
            let strain = fiber_strain(&strains(fiber.position), deformations);
            fiber.material.commit(strain, &mut variables[fiber.variables.clone()]);
        }
    }
}

/// The law of several fibres.
pub(super) fn shared(material: impl UniaxialMaterial) -> Arc<dyn UniaxialMaterial> {
    Arc::new(material)
}

/// Strain of a fibre by the deformations of its section.
fn fiber_strain<const N: usize>(row: &[f64; N], deformations: &[f64; N]) -> f64 {
    row.iter().zip(deformations).map(|(entry, deformation)| entry * deformation).sum()
}

/// Adds the index of a fibre to its error.
fn within_fiber(index: usize, fault: Error) -> Error {
    fault.within(format!("fibre {index}"))
}
