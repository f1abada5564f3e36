//! Random structures of finite elements in space that bend, lift off and slide.
//!
//! Units make the soil's density and fastest wave one.

use std::collections::HashMap;

use basemat::bem::ElasticGround;
use basemat::bem::plan::Plan;
use basemat::coupled::{Coordinates, StepError};
use basemat::fem::{BeamSection, Grid, Hex8, MassKind, Material, Mesh, Shell, SpaceBeam};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Mode};
use basemat::motion::FreeField;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{FemModel, RayleighDamping};
use basemat::{Error, Simulation, Soil};

use crate::random::Random;

const STEP_COUNT: usize = 60;

/// Sines in three directions, at rest at t = 0.
#[derive(Debug, Clone)]
pub struct Sines {
    amplitudes: [f64; 3],
    frequencies: [f64; 3],
    slowness: f64,
}

impl Sines {
    /// Accelerations up to twice `gravity`, with frequencies for steps of this length.
    pub fn random(random: &mut Random, time_step: f64, gravity: f64) -> Self {
        let frequencies = [0; 3].map(|_| random.log_within(0.02, 0.4) / time_step.max(0.2));
        let accelerations =
            [1.0, 1.0, 0.5].map(|factor| factor * (random.within(-2.0, 2.0) * gravity));
        let amplitudes = std::array::from_fn(|k| accelerations[k] / frequencies[k].powi(2));
        let slowness = if random.chance(0.3) { random.within(0.0, 0.7) } else { 0.0 };
        Self { amplitudes, frequencies, slowness }
    }
}

impl FreeField for Sines {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan needs three directions")
    }

    fn displacement_at(&self, point: [f64; 2], time: f64) -> [f64; 3] {
        let time = (time - self.slowness * (point[0] + 4.0)).max(0.0);
        std::array::from_fn(|k| self.amplitudes[k] * (1.0 - (self.frequencies[k] * time).cos()))
    }
}

/// A half-space of `soil`, or by chance a damped layer of it on rock.
///
/// `layer_probability`: probability of the layer.
pub fn profile(
    random: &mut Random,
    soil: Soil,
    layer_probability: f64,
) -> Result<SoilProfile, Error> {
    if !random.chance(layer_probability) {
        return Ok(soil.into());
    }
    let rock = Soil::new(random.within(2.0, 20.0), 0.3, 1.2)?;
    let damping = GeneralizedMaxwell::constant_q(random.within(0.01, 0.1), [0.02, 2.0], 0.3)?;
    let profile = SoilProfile::on_half_plane(rock).with_layer(soil, random.within(1.0, 4.0))?;
    Ok(profile.with_damping(damping))
}

/// A mesh whose base is its lowest faces.
#[derive(Debug)]
struct RandomBuilding {
    mesh: Mesh,
    shells: Vec<Shell>,
    floor: Grid,
    counts: [usize; 2],
    material: Material,
    thickness: f64,
    height: f64,
}

/// Sides of the base.
type Sides = [f64; 2];

impl RandomBuilding {
    /// Nodes of an uneven floor.
    fn new(random: &mut Random, sides: Sides, modulus: f64) -> Result<Self, Error> {
        let counts = [random.pick(&[2, 3, 4, 5]), random.pick(&[2, 3, 4])];
        let columns = uneven_lines(random, sides[0], counts[0]);
        let rows = uneven_lines(random, sides[1], counts[1]);
        let offsets: Vec<[f64; 2]> = (0..(counts[0] + 1) * (counts[1] + 1))
            .map(|_| {
                [0, 1].map(|axis| random.within(-0.15, 0.15) * sides[axis] / counts[axis] as f64)
            })
            .collect();
        let mut mesh = Mesh::in_space();
        let floor = mesh.add_grid(counts[1] + 1, counts[0] + 1, |row, column| {
            let is_inner = row > 0 && row < counts[1] && column > 0 && column < counts[0];
            let offset = if is_inner { offsets[row * (counts[0] + 1) + column] } else { [0.0; 2] };
            [columns[column] + offset[0], rows[row] + offset[1], 0.0]
        })?;
        let poisson = random.within(0.0, 0.4);
        let thickness = random.within(0.02, 0.2) * sides[0];
        // D/(G B³) of a mat of this thickness.
        let rigidity = random.log_within(1e-5, 1.0) * modulus * sides[0].powi(3);
        let young = 12.0 * (1.0 - poisson * poisson) * rigidity / thickness.powi(3);
        let material = Material::new(young, poisson, random.log_within(0.3, 10.0))?;
        let height = random.within(0.4, 2.5);
        Ok(Self { mesh, shells: Vec::new(), floor, counts, material, thickness, height })
    }

