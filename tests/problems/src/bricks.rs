//! Benchmarks of bricks: cantilevers, a thick cylinder, thick plates.

use std::f64::consts::FRAC_PI_2;

use basemat::fem::{Direction, Hex8, Material, Spring};

use crate::supported::{HINGED, Load, Supported, X, Y, Z};

/// Corners of the distorted brick of `tests/data/elements`.
pub const DISTORTED: [[f64; 3]; 8] = [
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
pub struct Block {
    pub scene: Supported,
    pub counts: [usize; 3],
}

impl Block {
    /// Bricks between nodes that `at` places by their indices.
    pub fn new(
        counts: [usize; 3],
        material: Material,
        at: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Self {
        let mut block = Self { scene: Supported::new(), counts };
        let [nx, ny, nz] = counts;
        for i in 0..=nx {
            for j in 0..=ny {
                for k in 0..=nz {
                    block.scene.node(at([i, j, k]));
                }
            }
        }
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let nodes = block.corners([i, j, k]);
                    block.scene.add(Hex8::new(nodes, material));
                }
            }
        }
        block
    }

    /// A block whose first section is held.
    pub fn cantilever(
        counts: [usize; 3],
        material: Material,
        at: impl Fn([usize; 3]) -> [f64; 3],
    ) -> Self {
        let mut block = Self::new(counts, material, at);
        for (node, _) in block.section(0) {
            block.scene.hold(node, &HINGED);
        }
        block
    }

    /// Number of a node.
    pub fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        let [_, ny, nz] = self.counts;
        (i * (ny + 1) + j) * (nz + 1) + k
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

    /// Nodes of the section at a column of the first index, with their parts of its area.
    pub fn section(&self, i: usize) -> Vec<(usize, f64)> {
        let [_, ny, nz] = self.counts;
        let part = |k: usize, n: usize| if k == 0 || k == n { 0.5 } else { 1.0 } / n as f64;
        let nodes = (0..=ny).flat_map(|j| (0..=nz).map(move |k| (j, k)));
        nodes.map(|(j, k)| (self.node([i, j, k]), part(j, ny) * part(k, nz))).collect()
    }

    /// A unit force spread over the last section.
    pub fn tip_force(&self, direction: Direction) -> Vec<Load> {
        let tip = self.section(self.counts[0]).into_iter();
        tip.map(|(node, part)| (node, direction, part)).collect()
    }

    /// Forces of a pressure (Pa) downwards on a level quadrilateral, with 2 × 2 points.
    fn pressure(&self, nodes: [usize; 4], pressure: f64) -> Vec<Load> {
        const SIDES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let points = self.scene.points(&nodes);
        let mut loads = Vec::new();
        for point in SIDES {
            let [xi, eta] = point.map(|side| side / 3.0_f64.sqrt());
            let mut tangent = [[0.0; 2]; 2];
            for ([a, b], at) in SIDES.iter().zip(&points) {
                for axis in 0..2 {
                    tangent[0][axis] += 0.25 * a * (1.0 + b * eta) * at[axis];
                    tangent[1][axis] += 0.25 * b * (1.0 + a * xi) * at[axis];
                }
            }
            let area = tangent[0][0] * tangent[1][1] - tangent[0][1] * tangent[1][0];
            for ([a, b], node) in SIDES.iter().zip(nodes) {
                let shape = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
                loads.push((node, Z, -pressure * area * shape));
            }
        }
        loads
    }
}

/// Deflections of the straight cantilever of `MacNeal` & Harder under unit forces along x, y, z and a unit torque.
///
/// Sections between its ends slant by two signs in turn: rectangles, parallelograms or trapezoids.
pub fn straight_cantilever(count: usize, signs: [f64; 2]) -> [f64; 4] {
    let material = Material::new(1.0e7, 0.3, 0.0).unwrap();
    let pitch = 6.0 / count as f64;
    let block = Block::cantilever([count, 1, 1], material, |[i, j, k]| {
        let inner = i > 0 && i < count;
        let slant = if inner { 0.1 * pitch * signs[(i + 1) % 2] } else { 0.0 };
        let [y, z] = [j as f64, k as f64];
        [pitch * i as f64 + slant * (1.0 - 2.0 * y), 0.2 * y, 0.1 * z]
    });
    let torque = block.section(count).into_iter().flat_map(|(node, _)| {
        let [_, y, z] = block.scene.mesh.nodes()[node];
        [(node, Z, 1.25 * (10.0 * y - 1.0)), (node, Y, -2.5 * (20.0 * z - 1.0))]
    });
    let [x, y, z] = HINGED.map(|direction| block.tip_force(direction));
    [x, y, z, torque.collect()].map(|loads| block.scene.work(&loads))
}

/// Deflections of the twisted cantilever of `MacNeal` & Harder under unit forces along z and y.
pub fn twisted_cantilever([nx, ny, nz]: [usize; 3]) -> [f64; 2] {
    let material = Material::new(2.9e7, 0.22, 0.0).unwrap();
    let block = Block::cantilever([nx, ny, nz], material, |[i, j, k]| {
        let part = i as f64 / nx as f64;
        let (sine, cosine) = (FRAC_PI_2 * part).sin_cos();
        let [y, z] = [1.1 * (j as f64 / ny as f64 - 0.5), 0.32 * (k as f64 / nz as f64 - 0.5)];
        [12.0 * part, y * cosine - z * sine, y * sine + z * cosine]
    });
    [Z, Y].map(|direction| block.scene.work(&block.tip_force(direction)))
}

