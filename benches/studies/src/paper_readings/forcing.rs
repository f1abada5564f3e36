//! The forcing of eq. 21 as printed: `[K]{δᶠ}` of the contact nodes beside the soil's part.

use basemat::motion::Record;
use basemat::structure::{Base, FemModel, Structure, Triplets};

/// A model on which the free field also acts through the stiffness of the structure.
pub(crate) struct PrintedForcing {
    model: FemModel,
    record: Record,
    /// Sum of K's columns of the horizontal degrees of freedom of the contact nodes, N/m per metre.
    column: Vec<f64>,
}

impl PrintedForcing {
    pub(crate) fn new(model: FemModel, record: Record) -> basemat::Result<Self> {
        let mut stiffness = Triplets::new(model.dofs());
        model.stiffness(&mut stiffness)?;
        let mut contact = vec![0.0; model.dofs()];
        for node in model.base().nodes() {
            for &(dof, weight) in &node.horizontal {
                contact[dof] += weight;
            }
        }
        let mut column = vec![0.0; model.dofs()];
        for &(row, dof, value) in stiffness.entries() {
            column[row] += value * contact[dof];
        }
        Ok(Self { model, record, column })
    }
}

impl Structure for PrintedForcing {
    fn dofs(&self) -> usize {
        self.model.dofs()
    }

    fn base(&self) -> Base {
        self.model.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.model.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.model.stiffness(matrix)
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.model.damping(matrix)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> basemat::Result<()> {
        let free_field = self.record.at(time).displacement;
        load.iter_mut()
            .zip(&self.column)
            .for_each(|(load, column)| *load += column * free_field);
        Ok(())
    }
}
