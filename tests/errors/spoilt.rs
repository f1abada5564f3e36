//! A structure with one thing spoilt.

use basemat::Simulation;
use basemat::coupled::SimulationBuilder;
use basemat::interface::Bonded;
use basemat::structure::{Base, BaseNode, NonlinearForce, Structure, Triplets};

use basemat_problems::block_on_springs::bed;

/// A structure of which one part is spoilt.
#[derive(Clone)]
pub(crate) struct Spoilt {
    pub(crate) dofs: usize,
    pub(crate) nodes: Vec<BaseNode>,
    pub(crate) mass: (usize, usize, f64),
    pub(crate) stiffness: (usize, usize, f64),
    pub(crate) damping: (usize, usize, f64),
    pub(crate) tangent: Option<(usize, usize, f64)>,
    pub(crate) shrinks: bool,
    pub(crate) load_from: f64,
    pub(crate) push: f64,
    /// Commits before the nonlinear force breaks.
    pub(crate) commits: usize,
}

impl Spoilt {
    pub(crate) fn sound() -> Self {
        Self {
            dofs: 3,
            nodes: BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]),
            mass: (0, 0, 0.0),
            stiffness: (0, 0, 0.0),
            damping: (0, 0, 0.0),
            tangent: None,
            shrinks: false,
            load_from: f64::INFINITY,
            push: 0.0,
            commits: usize::MAX,
        }
    }

    pub(crate) fn scene(self) -> SimulationBuilder {
        Simulation::builder(1e-3).structure(self).ground(bed(4)).interface(Bonded).gravity(9.81)
    }
}

impl Structure for Spoilt {
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
        if self.shrinks {
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
        load[0] += self.push;
        if time >= self.load_from {
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

impl NonlinearForce for Spoilt {
    fn force(&self, _: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        if self.commits == 0 {
            force[1] = f64::NAN;
        }
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {
        self.commits -= 1;
    }

    fn tangent(&self, _: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        if let Some((row, column, value)) = self.tangent {
            matrix.add(row, column, value);
        }
        Ok(())
    }
}