/// Displacement inside the thick cylinder of `MacNeal` & Harder under a unit pressure.
pub fn thick_cylinder(poisson: f64) -> f64 {
    const RADII: [f64; 6] = [3.0, 3.5, 4.2, 5.2, 6.75, 9.0];
    let angle = 10.0_f64.to_radians();
    let (sine, cosine) = angle.sin_cos();
    let material = Material::new(1000.0, poisson, 0.0).unwrap();
    let mut block = Block::new([5, 1, 1], material, |[i, j, k]| {
        let (sine, cosine) = (angle * j as f64).sin_cos();
        [RADII[i] * cosine, RADII[i] * sine, k as f64]
    });
    for i in 0..6 {
        for k in 0..2 {
            let nodes = [block.node([i, 0, k]), block.node([i, 1, k])];
            block.scene.hold(nodes[0], &[Y, Z]);
            // The other radial face moves in its plane: a stiff spring across it.
            let [x, y, z] = block.scene.mesh.nodes()[nodes[1]];
            let support = block.scene.node([x + sine, y - cosine, z]);
            block.scene.add(Spring::axial_in_space([nodes[1], support], 1.0e10).unwrap());
            block.scene.hold(nodes[1], &[Z]);
            block.scene.hold(support, &HINGED);
        }
    }
    let force = 3.0 * angle / 4.0;
    let mut loads: Vec<Load> = Vec::new();
    for k in 0..2 {
        let [lower, upper] = [block.node([0, 0, k]), block.node([0, 1, k])];
        loads.extend([(lower, X, force), (upper, X, force * cosine), (upper, Y, force * sine)]);
    }
    block.scene.solve(&loads)(block.node([0, 0, 0]), X)
}

/// Stress (Pa) and deflection (m) at the point D of NAFEMS' elliptic plate LE10.
///
/// `around` bricks along the ellipse, two thirds across it, a third over the thickness. The stress is extrapolated from
/// the Gauss points.
pub fn elliptic_plate(around: usize) -> [f64; 2] {
    let (radial, levels) = (around * 2 / 3, around / 3);
    let material = Material::new(210.0e9, 0.3, 0.0).unwrap();
    let mut block = Block::new([radial, around, levels], material, |[i, j, k]| {
        let (sine, cosine) = (FRAC_PI_2 * j as f64 / around as f64).sin_cos();
        let part = i as f64 / radial as f64;
        let height = 0.6 * k as f64 / levels as f64;
        [(2.0 + 1.25 * part) * cosine, (1.0 + 1.75 * part) * sine, height]
    });
    for k in 0..=levels {
        for i in 0..=radial {
            let ends = [block.node([i, 0, k]), block.node([i, around, k])];
            block.scene.hold(ends[0], &[Y]);
            block.scene.hold(ends[1], &[X]);
        }
        for j in 0..=around {
            let node = block.node([radial, j, k]);
            block.scene.hold(node, if 2 * k == levels { &HINGED } else { &[X, Y] });
        }
    }
    let mut loads = Vec::new();
    for i in 0..radial {
        for j in 0..around {
            let [_, _, _, _, a, b, c, d] = block.corners([i, j, levels - 1]);
            loads.extend(block.pressure([a, b, c, d], 1.0e6));
        }
    }
    let found = block.scene.solve(&loads);
    let nodes = block.corners([0, 0, levels - 1]);
    let displacement: Vec<f64> =
        nodes.iter().flat_map(|&node| HINGED.map(|direction| found(node, direction))).collect();
    let brick = Hex8::new(nodes, material);
    let stresses = brick.stresses(&block.scene.points(&nodes), &displacement).unwrap();
    [stresses[4][1], found(block.node([0, 0, levels]), Z)]
}

/// A steel plate 10 m × 10 m × 1 m.
pub fn thick_plate(counts: [usize; 3]) -> Block {
    let material = Material::new(200.0e9, 0.3, 8000.0).unwrap();
    Block::new(counts, material, |[i, j, k]| {
        let [x, y, z] = [(i, 0), (j, 1), (k, 2)].map(|(k, axis)| k as f64 / counts[axis] as f64);
        [10.0 * x, 10.0 * y, z]
    })
}

/// The plate on hard supports: its side faces cannot move in their planes.
pub fn hard_plate(counts: [usize; 3]) -> Block {
    let mut block = thick_plate(counts);
    let [nx, ny, nz] = counts;
    for k in 0..=nz {
        for i in 0..=nx {
            for j in 0..=ny {
                let node = block.node([i, j, k]);
                if i == 0 || i == nx {
                    block.scene.hold(node, &[Y, Z]);
                }
                if j == 0 || j == ny {
                    block.scene.hold(node, &[X, Z]);
                }
            }
        }
    }
    block
}
