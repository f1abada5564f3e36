//! GOAL: tied nodes of soil that yields are equal displacements; a fixed base is a bonded one on stiff springs.
//! SCENE: columns of clay and sand under shear waves, on a fixed base, bonded, and with uplift.
//! REFERENCE: the constraint u = T v written by hand: Tᵀ f(T v); stiff springs.

use basemat::bem::SpringGround;
use basemat::coupled::SimulationBuilder;
use basemat::fem::{Direction, Mesh};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::{
    Base, BaseNode, DofCombination, FemModel, InternalEnergy, NonlinearForce, Structure, Triplets,
};
use basemat::{Result, Simulation};
use basemat_problems::own_force;
use basemat_problems::random::Random;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::blueprint::Blueprint;
use super::compare::relative_difference;
use super::grounds::record;
use super::models;
use super::numbers::{Numbers, RUN_STEPS};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Largest relative difference; static states are accurate to 1e-10, steps to Newton's tolerance.
const DIFFERENCE_LIMIT: f64 = 1e-7;
/// Rows of elements of a column.
const COLUMN_ROWS: usize = 4;
/// Stiffness of stiff springs, relative to that of the column's lowest element.
const STIFF_SPRING_RATIO: f64 = 1e6;
/// Largest relative difference of a base on such springs, of the order of the inverse ratio.
const STIFF_BASE_LIMIT: f64 = 1e-5;

/// Support of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Support {
    Fixed,
    Bonded,
    Uplifting,
}

impl Support {
    fn word(self) -> &'static str {
        match self {
            Self::Fixed => "fixed base",
            Self::Bonded => "bonded",
            Self::Uplifting => "Coulomb",
        }
    }
}

/// A column of one element across, without ties.
fn free_column(numbers: &Numbers, plan: &Blueprint) -> Result<FemModel> {
    let material = plan.quad_material(&PLAIN_VIEW)?;
    let y_lines: Vec<f64> =
        (0..=COLUMN_ROWS).map(|k| numbers.height * k as f64 / COLUMN_ROWS as f64).collect();
    let x_lines = [-0.5, 0.5].map(|part| part * numbers.sides[0]);
    FemModel::on_base(Mesh::quad8_block(&x_lines, &y_lines, |_, _| material.clone())?)
}

/// Pairs of nodes at both sides of a column above its base.
fn side_pairs(numbers: &Numbers, mesh: &Mesh) -> Result<Vec<[usize; 2]>> {
    let half_width = 0.5 * numbers.sides[0];
    (1..=2 * COLUMN_ROWS)
        .map(|level| {
            let height = numbers.height * level as f64 / (2 * COLUMN_ROWS) as f64;
            Ok([mesh.node_at(-half_width, height)?, mesh.node_at(half_width, height)?])
        })
        .collect()
}

/// The column with ties.
fn tied_column(numbers: &Numbers, plan: &Blueprint) -> Result<FemModel> {
    let mut column = free_column(numbers, plan)?;
    for [left, right] in side_pairs(numbers, column.mesh())? {
        column = column.with_tied_nodes(left, &[right])?;
    }
    Ok(column)
}

/// A model in fewer degrees of freedom v, of which each displacement is one: u = T v.
struct Constrained {
    model: FemModel,
    /// Degree of freedom v of each displacement u.
    reduced_dofs: Vec<usize>,
    dof_count: usize,
}

impl Constrained {
    /// The model whose pairs of nodes have equal displacements.
    fn new(model: FemModel, pairs: &[[usize; 2]]) -> Self {
        let mut leaders: Vec<usize> = (0..model.dofs()).collect();
        for [left, right] in pairs {
            for direction in [Direction::X, Direction::Y] {
                let leader = model.dof(*left, direction).unwrap();
                leaders[model.dof(*right, direction).unwrap()] = leader;
            }
        }
        let mut reduced_dofs = vec![usize::MAX; model.dofs()];
        let mut dof_count = 0;
        for dof in (0..model.dofs()).filter(|dof| leaders[*dof] == *dof) {
            reduced_dofs[dof] = dof_count;
            dof_count += 1;
        }
        for dof in 0..model.dofs() {
            reduced_dofs[dof] = reduced_dofs[leaders[dof]];
        }
        Self { model, reduced_dofs, dof_count }
    }

