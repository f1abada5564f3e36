//! Benchmarks of bricks: cantilevers, a thick cylinder, thick plates.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Direction, Hex8, Material, Spring};

use crate::supported::{HINGED_DIRECTIONS, NodalLoad, SupportedMesh, X, Y, Z};

/// Corners of the distorted brick of `tests/data/elements`.
pub const DISTORTED_BRICK: [[f64; 3]; 8] = [
    [0.12, -0.12, 0.06],
    [1.152, 0.036, 0.12],
    [1.2, 1.12, -0.12],
    [0.096, 1.024, 0.036],
    [-0.12, -0.084, 1.548],
    [1.236, -0.024, 1.428],
    [1.26, 1.108, 1.512],
    [-0.024, 1.072, 1.392],
];

/// Bricks whose nodes stand in a grid.
#[derive(Debug)]
pub struct BrickGrid {
    pub scene: SupportedMesh,
    pub counts: [usize; 3],
}

impl BrickGrid {
    /// Bricks between nodes whose positions follow from their indices.
    pub fn new(
        counts: [usize; 3],
        material: Material,
        node_position: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Self {
        let mut block = Self { scene: SupportedMesh::new(), counts };
        for i in 0..=counts[0] {
            for j in 0..=counts[1] {
                for k in 0..=counts[2] {
                    block.scene.node(node_position([i, j, k]));
                }
            }
        }
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                for k in 0..counts[2] {
                    let nodes = block.corners([i, j, k]);
                    block.scene.add(Hex8::new(nodes, material));
                }
            }
        }
        block
    }

    /// A block whose first section is fixed.
    pub fn cantilever(
        counts: [usize; 3],
        material: Material,
        node_position: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Self {
        let mut block = Self::new(counts, material, node_position);
        for (node, _) in block.section(0) {
            block.scene.fix(node, &HINGED_DIRECTIONS);
        }
        block
    }

    /// Number of a node.
    pub fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * (self.counts[1] + 1) + j) * (self.counts[2] + 1) + k
    }

    /// Nodes of a brick.
    pub fn corners(&self, [i, j, k]: [usize; 3]) -> [usize; 8] {
        [
            [i, j, k],
            [i + 1, j, k],
            [i + 1, j + 1, k],
            [i, j + 1, k],
            [i, j, k + 1],
            [i + 1, j, k + 1],
            [i + 1, j + 1, k + 1],
            [i, j + 1, k + 1],
        ]
        .map(|index| self.node(index))
    }

    /// Nodes of the section at a column of the first index, with their fractions of its area.
    pub fn section(&self, i: usize) -> Vec<(usize, f64)> {
        let ny = self.counts[1];
        let nz = self.counts[2];
        let mut nodes = Vec::new();
        for j in 0..=ny {
            for k in 0..=nz {
                let fraction = nodal_fraction(j, ny) * nodal_fraction(k, nz);
                nodes.push((self.node([i, j, k]), fraction));
            }
        }
        nodes
    }

    /// A unit force spread over the last section.
    pub fn tip_force(&self, direction: Direction) -> Vec<NodalLoad> {
        let tip = self.section(self.counts[0]).into_iter();
        tip.map(|(node, fraction)| (node, direction, fraction)).collect()
    }

    /// Forces of a pressure (Pa) downwards on a level quadrilateral, with 2 × 2 points.
    fn pressure(&self, nodes: [usize; 4], pressure: f64) -> Vec<NodalLoad> {
        const CORNER_SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let points = self.scene.points(&nodes);
        let mut loads = Vec::new();
        for signs in CORNER_SIGNS {
            let xi = signs[0] / 3.0_f64.sqrt();
            let eta = signs[1] / 3.0_f64.sqrt();
            let mut tangent = [[0.0; 2]; 2];
            for ([a, b], point) in CORNER_SIGNS.iter().zip(&points) {
                for axis in 0..2 {
                    tangent[0][axis] += 0.25 * a * (1.0 + b * eta) * point[axis];
                    tangent[1][axis] += 0.25 * b * (1.0 + a * xi) * point[axis];
                }
            }
            let area = tangent[0][0] * tangent[1][1] - tangent[0][1] * tangent[1][0];
            for ([a, b], node) in CORNER_SIGNS.iter().zip(nodes) {
                let shape = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
                loads.push((node, Z, -pressure * area * shape));
            }
        }
        loads
    }
}

