//! Boundary-value problems in time: tractions or displacements prescribed on any polygon.

use super::BoundaryKernel;
use super::convolution::BoundaryHistory;
use crate::error::{Error, Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::linalg::{DenseFactor, dense_multiply_add, largest};

/// Prescribed quantity of a component of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Given {
    /// The traction, Pa: constant over the step.
    Traction,
    /// The displacement, m.
    Displacement,
}

/// Solves a boundary equation in time with prescribed tractions or displacements.
///
/// Vectors have 2E entries, x-components first, then z (down), as in [the module](super).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{BoundaryMarch, Given, Segment, TimeKernel};
/// // A single free element under a pressure: before waves from its ends arrive, it moves as the surface of a half-plane.
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// let element = Segment { from: [-0.5, 0.0], to: [0.5, 0.0] };
/// let kernel = TimeKernel::new(soil, &[element], 1.0e-4)?;
/// let mut march = BoundaryMarch::new(Box::new(kernel), &[Given::Traction; 2])?;
/// march.step(&[0.0, 1.0e3])?;
/// let plane_wave = 1.0e3 * 1.0e-4 / (2000.0 * soil.pressure_wave_speed());
/// assert!((march.displacement()[1] / plane_wave - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct BoundaryMarch {
    history: BoundaryHistory,
    /// Prescribed quantity of each component.
    prescribed: Vec<Given>,
    /// Factors of the matrix of the unknowns.
    ///
    /// The matrix has columns of H⁰ for computed displacements, and of −G⁰ for computed tractions in `traction_unit`.
    factor: DenseFactor,
    /// Columns of G⁰ for prescribed tractions, and of −H⁰ for prescribed displacements.
    prescribed_columns: Vec<f64>,
    /// Unit of computed tractions, Pa per m.
    traction_unit: f64,
    /// Right-hand side, overwritten by the solution.
    rhs: Vec<f64>,
    /// Displacements at the end of the last step, m.
    displacement: Vec<f64>,
    /// Tractions during the last step, Pa.
    traction: Vec<f64>,
}

short_debug! { BoundaryMarch; self; components: self.prescribed.len() }

impl BoundaryMarch {
    /// Boundary at rest; `prescribed` has 2E entries.
    ///
    /// # Errors
    /// [`Error::Size`] for the wrong number of entries, [`Error::Singular`] if the boundary values do not
    /// determine the others, and errors of the kernel.
    pub fn new(kernel: Box<dyn BoundaryKernel>, prescribed: &[Given]) -> Result<Self> {
        let order = ContactLayout::new(COMPONENTS_IN_PLANE, kernel.segments().len()).len();
        same_length("list of prescribed quantities", prescribed.len(), order)?;
        let mut g = vec![0.0; order * order];
        let mut h = vec![0.0; order * order];
        kernel.coefficients(0, &mut g, &mut h)?;
        let traction_unit = 1.0 / largest(&g).max(f64::MIN_POSITIVE);
        let mut matrix = vec![0.0; order * order];
        let mut prescribed_columns = vec![0.0; order * order];
        for (k, (g, h)) in g.iter().zip(&h).enumerate() {
            match prescribed[k % order] {
                Given::Traction => {
                    matrix[k] = *h;
                    prescribed_columns[k] = *g;
                }
                Given::Displacement => {
                    matrix[k] = -g * traction_unit;
                    prescribed_columns[k] = -h;
                }
            }
        }
        let mut factor = DenseFactor::with_capacity(order);
        if !factor.factor(&matrix, order) {
            return Err(Error::Singular { matrix: "boundary operator", order });
        }
        Ok(Self {
            history: BoundaryHistory::new(kernel, &vec![true; order]),
            prescribed: prescribed.to_vec(),
            factor,
            prescribed_columns,
            traction_unit,
            rhs: vec![0.0; order],
            displacement: vec![0.0; order],
            traction: vec![0.0; order],
        })
    }

    /// Allocates for about `steps` further steps.
    ///
    /// # Errors
    /// The errors of the kernel.
    pub fn prepare(&mut self, steps: usize) -> Result<()> {
        self.history.prepare(steps)
    }

    /// Advances by one step with prescribed values: tractions during the step, displacements at its end.
    ///
    /// # Errors
    /// [`Error::Size`] for the wrong number of values, and errors of the kernel.
    pub fn step(&mut self, values: &[f64]) -> Result<()> {
        same_length("boundary values", values.len(), self.prescribed.len())?;
        self.history.evaluate(&mut self.rhs)?;
        dense_multiply_add(&self.prescribed_columns, 1.0, values, &mut self.rhs);
        self.factor.solve(&mut self.rhs);
        for (k, (prescribed, solution)) in self.prescribed.iter().zip(&self.rhs).enumerate() {
            match prescribed {
                Given::Traction => {
                    self.displacement[k] = *solution;
                    self.traction[k] = values[k];
                }
                Given::Displacement => {
                    self.displacement[k] = values[k];
                    self.traction[k] = *solution * self.traction_unit;
                }
            }
        }
        self.history.push(&self.displacement, &self.traction);
        Ok(())
    }

    /// Number of completed steps.
    pub fn steps(&self) -> usize {
        self.history.steps()
    }

    /// Displacements (2E, m) at the end of the last step.
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// Tractions (2E, Pa) during the last step.
    pub fn traction(&self) -> &[f64] {
        &self.traction
    }
}
