//! Rigid rough strip without tension on clay, rotated under a constant vertical force.
//!
//! Mesh, steps and reference moments: `tests/data/yielding/moment_capacity.md`. The strip stands on the soil by a joint, with
//! two contact elements on each edge of an element of the soil. Steps of the θ-method with θ = 1 and almost no mass are
//! static steps. A stiff spring turns the strip: its far end has the prescribed rotation.

use std::f64::consts::PI;

use basemat::bem::SpringGround;
use basemat::coupled::{Joint, Load, Theta};
use basemat::fem::{Direction, Element, LumpedMass, MassKind, Mesh, Spring};
use basemat::interface::{Bonded, Coulomb};
use basemat::structure::FemModel;
use basemat::{Result, Simulation};

use super::yielding_strip::{clay, graded_distances};

/// Half width of the strip, m.
pub const HALF_WIDTH: f64 = 1.0;
/// Capacity under a central force, N/m: 2 (2 + π) times the strength of 1 Pa.
pub const CENTRAL_CAPACITY: f64 = 2.0 * HALF_WIDTH * (2.0 + PI);
/// Rotation of a step, rad.
pub const ROTATION_STEP: f64 = 0.001;
/// Numbers of steps up to the reference moments.
pub const REFERENCE_STEPS: [usize; 4] = [10, 20, 40, 60];

/// Friction of the rough strip: with more, its moments change by less than 1 %, and some steps do not converge.
const FRICTION_COEFFICIENT: f64 = 1.0;
/// Steps in which the vertical force grows.
const FORCE_STEPS: usize = 10;
/// Distance of the sides from the middle, m.
const SIDE_DISTANCE: f64 = 5.0;
/// Depth of the bottom, m.
const BOTTOM_DEPTH: f64 = 3.4;
/// Ratio of the sizes of neighbouring elements.
const SIZE_RATIO: f64 = 1.3;
/// Bounds of the sums of these sizes, m.
const GRADED_WIDTH: f64 = 3.3;
const GRADED_DEPTH: f64 = 2.4;
/// Stiffness of supports and of the spring that turns the strip, N/m and N m/rad.
const SUPPORT_STIFFNESS: f64 = 1e7;
/// Distance of coordinates that count as equal, m.
const COORDINATE_TOLERANCE: f64 = 1e-9;
/// Mass of each node of the strip, kg: its inertia is negligible beside the stiffness of the soil.
const NODE_MASS: f64 = 1e-4;
/// Mass of the middle of the bottom, kg: without the ground, the soil resists translations by its inertia alone.
const BOTTOM_MASS: f64 = 1e6;
const TIME_STEP: f64 = 1.0;

/// A strip: number of elements of the soil under its half, and its safety factor N_u/N.
#[derive(Debug, Clone, Copy)]
pub struct RotatedStrip {
    pub half_elements: usize,
    pub safety_factor: f64,
}

/// State of the strip at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct StripState {
    /// Rotation, rad.
    pub rotation: f64,
    /// Moment about the middle, N m/m.
    pub moment: f64,
    /// Settlement of the middle, m.
    pub settlement: f64,
    /// Part of the strip in contact.
    pub closed_fraction: f64,
}

/// Strips of the reference, and their moments after the reference steps, over (N B/2)(1 − N/N_u).
pub const REFERENCE_MOMENTS: [(RotatedStrip, [f64; 4]); 6] = [
    (strip(4, 2.0), [0.479, 0.713, 0.923, 1.016]),
    (strip(4, 3.0), [0.646, 0.847, 0.982, 1.034]),
    (strip(4, 5.0), [0.827, 0.947, 1.020, 1.043]),
    (strip(8, 2.0), [0.439, 0.654, 0.852, 0.940]),
    (strip(8, 3.0), [0.604, 0.800, 0.929, 0.979]),
    (strip(8, 5.0), [0.792, 0.908, 0.978, 1.005]),
];

const fn strip(half_elements: usize, safety_factor: f64) -> RotatedStrip {
    RotatedStrip { half_elements, safety_factor }
}

/// Spring against the rotation of a node.
#[derive(Debug, Clone)]
struct RotationSpring {
    node: usize,
}

impl Element for RotationSpring {
    fn nodes(&self) -> &[usize] {
        std::slice::from_ref(&self.node)
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::Rotation]
    }

    fn stiffness(&self, _coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        matrix[0] += SUPPORT_STIFFNESS;
    }

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}
}

impl RotatedStrip {
    /// Vertical force, N/m.
    pub fn force(&self) -> f64 {
        CENTRAL_CAPACITY / self.safety_factor
    }

    /// Moment capacity (N B/2)(1 − N/N_u) of the effective width, N m/m.
    pub fn moment_capacity(&self) -> f64 {
        self.force() * HALF_WIDTH * (1.0 - 1.0 / self.safety_factor)
    }

    /// Size of an element under the strip, m.
    fn element_size(&self) -> f64 {
        HALF_WIDTH / self.half_elements as f64
    }

    /// Vertical lines of the mesh, m.
    fn x_lines(&self) -> Vec<f64> {
        let size = self.element_size();
        let mut right: Vec<f64> = (1..self.half_elements).map(|k| k as f64 * size).collect();
        let distances = graded_distances(size, SIZE_RATIO, GRADED_WIDTH);
        right.extend(distances.iter().map(|distance| HALF_WIDTH + distance));
        right.push(SIDE_DISTANCE);
        let left = right.iter().rev().map(|x| -x);
        left.chain([0.0]).chain(right.iter().copied()).collect()
    }