/// Fraction of a side's length that belongs to the node `k` of `count` elements.
fn nodal_fraction(k: usize, count: usize) -> f64 {
    let elements = if k == 0 || k == count { 0.5 } else { 1.0 };
    elements / count as f64
}

/// Deflections of the straight cantilever of `MacNeal` & Harder under unit forces along x, y, z and a unit torque.
///
/// Sections between its ends slant by two signs in turn: rectangles, parallelograms or trapezoids.
pub fn straight_cantilever(count: usize, signs: [f64; 2]) -> [f64; 4] {
    let material = Material::new(1.0e7, 0.3, 0.0).unwrap();
    let pitch = 6.0 / count as f64;
    let block = BrickGrid::cantilever([count, 1, 1], material, |[i, j, k]| {
        let is_inner = i > 0 && i < count;
        let slant = if is_inner { 0.1 * pitch * signs[(i + 1) % 2] } else { 0.0 };
        let y = j as f64;
        [pitch * i as f64 + slant * (1.0 - 2.0 * y), 0.2 * y, 0.1 * k as f64]
    });
    let torque = block.section(count).into_iter().flat_map(|(node, _)| {
        let point = block.scene.mesh.nodes()[node];
        [(node, Z, 1.25 * (10.0 * point[1] - 1.0)), (node, Y, -2.5 * (20.0 * point[2] - 1.0))]
    });
    let loads = [block.tip_force(X), block.tip_force(Y), block.tip_force(Z), torque.collect()];
    loads.map(|loads| block.scene.work(&loads))
}

/// Deflections of the twisted cantilever of `MacNeal` & Harder under unit forces along z and y.
pub fn twisted_cantilever([nx, ny, nz]: [usize; 3]) -> [f64; 2] {
    let material = Material::new(2.9e7, 0.22, 0.0).unwrap();
    let block = BrickGrid::cantilever([nx, ny, nz], material, |[i, j, k]| {
        let fraction = i as f64 / nx as f64;
        let sine = (FRAC_PI_2 * fraction).sin();
        let cosine = (FRAC_PI_2 * fraction).cos();
        let y = 1.1 * (j as f64 / ny as f64 - 0.5);
        let z = 0.32 * (k as f64 / nz as f64 - 0.5);
        [12.0 * fraction, y * cosine - z * sine, y * sine + z * cosine]
    });
    [Z, Y].map(|direction| block.scene.work(&block.tip_force(direction)))
}

/// Radial displacement of the inner face of `MacNeal` & Harder's thick cylinder under a unit pressure.
pub fn thick_cylinder(poisson: f64) -> f64 {
    const NODE_RADII: [f64; 6] = [3.0, 3.5, 4.2, 5.2, 6.75, 9.0];
    let angle = 10.0_f64.to_radians();
    let sine = angle.sin();
    let cosine = angle.cos();
    let material = Material::new(1000.0, poisson, 0.0).unwrap();
    let mut block = BrickGrid::new([5, 1, 1], material, |[i, j, k]| {
        let node_angle = angle * j as f64;
        [NODE_RADII[i] * node_angle.cos(), NODE_RADII[i] * node_angle.sin(), k as f64]
    });
    for i in 0..6 {
        for k in 0..2 {
            let first_face = block.node([i, 0, k]);
            block.scene.fix(first_face, &[Y, Z]);
            // The other radial face moves only in its plane: a stiff spring resists motion normal to it.
            let second_face = block.node([i, 1, k]);
            let point = block.scene.mesh.nodes()[second_face];
            let support = block.scene.node([point[0] + sine, point[1] - cosine, point[2]]);
            block.scene.add(Spring::axial_in_space([second_face, support], 1.0e10).unwrap());
            block.scene.fix(second_face, &[Z]);
            block.scene.fix(support, &HINGED_DIRECTIONS);
        }
    }
    let force = 3.0 * angle / 4.0;
    let mut loads: Vec<NodalLoad> = Vec::new();
    for k in 0..2 {
        let first_face = block.node([0, 0, k]);
        let second_face = block.node([0, 1, k]);
        loads.extend([
            (first_face, X, force),
            (second_face, X, force * cosine),
            (second_face, Y, force * sine),
        ]);
    }
    block.scene.solve(&loads)(block.node([0, 0, 0]), X)
}