    /// Adds a shell, or two triangles in its place.
    fn add_shell(
        &mut self,
        [a, b, c, d]: [usize; 4],
        thickness: f64,
        is_split: bool,
    ) -> Result<(), Error> {
        let faces =
            if is_split { vec![vec![a, b, c], vec![a, c, d]] } else { vec![vec![a, b, c, d]] };
        for nodes in faces {
            self.shells.push(Shell::new(nodes, self.material, thickness)?);
        }
        Ok(())
    }

    fn add_mat(&mut self, random: &mut Random) -> Result<(), Error> {
        let triangle_probability = if random.chance(0.3) { 0.4 } else { 0.0 };
        for (_, nodes) in self.floor.cells().collect::<Vec<_>>() {
            let Ok(corners) = nodes.try_into() else { continue };
            self.add_shell(corners, self.thickness, random.chance(triangle_probability))?;
        }
        Ok(())
    }

    /// Adds copies of nodes at this height.
    fn add_nodes_above(&mut self, nodes: &[usize], height: f64) -> Result<Vec<usize>, Error> {
        let points: Vec<[f64; 3]> = nodes.iter().map(|&node| self.mesh.nodes()[node]).collect();
        points.into_iter().map(|[x, y, _]| self.mesh.add_node_at([x, y, height])).collect()
    }

    /// Adds a wall on a row of the mat, and one on a column of it.
    fn add_walls(&mut self, random: &mut Random) -> Result<(), Error> {
        let row = random.pick(&[0, self.counts[1] / 2, self.counts[1]]);
        let column = random.pick(&[0, self.counts[0]]);
        let row_nodes = self.floor.row(row).to_vec();
        let column_nodes: Vec<usize> =
            (0..self.floor.rows()).map(|row| self.floor.row(row)[column]).collect();
        let thickness = random.within(0.3, 1.0) * self.thickness;
        let storeys = random.pick(&[1, 2]);
        // Nodes by the base node below them and the storey.
        let mut nodes_above: HashMap<(usize, usize), usize> = HashMap::new();
        for line in [row_nodes, column_nodes] {
            let mut lower_nodes = line.clone();
            for storey in 1..=storeys {
                let height = self.height * storey as f64 / storeys as f64;
                let mut upper_nodes = Vec::new();
                for &foot in &line {
                    // The walls share the nodes above their common node.
                    let node = match nodes_above.get(&(foot, storey)) {
                        Some(node) => *node,
                        None => self.add_nodes_above(&[foot], height)?[0],
                    };
                    nodes_above.insert((foot, storey), node);
                    upper_nodes.push(node);
                }
                for k in 0..line.len() - 1 {
                    let corners =
                        [lower_nodes[k], lower_nodes[k + 1], upper_nodes[k + 1], upper_nodes[k]];
                    self.add_shell(corners, thickness, false)?;
                }
                lower_nodes = upper_nodes;
            }
        }
        Ok(())
    }

    /// Adds columns on the corners under a roof of beams.
    fn add_frame(&mut self, random: &mut Random) -> Result<(), Error> {
        let last_row = self.floor.rows() - 1;
        let last_column = self.counts[0];
        let feet = [[0, 0], [0, last_column], [last_row, last_column], [last_row, 0]]
            .map(|[row, column]| self.floor.row(row)[column]);
        let tops = self.add_nodes_above(&feet, self.height)?;
        let side = random.within(0.5, 2.0) * self.thickness;
        let moment = side.powi(4) / 12.0;
        let section = BeamSection::new(side * side, [moment; 2], 1.6 * moment)?
            .with_shear_areas([0.8 * side * side; 2])?;
        for k in 0..4 {
            let column =
                SpaceBeam::new([feet[k], tops[k]], self.material, section, [1.0, 0.2, 0.0])?;
            self.mesh.add(column.with_rotary_inertia())?;
            let ends = [tops[k], tops[(k + 1) % 4]];
            self.mesh.add(SpaceBeam::new(ends, self.material, section, [0.0, 0.0, 1.0])?)?;
        }
        Ok(())
    }

    fn add_bricks(&mut self, random: &mut Random) -> Result<(), Error> {
        let levels = random.pick(&[1, 2, 3]);
        let heights: Vec<f64> =
            (1..=levels).map(|k| 0.5 * self.height * f64::from(k) / f64::from(levels)).collect();
        for brick in self.floor.extrude(&mut self.mesh, &heights)? {
            self.mesh.add(Hex8::new(brick, self.material))?;
        }
        Ok(())
    }

