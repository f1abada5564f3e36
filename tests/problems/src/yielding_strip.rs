//! Rigid rough strip on soil that yields: mean pressure by settlement, in static steps on half of the soil.
//!
//! Mesh, steps and reference pressures: `tests/data/yielding/strip_capacity.md`.

use basemat::fem::{Direction, DruckerPrager, Iwan, Material, Mesh, SharedMaterial};
use basemat::structure::{FemModel, Structure};

use super::static_steps::StaticSteps;

/// Difference of coordinates that count as equal, m; the smallest element is far larger.
const COORDINATE_TOLERANCE: f64 = 1e-9;

/// Settlements of the reference pressures, m.
pub const REFERENCE_SETTLEMENTS: [f64; 6] = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
/// Reference pressures on clay with 8 elements, Pa.
pub const CLAY_PRESSURES: [f64; 6] = [3.9147, 4.6523, 4.9730, 5.1446, 5.2442, 5.3077];
/// Reference pressure on clay with 16 elements, at the last settlement, Pa.
pub const FINE_CLAY_PRESSURE: f64 = 5.192;
/// Reference pressures on sand with 6 elements, Pa.
pub const SAND_PRESSURES: [f64; 6] = [88.25, 151.70, 199.36, 221.50, 226.13, 227.35];

/// Weightless clay of the reference: shear modulus 100, strength 1 at a shear strain of 20 strength/modulus.
pub fn clay() -> Iwan {
    let shear_modulus = 100.0;
    let strength = 1.0;
    Iwan::hyperbolic(shear_modulus, strength, 20.0 * strength / shear_modulus, 0.49, 0.0).unwrap()
}

/// Weightless sand of the reference: shear modulus 2000, cohesion 1, friction and dilation angle 30°.
pub fn sand() -> DruckerPrager {
    let poisson = 0.3;
    let elastic = Material::new(2.0 * (1.0 + poisson) * 2000.0, poisson, 0.0).unwrap();
    let angle = 30.0_f64.to_radians();
    DruckerPrager::new(elastic, 1.0, angle, angle).unwrap()
}

/// Half of the soil under a rigid rough strip of half width 1 m.
#[derive(Debug, Clone, Copy)]
pub struct StripSoil {
    /// Ratio of the widths of neighbouring columns beside the strip.
    pub width_ratio: f64,
    /// Bound of the sum of these widths, m.
    pub graded_width: f64,
    /// Coordinate of the side, m.
    pub width: f64,
    /// Ratio of the heights of neighbouring rows.
    pub height_ratio: f64,
    /// Bound of the sum of these heights, m.
    pub graded_depth: f64,
    /// Depth of the bottom, m.
    pub depth: f64,
    /// Pressure on the whole surface, also under the strip, Pa.
    pub surcharge: f64,
}

impl StripSoil {
    /// Soil of the reference on clay.
    pub const CLAY_BOX: Self = Self {
        width_ratio: 1.25,
        graded_width: 4.5,
        width: 6.0,
        height_ratio: 1.2,
        graded_depth: 3.0,
        depth: 4.0,
        surcharge: 0.0,
    };
    /// Soil of the reference on sand.
    pub const SAND_BOX: Self = Self {
        width_ratio: 1.25,
        graded_width: 8.0,
        width: 10.0,
        height_ratio: 1.25,
        graded_depth: 4.0,
        depth: 6.0,
        surcharge: 10.0,
    };

    /// Vertical lines of the mesh with `strip_elements` under the strip, m.
    fn x_lines(&self, strip_elements: usize) -> Vec<f64> {
        let width = 1.0 / strip_elements as f64;
        let mut lines: Vec<f64> = (0..strip_elements).map(|k| k as f64 * width).collect();
        let distances = graded_distances(width, self.width_ratio, self.graded_width);
        lines.extend(distances.iter().map(|distance| 1.0 + distance));
        lines.push(self.width);
        lines
    }

    /// Horizontal lines of the mesh from the bottom to the surface at zero, m.
    fn y_lines(&self, strip_elements: usize) -> Vec<f64> {
        let height = 1.0 / strip_elements as f64;
        let mut lines = vec![-self.depth];
        let distances = graded_distances(height, self.height_ratio, self.graded_depth);
        lines.extend(distances.iter().rev().map(|distance| -distance));
        lines
    }

