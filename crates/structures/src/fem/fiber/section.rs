//! Cross-section of fibres.

use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

use super::{BilinearSteel, Concrete, MAX_BATCH_FIBERS, MenegottoPinto, UniaxialMaterial};
use crate::error::{Error, Result, all_finite, positive};
use crate::fem::inelastic_force::FiberState;
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::material::Material;
use crate::fem::small_matrix::add_outer;

/// Fibre of a section.
#[derive(Debug, Clone)]
pub(super) struct Fiber {
    /// Coordinates y and z in the section, m.
    pub(super) position: [f64; 2],
    /// Area, m².
    pub(super) area: f64,
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
    /// Ranges of neighbouring fibres with one law, whose responses are evaluated together.
    batches: Vec<Range<usize>>,
    variable_count: usize,
    /// G J, N m²; `None` for a section of beams in the plane.
    pub(super) torsional_stiffness: Option<f64>,
    /// Bending stiffness along y and z of rectangular fibres about their own middles, N m², which the strains leave out.
    pub(super) neglected_stiffness: [f64; 2],
}

/// Neighbouring fibres with one law, whose responses are evaluated together.
pub(super) struct Batch<'a> {
    /// Index of the first fibre in the section.
    pub(super) first: usize,
    pub(super) fibers: &'a [Fiber],
    pub(super) material: &'a dyn UniaxialMaterial,
    /// Range of the fibres' internal variables among those of the section.
    pub(super) variables: Range<usize>,
}

impl Batch<'_> {
    /// Number of fibres.
    pub(super) fn len(&self) -> usize {
        self.fibers.len()
    }

    /// Writes the strains by the deformations of the section to a buffer, and returns them.
    #[inline]
    pub(super) fn strains<'b, const N: usize>(
        &self,
        deformations: &[f64; N],
        buffer: &'b mut [f64],
    ) -> &'b [f64] {
        for (strain, fiber) in buffer.iter_mut().zip(self.fibers) {
            *strain = fiber_strain(&strain_row(fiber.position), deformations);
        }
        &buffer[..self.len()]
    }

    /// Adds the index of a fibre to its error.
    pub(super) fn within_fiber(&self, (index, fault): (usize, Error)) -> Error {
        within_fiber(self.first + index, fault)
    }
}

/// Strain of a fibre at [y, z] due to unit deformations of its section.
///
/// The deformations are axial strain, curvature about z, and curvature about y of a section in space (1/m).
#[inline]
pub(super) fn strain_row<const N: usize>([y, z]: [f64; 2]) -> [f64; N] {
    let row = [1.0, -y, z];
    std::array::from_fn(|i| row[i])
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
        self.extend_batches();
        Ok(self)
    }

    /// Adds the fibres behind the last batch to it if they have its law, and to new batches.
    fn extend_batches(&mut self) {
        let mut start = self.batches.last().map_or(0, |last| last.end);
        if let Some(last) = self.batches.last_mut()
            && let [law, new_law] = [last.start, start].map(|i| &*self.fibers[i].material)
            && is_same_law(law, new_law)
        {
            last.end = self.fibers.len().min(last.start + MAX_BATCH_FIBERS);
            start = last.end;
        }
        while start < self.fibers.len() {
            let end = self.fibers.len().min(start + MAX_BATCH_FIBERS);
            self.batches.push(start..end);
            start = end;
        }
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

    /// Stiffness of small strains.
    pub(in crate::fem) fn elastic_stiffness<const N: usize>(&self) -> [[f64; N]; N] {
        let mut stiffness = [[0.0; N]; N];
        for fiber in &self.fibers {
            let factor = fiber.area * fiber.material.modulus();
            add_outer(factor, &strain_row(fiber.position), &mut stiffness);
        }
        stiffness
    }

    /// The batches in the order of the fibres.
    pub(super) fn batches(&self) -> impl Iterator<Item = Batch<'_>> {
        self.batches.iter().filter_map(|range| {
            let fibers = &self.fibers[range.clone()];
            let first = fibers.first()?;
            let variables = first.variables.start..fibers.last()?.variables.end;
            Some(Batch { first: range.start, fibers, material: &*first.material, variables })
        })
    }

    /// Energy per length of the beam, J/m.
    ///
    /// # Errors
    /// Any of a material, in an [`Error::Item`] that names the fibre.
    pub(in crate::fem) fn energy<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &[f64],
    ) -> Result<InternalEnergy> {
        let mut sum = InternalEnergy::default();
        let mut strains = [0.0; MAX_BATCH_FIBERS];
        let mut energies = [InternalEnergy::default(); MAX_BATCH_FIBERS];
        for batch in self.batches() {
            let strains = batch.strains(deformations, &mut strains);
            let energies = &mut energies[..batch.len()];
            batch
                .material
                .energies(strains, &variables[batch.variables.clone()], energies)
                .map_err(|fault| batch.within_fiber(fault))?;
            for (fiber, energy) in batch.fibers.iter().zip(energies) {
                sum.stored += fiber.area * energy.stored;
                sum.dissipated += fiber.area * energy.dissipated;
            }
        }
        Ok(sum)
    }

    /// Strain and stress of each fibre.
    ///
    /// # Errors
    /// As for [`FiberSection::energy`].
    pub(in crate::fem) fn fiber_states<const N: usize>(
        &self,
        deformations: &[f64; N],
        variables: &[f64],
    ) -> Result<Vec<FiberState>> {
        let mut states = Vec::with_capacity(self.fibers.len());
        for (index, fiber) in self.fibers.iter().enumerate() {
            let strain = fiber_strain(&strain_row(fiber.position), deformations);
            let response = fiber
                .material
                .response(strain, &variables[fiber.variables.clone()])
                .map_err(|fault| within_fiber(index, fault))?;
            states.push(FiberState::new(fiber.position, fiber.area, strain, response.stress));
        }
        Ok(states)
    }
}

/// Whether two laws are equal laws of the library, or the same object.
fn is_same_law(a: &dyn UniaxialMaterial, b: &dyn UniaxialMaterial) -> bool {
    fn are_equal<L: PartialEq + 'static>(a: &dyn Any, b: &dyn Any) -> bool {
        a.downcast_ref::<L>().is_some_and(|a| Some(a) == b.downcast_ref())
    }
    let are_equal_laws = [
        are_equal::<Material>,
        are_equal::<BilinearSteel>,
        are_equal::<MenegottoPinto>,
        are_equal::<Concrete>,
    ];
    std::ptr::addr_eq(a, b) || are_equal_laws.iter().any(|are_equal| are_equal(a, b))
}

/// The law of several fibres.
pub(super) fn shared(material: impl UniaxialMaterial) -> Arc<dyn UniaxialMaterial> {
    Arc::new(material)
}

/// Strain of a fibre by the deformations of its section.
#[inline]
fn fiber_strain<const N: usize>(row: &[f64; N], deformations: &[f64; N]) -> f64 {
    row.iter().zip(deformations).map(|(entry, deformation)| entry * deformation).sum()
}

/// Adds the index of a fibre to its error.
fn within_fiber(index: usize, fault: Error) -> Error {
    fault.within(format!("fibre {index}"))
}