    /// T v.
    fn full(&self, reduced_displacement: &[f64]) -> Vec<f64> {
        self.reduced_dofs.iter().map(|dof| reduced_displacement[*dof]).collect()
    }

    /// Adds Tᵀ A T.
    fn add_reduced(&self, full_matrix: &Triplets, matrix: &mut Triplets) {
        for &(row, column, value) in full_matrix.entries() {
            matrix.add(self.reduced_dofs[row], self.reduced_dofs[column], value);
        }
    }

    fn reduced_row(&self, row: &DofCombination) -> DofCombination {
        row.iter().map(|&(dof, weight)| (self.reduced_dofs[dof], weight)).collect()
    }

    fn force_of_model(&self) -> &dyn NonlinearForce {
        self.model.nonlinear().expect("the column yields")
    }
}

impl Structure for Constrained {
    fn dofs(&self) -> usize {
        self.dof_count
    }

    fn base(&self) -> Base {
        let base = self.model.base();
        let nodes = base.nodes().map(|node| BaseNode {
            horizontal: self.reduced_row(&node.horizontal),
            vertical: self.reduced_row(&node.vertical),
            ..node.clone()
        });
        nodes.collect::<Vec<_>>().into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        let mut full_matrix = Triplets::new(self.model.dofs());
        self.model.mass(&mut full_matrix)?;
        self.add_reduced(&full_matrix, matrix);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        let mut full_matrix = Triplets::new(self.model.dofs());
        self.model.stiffness(&mut full_matrix)?;
        self.add_reduced(&full_matrix, matrix);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for Constrained {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        let mut full_force = vec![0.0; self.model.dofs()];
        self.force_of_model().force(&self.full(displacement), &mut full_force)?;
        for (dof, value) in self.reduced_dofs.iter().zip(full_force) {
            force[*dof] += value;
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        let mut full_matrix = Triplets::new(self.model.dofs());
        self.force_of_model().tangent(&self.full(displacement), &mut full_matrix)?;
        self.add_reduced(&full_matrix, matrix);
        Ok(())
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.force_of_model().has_symmetric_tangent()
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.force_of_model().energy(&self.full(displacement))
    }

    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        self.force_of_model().remainder(&self.full(midstep), &self.full(end))
    }

    fn commit(&mut self, displacement: &[f64]) {
        let displacement = self.full(displacement);
        if let Some(force) = self.model.nonlinear_mut() {
            force.commit(&displacement);
        }
    }
}

/// A scene of a column on springs, or on a fixed base.
fn column_scene(
    numbers: &Numbers,
    structure: impl Structure + 'static,
    support: Support,
    stiffness: f64,
) -> Result<SimulationBuilder> {
    let builder = Simulation::builder(numbers.time_step)
        .gravity(SCENE_GRAVITY)
        .ground(SpringGround::under(&structure, 4, 2.0 * stiffness, 1.5 * stiffness)?)
        .structure(structure)
        .motion(record(numbers, numbers.peaks[0], &PLAIN_VIEW)?);
    Ok(match support {
        Support::Fixed => builder.interface(Bonded).on_fixed_base(),
        Support::Bonded => builder.interface(Bonded),
        Support::Uplifting => builder.interface(Coulomb::new(numbers.friction)?),
    })
}

/// Forces under the base and energies of all steps.
struct ColumnResults {
    forces: Vec<f64>,
    energies: Vec<f64>,
    /// Part of the input that the soil dissipates.
    plastic_fraction: f64,
}

fn column_results(numbers: &Numbers, builder: SimulationBuilder) -> Result<ColumnResults> {
    let mut simulation = builder.build()?;
    let mut forces = Vec::new();
    let mut energies = Vec::new();
    for _ in 0..RUN_STEPS {
        let state = simulation.step()?;
        let moment = state.base_moment / numbers.sides[0];
        forces.extend([state.base_shear, state.normal_force, moment]);
        let energy_balance = state.energy_balance;
        energies.extend([energy_balance.kinetic, energy_balance.strain]);
        energies.extend([energy_balance.hysteresis, energy_balance.midstep_remainder]);
    }
    let energy_balance = simulation.state().energy_balance;
    let plastic_fraction = energy_balance.hysteresis / energy_balance.largest;
    Ok(ColumnResults { forces, energies, plastic_fraction })
}

/// Soil of a column.
fn soil(numbers: &Numbers, random: &mut Random) -> Blueprint {
    if random.chance(0.5) { models::clay(numbers) } else { models::sand(numbers) }
}

/// GOAL: `with_tied_nodes` is the constraint of equal displacements.
#[test]
fn ties_are_equal_displacements() {
    let mut tally = IdentityTally::new("yielding soil: ties, and constraints by hand");
    let mut random = Random(181);
    let mut largest_plastic_fraction = 0.0_f64;
    for number in 0..scenes(12, 200) {
        let numbers = Numbers::draw(random.bits());
        let plan = soil(&numbers, &mut random);
        let support = [Support::Fixed, Support::Bonded, Support::Uplifting][number % 3];
        let stiffness = numbers.modulus / numbers.sides[0];
        tally.scene(&["tied column", support.word(), "springs"]);
        let tied_column = tied_column(&numbers, &plan)
            .and_then(|column| column_scene(&numbers, column, support, stiffness))
            .and_then(|builder| column_results(&numbers, builder));
        let by_hand = free_column(&numbers, &plan)
            .and_then(|column| {
                let pairs = side_pairs(&numbers, column.mesh())?;
                column_scene(&numbers, Constrained::new(column, &pairs), support, stiffness)
            })
            .and_then(|builder| column_results(&numbers, builder));
        let place = format!("{number}: {support:?}, {:?}, {:.2?} m", plan.quad_law, numbers.sides);
        tally.compare(&place, [tied_column, by_hand], |tally, expected, computed| {
            let difference = relative_difference(&expected.forces, &computed.forces);
            tally.within(&format!("forces, {place}"), difference, DIFFERENCE_LIMIT);
            let difference = relative_difference(&expected.energies, &computed.energies);
            tally.within(&format!("energies, {place}"), difference, DIFFERENCE_LIMIT);
            largest_plastic_fraction = largest_plastic_fraction.max(expected.plastic_fraction);
        });
    }
    assert!(largest_plastic_fraction > 0.05, "{largest_plastic_fraction}: hardly any scene yields");
    tally.close(0.75);
}

/// GOAL: a fixed base is the limit of a bonded one on stiff springs.
#[test]
fn fixed_bases_are_bonded_to_stiff_springs() {
    let mut tally = IdentityTally::new("yielding soil: fixed, and on stiff springs");
    let mut random = Random(182);
    for number in 0..scenes(8, 100) {
        let numbers = Numbers::draw(random.bits());
        let plan = soil(&numbers, &mut random);
        let element_height = numbers.height / COLUMN_ROWS as f64;
        let stiffness = STIFF_SPRING_RATIO * plan.young / element_height;
        tally.scene(&["tied column", "fixed base", "bonded", "springs"]);
        let results = [Support::Fixed, Support::Bonded].map(|support| {
            let column = tied_column(&numbers, &plan)?;
            column_results(&numbers, column_scene(&numbers, column, support, stiffness)?)
        });
        let place = format!("{number}: {:?}, {:.2?} m", plan.quad_law, numbers.sides);
        tally.compare(&place, results, |tally, expected, computed| {
            let difference = relative_difference(&expected.forces, &computed.forces);
            tally.within(&format!("forces, {place}"), difference, STIFF_BASE_LIMIT);
        });
    }
    tally.close(0.75);
}