    /// Pushes the strip down in `steps` equal steps of settlement.
    pub fn push_down(
        &self,
        soil: impl Into<SharedMaterial>,
        strip_elements: usize,
        settlement_step: f64,
        steps: usize,
    ) -> StripRun {
        let soil = soil.into();
        let x_lines = self.x_lines(strip_elements);
        let y_lines = self.y_lines(strip_elements);
        let mesh = Mesh::quad8_block(&x_lines, &y_lines, |_, _| soil.clone()).unwrap();
        let model = FemModel::on_base(mesh).unwrap();
        let strip_rows = strip_rows(&model);
        let mut supports = self.supports(&model);
        let mut static_steps = StaticSteps::new(&model, &supports);
        if self.surcharge > 0.0 {
            static_steps.load = self.surcharge_forces(&model, &x_lines);
            static_steps.advance(&[]);
        }
        supports.extend(&strip_rows);
        static_steps.fix(&supports);
        let motion: Vec<(usize, f64)> =
            strip_rows.iter().map(|&row| (row, -settlement_step)).collect();
        let mut pressures = Vec::with_capacity(steps);
        let mut iterations = 0;
        for _ in 0..steps {
            iterations += static_steps.advance(&motion);
            // The half width is 1 m.
            pressures.push(-strip_rows.iter().map(|&row| static_steps.force[row]).sum::<f64>());
        }
        StripRun { settlement_step, pressures, iterations }
    }

    /// Degrees of freedom that are always fixed: horizontally also at the sides and under the strip.
    fn supports(&self, model: &FemModel) -> Vec<usize> {
        let mut supports = Vec::new();
        for (node, &[x, y, _]) in model.mesh().nodes().iter().enumerate() {
            let is_bottom = y < -self.depth + COORDINATE_TOLERANCE;
            let is_side = x < COORDINATE_TOLERANCE || x > self.width - COORDINATE_TOLERANCE;
            if is_bottom || is_side || is_under_strip(x, y) {
                supports.extend(model.dof(node, Direction::X));
            }
            if is_bottom {
                supports.extend(model.dof(node, Direction::Y));
            }
        }
        supports
    }

    /// Nodal forces of the surcharge: 1/6, 4/6 and 1/6 of the force on each edge of an element.
    fn surcharge_forces(&self, model: &FemModel, x_lines: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; model.dofs()];
        for ends in x_lines.windows(2) {
            let middle = 0.5 * (ends[0] + ends[1]);
            for (x, weight) in [(ends[0], 1.0), (middle, 4.0), (ends[1], 1.0)] {
                let node = model.mesh().node_at(x, 0.0).unwrap();
                let dof = model.dof(node, Direction::Y).unwrap();
                forces[dof] -= self.surcharge * (ends[1] - ends[0]) * weight / 6.0;
            }
        }
        forces
    }
}

/// Distances from zero of lines between elements that grow by a ratio, as long as they stay below a bound.
pub(crate) fn graded_distances(first_size: f64, ratio: f64, bound: f64) -> Vec<f64> {
    let mut distances = vec![0.0];
    let mut size = first_size;
    let mut distance = size;
    while distance < bound {
        distances.push(distance);
        size *= ratio;
        distance += size;
    }
    distances
}

fn is_under_strip(x: f64, y: f64) -> bool {
    y > -COORDINATE_TOLERANCE && x < 1.0 + COORDINATE_TOLERANCE
}

/// Vertical degrees of freedom under the strip.
fn strip_rows(model: &FemModel) -> Vec<usize> {
    let nodes = model.mesh().nodes().iter().enumerate();
    nodes
        .filter(|(_, point)| is_under_strip(point[0], point[1]))
        .filter_map(|(node, _)| model.dof(node, Direction::Y))
        .collect()
}

/// Mean pressures under a strip that was pushed down.
#[derive(Debug, Clone)]
pub struct StripRun {
    /// Settlement of a step, m.
    pub settlement_step: f64,
    /// Mean pressure at the end of each step, Pa.
    pub pressures: Vec<f64>,
    /// Number of iterations of all steps.
    pub iterations: usize,
}

impl StripRun {
    /// Mean pressures at the reference settlements, Pa.
    pub fn reference_pressures(&self) -> [f64; 6] {
        REFERENCE_SETTLEMENTS.map(|settlement| {
            let mut steps = self.pressures.iter().enumerate();
            let at_settlement =
                steps.find(|(step, _)| (*step as f64 + 1.5) * self.settlement_step > settlement);
            at_settlement.map_or(f64::NAN, |(_, pressure)| *pressure)
        })
    }
}