    fn model(mut self, random: &mut Random) -> Result<FemModel, Error> {
        match random.pick(&[0, 0, 1, 2]) {
            0 => {
                self.add_mat(random)?;
                self.add_walls(random)?;
            }
            1 => {
                self.add_mat(random)?;
                self.add_frame(random)?;
            }
            _ => self.add_bricks(random)?,
        }
        Shell::match_sides(&mut self.shells);
        for shell in self.shells {
            self.mesh.add(shell)?;
        }
        let damping = RayleighDamping::from_ratios([0.05, 2.0], [random.within(0.01, 0.1); 2])?;
        let kind = random.pick(&[MassKind::Consistent, MassKind::Lumped]);
        Ok(FemModel::on_base(self.mesh)?.with_mass(kind).with_rayleigh(damping))
    }
}

/// Boundaries of `count` intervals of random lengths along a side about the origin.
fn uneven_lines(random: &mut Random, side: f64, count: usize) -> Vec<f64> {
    let widths: Vec<f64> = (0..count).map(|_| random.within(0.7, 1.3)).collect();
    let total: f64 = widths.iter().sum();
    (0..=count).map(|k| side * (widths[..k].iter().sum::<f64>() / total - 0.5)).collect()
}

/// A random scene, and whether its structure is reduced.
fn scene(random: &mut Random) -> Result<(Simulation, bool), Error> {
    let soil = Soil::new(1.0, random.within(0.0, 0.45), 1.0)?;
    let profile = profile(random, soil, 0.1)?;
    let sides = [2.0, random.within(1.2, 2.0)];
    let model = RandomBuilding::new(random, sides, soil.shear_modulus())?.model(random)?;
    let cells = random.pick(&[4, 5, 6, 8]);
    let plan = Plan::under(&model, cells)?;
    let time_step = plan.pitch()[1] * random.log_within(0.1, 5.0);
    let gravity = random.log_within(1e-4, 1e-2);
    let law: Box<dyn InterfaceLaw> = match random.pick(&[0, 0, 1, 2]) {
        0 => Box::new(Coulomb::new(random.log_within(0.05, 2.0))?),
        1 => Box::new(Coulomb::new(f64::INFINITY)?),
        _ => Box::new(Bonded),
    };
    let motion = Sines::random(random, time_step, gravity);
    let is_reduced = random.chance(0.5);
    let coordinates = if is_reduced {
        random.pick(&[Coordinates::Reduced { tolerance: 1e-3 }, Coordinates::Auto])
    } else {
        Coordinates::Physical
    };
    let simulation = Simulation::builder(time_step)
        .structure(model)
        .ground(ElasticGround::in_plan(profile, plan)?)
        .interface(law)
        .motion(motion)
        .gravity(gravity)
        .coordinates(coordinates)
        .expected_steps(STEP_COUNT)
        .build()?;
    Ok((simulation, is_reduced))
}

/// Events and errors of random scenes.
#[derive(Debug, Default, Clone)]
pub struct FlexibleSceneTotals {
    pub scenes: usize,
    pub steps: usize,
    /// Number of scenes whose structure is reduced.
    pub reduced: usize,
    /// Number of steps with an open cell.
    pub open_steps: usize,
    /// Number of steps with a cell that slides.
    pub sliding_steps: usize,
    /// Scenes whose structure or step has no solution, with the reasons.
    pub errors: Vec<String>,
    /// Largest residual of an energy balance.
    pub residual: f64,
    /// Largest energy returned by the soil, relative to the largest energy.
    pub returned_energy: f64,
}

impl FlexibleSceneTotals {
    /// Runs the scene of this number; panics if the residual of an energy balance reaches 1e-9.
    pub fn run(&mut self, number: usize) {
        self.scenes += 1;
        let (mut simulation, is_reduced) = match scene(&mut Random(4711 + number as u64)) {
            Ok(built) => built,
            Err(
                error @ (Error::Preload { .. }
                | Error::Stability(_)
                | Error::CoarseBase(_)
                | Error::Accuracy { .. }),
            ) => {
                self.errors.push(format!("{number}: {error}"));
                return;
            }
            Err(error) => panic!("{number}: {error}"),
        };
        self.reduced += usize::from(is_reduced);
        for _ in 0..STEP_COUNT {
            let state = match simulation.step() {
                Ok(state) => state,
                Err(Error::Step { source: source @ StepError::Cone { .. }, step, .. }) => {
                    self.errors.push(format!("{number}, step {step}: {source}"));
                    return;
                }
                Err(error) => panic!("{number}: {error}"),
            };
            let energy = &state.energy_balance;
            assert!(energy.residual() < 1e-9, "{number}: {energy}");
            assert!(energy.soil >= -1e-9 * energy.largest, "{number}: {energy}");
            self.residual = self.residual.max(energy.residual());
            self.returned_energy = self.returned_energy.max(-energy.soil / energy.largest);
            self.steps += 1;
            self.open_steps += usize::from(state.modes.contains(&Mode::Open));
            self.sliding_steps += usize::from(state.modes.iter().any(|mode| mode.is_slip()));
        }
    }
}
