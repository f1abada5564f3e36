//! Forces and probes of a structure whose responses reduced coordinates must represent.

use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::error::Result;
use crate::linalg::matrix::dense_vector;

/// Number of intervals between the samples of the structure's load.
const LOAD_INTERVAL_COUNT: u32 = 16;

/// Rows of forces and of probes, with a weight for each degree of freedom.
#[derive(Default)]
pub(crate) struct ResponseRows {
    /// All rows, one after the other.
    ///
    /// Loads, other forces, displacements and velocities of probes, accelerations of probes.
    pub(crate) all_rows: Vec<f64>,
    /// Number of loads, which are the first rows.
    pub(crate) load_count: usize,
    /// Number of all forces, loads included.
    pub(crate) force_count: usize,
    /// Index of the first row of an acceleration.
    pub(crate) first_acceleration: usize,
    /// Rows of displacement, velocity and acceleration of each probe.
    ///
    /// `None` for a row of zeros.
    pub(crate) probes: Vec<[Option<usize>; 3]>,
}

impl ResponseRows {
    /// Collects loads, tractions, initial motions and probes for a run of `step_count` steps.
    pub(super) fn new(parts: &Parts, assembled: &Assembled, step_count: usize) -> Result<Self> {
        let mut rows = Self::default();
        rows.add_loads(parts, assembled.dofs(), step_count)?;
        rows.add_tractions(assembled);
        rows.add_initial_momenta(parts, assembled);
        rows.add_probes(parts, assembled.dofs());
        Ok(rows)
    }

    /// Adds the builder's loads, and samples of the structure's load.
    fn add_loads(&mut self, parts: &Parts, dofs: usize, step_count: usize) -> Result<()> {
        for load in &parts.builder.loads {
            push_nonzero(&mut self.all_rows, dense_vector(load.row(), dofs));
        }
        let duration = step_count as f64 * parts.builder.time_step;
        for sample in 0..=LOAD_INTERVAL_COUNT {
            let time = duration * f64::from(sample) / f64::from(LOAD_INTERVAL_COUNT);
            let mut load = vec![0.0; dofs];
            let result = parts.structure.load(time, &mut load);
            if sample == 0 {
                result?;
            } else if result.is_err() {
                // The run may end before that time.
                continue;
            }
            if load.iter().all(|force| force.is_finite()) {
                push_nonzero(&mut self.all_rows, load);
            }
        }
        self.load_count = self.all_rows.len() / dofs;
        Ok(())
    }

    /// Adds the forces of a unit traction in each component of each element.
    fn add_tractions(&mut self, assembled: &Assembled) {
        let component_count = assembled.base.layout().len();
        let mut unit_traction = vec![0.0; component_count];
        for i in 0..component_count {
            let mut force = vec![0.0; assembled.dofs()];
            unit_traction[i] = 1.0;
            assembled.base.add_forces(1.0, &unit_traction, &mut force);
            unit_traction[i] = 0.0;
            push_nonzero(&mut self.all_rows, force);
        }
    }

    /// Adds the momenta of the initial displacement and velocity.
    fn add_initial_momenta(&mut self, parts: &Parts, assembled: &Assembled) {
        let dofs = assembled.dofs();
        for initial_values in [&parts.builder.initial_displacement, &parts.builder.initial_velocity]
        {
            for motion in initial_values.chunks_exact(dofs) {
                let mut force = vec![0.0; dofs];
                assembled.mass.multiply_add(1.0, motion, &mut force);
                push_nonzero(&mut self.all_rows, force);
            }
        }
        self.force_count = self.all_rows.len() / dofs;
    }

    /// Adds the rows of the probes: first displacements, then velocities, then accelerations.
    fn add_probes(&mut self, parts: &Parts, dofs: usize) {
        let probes = &parts.builder.probes;
        self.probes = vec![[None; 3]; probes.len()];
        for derivative in 0..3 {
            if derivative == 2 {
                self.first_acceleration = self.all_rows.len() / dofs;
            }
            for (probe, probe_rows) in probes.iter().zip(&mut self.probes) {
                let row = self.all_rows.len() / dofs;
                let is_nonzero =
                    push_nonzero(&mut self.all_rows, dense_vector(probe.rows()[derivative], dofs));
                probe_rows[derivative] = is_nonzero.then_some(row);
            }
        }
    }
}

/// Adds a row unless it is zero; returns whether it was added.
fn push_nonzero(rows: &mut Vec<f64>, row: Vec<f64>) -> bool {
    let is_nonzero = row.iter().any(|value| *value != 0.0);
    if is_nonzero {
        rows.extend(row);
    }
    is_nonzero
}
