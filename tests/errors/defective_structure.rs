//! A structure with one defect.

use basemat::Simulation;
use basemat::coupled::SimulationBuilder;
use basemat::interface::Bonded;
use basemat::structure::{Base, BaseNode, NonlinearForce, Structure, Triplets};

use basemat_problems::block_on_springs::bed;

/// Row, column and value of a matrix.
pub(crate) type MatrixEntry = (usize, usize, f64);

/// A rigid body with defects.
#[derive(Clone)]
pub(crate) struct DefectiveStructure {
    pub(crate) dofs: usize,
    pub(crate) nodes: Vec<BaseNode>,
    /// Additional entries of its matrices.
    pub(crate) mass: MatrixEntry,
    pub(crate) stiffness: MatrixEntry,
    pub(crate) damping: MatrixEntry,
    pub(crate) tangent: Option<MatrixEntry>,
    /// Whether it replaces the stiffness matrix by a smaller one.
    pub(crate) shrinks_stiffness: bool,
    /// Time from which its load is NaN, s.
    pub(crate) load_fails_at: f64,
    pub(crate) horizontal_load: f64,
    /// Number of commits before the nonlinear force is NaN.
    pub(crate) commits_before_failure: usize,
}

impl DefectiveStructure {
    /// A structure without defects.
    pub(crate) fn intact() -> Self {
        Self {
            dofs: 3,
            nodes: BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]),
            mass: (0, 0, 0.0),
            stiffness: (0, 0, 0.0),
            damping: (0, 0, 0.0),
            tangent: None,
            shrinks_stiffness: false,
            load_fails_at: f64::INFINITY,
            horizontal_load: 0.0,
            commits_before_failure: usize::MAX,
        }
    }

    pub(crate) fn scene(self) -> SimulationBuilder {
        Simulation::builder(1e-3)
            .structure(self)
            .ground(bed(4))
            .interface(Bonded)
            .gravity(9.81)
    }
}

impl Structure for DefectiveStructure {
    fn dofs(&self) -> usize {
        self.dofs
    }

    fn base(&self) -> Base {
        self.nodes.clone().into()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        for i in 0..self.dofs.min(3) {
            matrix.add(i, i, 1e4);
        }
        let (row, column, value) = self.mass;
        matrix.add(row, column, value);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        let (row, column, value) = self.stiffness;
        matrix.add(row, column, value);
        if self.shrinks_stiffness {
            *matrix = Triplets::new(1);
        }
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        let (row, column, value) = self.damping;
        matrix.add(row, column, value);
        Ok(())
    }

    fn load(&self, time: f64, load: &mut [f64]) -> basemat::Result<()> {
        load[0] += self.horizontal_load;
        if time >= self.load_fails_at {
            load[0] = f64::NAN;
        }
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.tangent.is_some().then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.tangent.is_some().then_some(self)
    }
}

impl NonlinearForce for DefectiveStructure {
    fn force(&self, _: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        if self.commits_before_failure == 0 {
            force[1] = f64::NAN;
        }
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {
        self.commits_before_failure -= 1;
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        if let Some((row, column, value)) = self.tangent {
            matrix.add(row, column, value);
        }
        Ok(())
    }
}
