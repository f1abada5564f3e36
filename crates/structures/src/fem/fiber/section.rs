//! Cross-section of fibres.

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use super::UniaxialMaterial;
use crate::error::{Error, Result, all_finite, at_least, positive};
use crate::fem::inelastic_force::FiberState;
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::small_matrix::add_outer;

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
    variable_count: usize,
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
    fn with_fibers(
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
        Ok(self)
    }

    /// Adds a rectangle between two `corners` [y, z] (m), cut into `counts` fibres along y and z.
    ///
    /// # Errors
    /// [`Error::NotFinite`] and [`Error::Input`] for corners that are not finite or equal in y or z, and for a material
    /// without a positive modulus; [`Error::Size`] without fibres.
    pub fn with_rectangle(
        self,
        corners: [[f64; 2]; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        all_finite("corners of a rectangle of fibres", corners.as_flattened())?;
        let sizes = [0, 1].map(|axis| (corners[1][axis] - corners[0][axis]) / counts[axis] as f64);
        for count in counts {
            at_least("fibres along a side of a rectangle", count, 1)?;
        }
        let area = positive("area of a fibre", (sizes[0] * sizes[1]).abs())?;
        let mut fibers = Vec::with_capacity(counts[0] * counts[1]);
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                let y = corners[0][0] + (i as f64 + 0.5) * sizes[0];
                let z = corners[0][1] + (j as f64 + 0.5) * sizes[1];
                fibers.push(([y, z], area));
            }
        }
        self.with_fibers(&fibers, &shared(material))
    }

    /// Adds a ring (or a disc) about `center` [y, z] (m), cut into `counts` rings and sectors.
    ///
    /// `radii`: inside (0 for a disc) and outside, m. Each fibre lies at the centroid of its part of the ring.
    ///
    /// # Errors
    /// [`Error::NotFinite`] and [`Error::Input`] unless the centre is finite and 0 ≤ inside < outside, and for a material
    /// without a positive modulus; [`Error::Size`] unless there are a ring and three sectors.
    pub fn with_ring(
        self,
        center: [f64; 2],
        radii: [f64; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        all_finite("centre of a ring of fibres", &center)?;
        crate::error::not_negative("inner radius of a ring of fibres", radii[0])?;
        let thickness = positive("thickness of a ring of fibres", radii[1] - radii[0])?;
        at_least("rings of fibres", counts[0], 1)?;
        at_least("sectors of fibres", counts[1], 3)?;
        let half_angle = PI / counts[1] as f64;
        let mut fibers = Vec::with_capacity(counts[0] * counts[1]);
        for ring in 0..counts[0] {
            let inner = radii[0] + thickness * ring as f64 / counts[0] as f64;
            let outer = radii[0] + thickness * (ring + 1) as f64 / counts[0] as f64;
            let area = half_angle * (outer * outer - inner * inner);
            let radius = 2.0 * half_angle.sin() * (outer.powi(3) - inner.powi(3)) / (3.0 * area);
            for sector in 0..counts[1] {
                let angle = 2.0 * half_angle * (sector as f64 + 0.5);
                let position = [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()];
                fibers.push((position, area));
            }
        }
        self.with_fibers(&fibers, &shared(material))
    }

    /// Adds `count` bars of `bar_area` (m²) on a straight line between two `ends` [y, z] (m), ends included.
    ///
    /// A single bar lies in the middle. The bars do not replace the concrete around them.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the ends, [`Error::Size`] without bars, [`Error::Input`] unless area and modulus are
    /// positive.
    pub fn with_bars(
        self,
        ends: [[f64; 2]; 2],
        count: usize,
        bar_area: f64,
        material: impl UniaxialMaterial,
    ) -> Result<Self> {
        at_least("bars of a layer", count, 1)?;
        let position = |bar: usize| {
            let s = if count == 1 { 0.5 } else { bar as f64 / (count - 1) as f64 };
            [0, 1].map(|axis| (1.0 - s) * ends[0][axis] + s * ends[1][axis])
        };
        let fibers: Vec<_> = (0..count).map(|bar| (position(bar), bar_area)).collect();
        self.with_fibers(&fibers, &shared(material))
    }

    /// Adds an I-section about the middle of its height: two flanges and a web, bent about its strong axis along y.
    ///
    /// `depth` over all and `flange_width`, with the thicknesses of web and flanges, m. Each flange has `counts[0]` and
    /// the web `counts[1]` layers of fibres along y.
    ///
    /// # Errors
    /// [`Error::Input`] unless all are positive and the flanges thinner than half of the depth; as
    /// [`with_rectangle`](FiberSection::with_rectangle).
    pub fn with_i_section(
        self,
        [depth, flange_width]: [f64; 2],
        [web_thickness, flange_thickness]: [f64; 2],
        counts: [usize; 2],
        material: impl UniaxialMaterial + Clone,
    ) -> Result<Self> {
        positive("flange width of an I-section", flange_width)?;
        positive("web thickness of an I-section", web_thickness)?;
        positive("flange thickness of an I-section", flange_thickness)?;
        let web_height = positive("web height of an I-section", depth - 2.0 * flange_thickness)?;
        let top = 0.5 * depth;
        let edge = 0.5 * web_height;
        let flange = 0.5 * flange_width;
        let web = 0.5 * web_thickness;
        self.with_rectangle([[-top, -flange], [-edge, flange]], [counts[0], 1], material.clone())?
            .with_rectangle([[-edge, -web], [edge, web]], [counts[1], 1], material.clone())?
            .with_rectangle([[edge, -flange], [top, flange]], [counts[0], 1], material)
    }

    /// Number of fibres.
    pub fn fiber_count(&self) -> usize {
        self.fibers.len()
    }

    /// Axial stiffness Σ E A of small strains, N.
    pub fn axial_stiffness(&self) -> f64 {
        self.fibers.iter().map(|fiber| fiber.material.modulus() * fiber.area).sum()
    }

    /// Returns an error for a section without fibres, or whose fibres lie on a line along z.
    pub(in crate::fem) fn check_plane(&self) -> Result<()> {
        at_least("fibres of a section", self.fiber_count(), 2)?;
        let [[axial, coupling], [_, bending]] = self.elastic_stiffness(plane_strains);
        let depth = bending - coupling * coupling / axial;
        positive("bending stiffness of a section of fibres", depth).map(drop)
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
        for (index, fiber) in self.fibers.iter().enumerate() {
            let row = strains(fiber.position);
            let strain = fiber_strain(&row, deformations);
            let fiber_response = fiber
                .material
                .response(strain, &variables[fiber.variables.clone()])
                .map_err(|fault| within_fiber(index, fault))?;
            for (force, entry) in response.forces.iter_mut().zip(row) {
                *force += fiber.area * fiber_response.stress * entry;
            }
            add_outer(fiber.area * fiber_response.tangent, &row, &mut response.tangent);
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
fn shared(material: impl UniaxialMaterial) -> Arc<dyn UniaxialMaterial> {
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