    /// Horizontal lines of the mesh from the bottom at zero to the surface, m.
    fn y_lines(&self) -> Vec<f64> {
        let distances = graded_distances(self.element_size(), SIZE_RATIO, GRADED_DEPTH);
        let rows = distances.iter().rev().map(|distance| BOTTOM_DEPTH - distance);
        std::iter::once(0.0).chain(rows).collect()
    }

    /// The soil on its supports with the strip above it, and the middle of the strip.
    fn model(&self) -> Result<(FemModel, usize)> {
        let soil = clay();
        let mut mesh = Mesh::quad8_block(&self.x_lines(), &self.y_lines(), |_, _| soil.clone())?;
        let points = mesh.nodes().to_vec();
        // All supports are springs to the middle of the bottom, so that the soil can follow the ground.
        let bottom_middle = mesh.node_at(0.0, 0.0)?;
        for (node, [x, y, _]) in points.into_iter().enumerate() {
            if node == bottom_middle {
                continue;
            }
            let is_bottom = y < COORDINATE_TOLERANCE;
            let ends = [bottom_middle, node];
            if is_bottom || x.abs() > SIDE_DISTANCE - COORDINATE_TOLERANCE {
                mesh.add(Spring::new(ends, Direction::X, SUPPORT_STIFFNESS)?)?;
            }
            if is_bottom {
                mesh.add(Spring::new(ends, Direction::Y, SUPPORT_STIFFNESS)?)?;
            }
        }
        mesh.add(LumpedMass::new(bottom_middle, BOTTOM_MASS)?)?;
        let middle = mesh.add_node(0.0, BOTTOM_DEPTH)?;
        mesh.add(RotationSpring { node: middle })?;
        let ends =
            [mesh.add_node(-HALF_WIDTH, BOTTOM_DEPTH)?, mesh.add_node(HALF_WIDTH, BOTTOM_DEPTH)?];
        for node in [middle, ends[0], ends[1]] {
            mesh.add(LumpedMass::new(node, NODE_MASS)?)?;
        }
        Ok((FemModel::on_base(mesh)?.with_rigid_link(middle, &ends)?, middle))
    }

    /// The joint between the strip and the soil, with two elements on each edge of an element.
    fn joint(&self, model: &FemModel, middle: usize) -> Result<Joint> {
        let under_strip = |(_, [x, y, _]): &(usize, &[f64; 3])| {
            *y > BOTTOM_DEPTH - COORDINATE_TOLERANCE && x.abs() < HALF_WIDTH + COORDINATE_TOLERANCE
        };
        let nodes = model.mesh().nodes();
        let points = nodes.iter().enumerate().take(middle).filter(under_strip);
        let mut soil_nodes: Vec<usize> = points.map(|(node, _)| node).collect();
        soil_nodes.sort_by(|a, b| nodes[*a][0].total_cmp(&nodes[*b][0]));
        let upper = model.contact_nodes(&[middle + 1, middle, middle + 2])?;
        let lower = model.contact_nodes(&soil_nodes)?;
        let joint = Joint::between(upper, lower, 4 * self.half_elements)?;
        Ok(joint.with_law(Coulomb::new(FRICTION_COEFFICIENT)?))
    }

    /// Presses the strip down, then turns it to one rotation (rad) after the other; the state at each of them.
    pub fn turn(&self, rotations: &[f64]) -> Result<Vec<StripState>> {
        let (model, middle) = self.model()?;
        let joint = self.joint(&model, middle)?;
        let force = self.force();
        let down = -1.0 * model.row(middle, Direction::Y)?;
        let rotation = model.row(middle, Direction::Rotation)?;
        let step_count = FORCE_STEPS + rotations.len();
        let times: Vec<f64> = (0..=step_count).map(|step| step as f64 * TIME_STEP).collect();
        let mut forces = vec![force; step_count + 1];
        for (step, value) in forces.iter_mut().take(FORCE_STEPS).enumerate() {
            *value *= step as f64 / FORCE_STEPS as f64;
        }
        let mut far_moments = vec![0.0; FORCE_STEPS + 1];
        far_moments.extend(rotations.iter().map(|angle| SUPPORT_STIFFNESS * angle));
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(SpringGround::under(&model, 8, SUPPORT_STIFFNESS, SUPPORT_STIFFNESS)?)
            .structure(model)
            .interface(Bonded)
            .joint(joint)
            .gravity(0.0)
            .scheme(Theta::new(1.0)?)
            .load(Load::table(down.clone(), &times, &forces)?)
            .load(Load::table(rotation.clone(), &times, &far_moments)?)
            .build()?;
        let mut states = Vec::with_capacity(rotations.len());
        let mut step = 0;
        simulation.run(step_count, |state| {
            if step >= FORCE_STEPS {
                let angle = rotation.value(state.displacement());
                states.push(StripState {
                    rotation: angle,
                    moment: SUPPORT_STIFFNESS * (rotations[step - FORCE_STEPS] - angle),
                    settlement: down.value(state.displacement()),
                    closed_fraction: 1.0 - state.joints[0].open_fraction,
                });
            }
            step += 1;
        })?;
        Ok(states)
    }

    /// Moments after the reference steps over the capacity of the effective width.
    pub fn relative_moments(&self) -> Result<[f64; 4]> {
        let steps = 1..=REFERENCE_STEPS[3];
        let rotations: Vec<f64> = steps.map(|step| step as f64 * ROTATION_STEP).collect();
        let states = self.turn(&rotations)?;
        Ok(REFERENCE_STEPS.map(|step| states[step - 1].moment / self.moment_capacity()))
    }
}