/// Stress (Pa) and deflection (m) at the point D of NAFEMS' elliptic plate LE10.
///
/// The mesh has `count` bricks along the ellipse, two thirds of them across it and one third over the thickness. The
/// stress is extrapolated from the Gauss points.
pub fn elliptic_plate(count: usize) -> [f64; 2] {
    let radial_count = count * 2 / 3;
    let level_count = count / 3;
    let material = Material::new(210.0e9, 0.3, 0.0).unwrap();
    let mut block = BrickGrid::new([radial_count, count, level_count], material, |[i, j, k]| {
        let angle = FRAC_PI_2 * j as f64 / count as f64;
        let fraction = i as f64 / radial_count as f64;
        let height = 0.6 * k as f64 / level_count as f64;
        [(2.0 + 1.25 * fraction) * angle.cos(), (1.0 + 1.75 * fraction) * angle.sin(), height]
    });
    for k in 0..=level_count {
        for i in 0..=radial_count {
            let node_on_x = block.node([i, 0, k]);
            block.scene.fix(node_on_x, &[Y]);
            let node_on_y = block.node([i, count, k]);
            block.scene.fix(node_on_y, &[X]);
        }
        for j in 0..=count {
            let node = block.node([radial_count, j, k]);
            block
                .scene
                .fix(node, if 2 * k == level_count { &HINGED_DIRECTIONS } else { &[X, Y] });
        }
    }
    let mut loads = Vec::new();
    for i in 0..radial_count {
        for j in 0..count {
            let corners = block.corners([i, j, level_count - 1]);
            let upper_face = [corners[4], corners[5], corners[6], corners[7]];
            loads.extend(block.pressure(upper_face, 1.0e6));
        }
    }
    let solution = block.scene.solve(&loads);
    let nodes = block.corners([0, 0, level_count - 1]);
    let displacement: Vec<f64> = nodes
        .iter()
        .flat_map(|&node| HINGED_DIRECTIONS.map(|direction| solution(node, direction)))
        .collect();
    let brick = Hex8::new(nodes, material);
    let stresses = brick.stresses(&block.scene.points(&nodes), &displacement).unwrap();
    [stresses[4][1], solution(block.node([0, 0, level_count]), Z)]
}

/// A steel plate 10 m × 10 m × 1 m.
pub fn thick_plate(counts: [usize; 3]) -> BrickGrid {
    let material = Material::new(200.0e9, 0.3, 8000.0).unwrap();
    BrickGrid::new(counts, material, |[i, j, k]| {
        [
            10.0 * (i as f64 / counts[0] as f64),
            10.0 * (j as f64 / counts[1] as f64),
            k as f64 / counts[2] as f64,
        ]
    })
}

/// The plate on hard supports: its side faces cannot move in their planes.
pub fn hard_plate(counts: [usize; 3]) -> BrickGrid {
    let mut block = thick_plate(counts);
    for k in 0..=counts[2] {
        for i in 0..=counts[0] {
            for j in 0..=counts[1] {
                let node = block.node([i, j, k]);
                if i == 0 || i == counts[0] {
                    block.scene.fix(node, &[Y, Z]);
                }
                if j == 0 || j == counts[1] {
                    block.scene.fix(node, &[X, Z]);
                }
            }
        }
    }
    block
}
