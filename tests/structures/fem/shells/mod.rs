//! GOAL: shells of four and of three nodes carry what the theory says, whatever their place and order of nodes.
//! SCENE: single elements, patches, strips, roofs, hemispheres, plates.
//! REFERENCE: matrices of an implementation in Python, closed forms, and benchmarks of MacNeal & Harder and NAFEMS.

mod errors;
mod gates;
mod matrices;
mod patch;
mod plates;
mod resultants;
mod rows;
mod single;
mod surface;

use basemat::fem::{Direction, Element, MassKind, Material, Mesh, Shell};
use basemat_problems::dense::{self, DenseMatrix};

pub(super) use basemat_problems::supported::{
    CLAMPED_DIRECTIONS as ALL_DIRECTIONS, RX, RY, RZ, X, Y, Z,
};

/// Shells in space with supports and loads at their nodes.
pub(super) struct Assembly {
    pub(super) mesh: Mesh,
    pub(super) shells: Vec<Shell>,
    /// Degrees of freedom with prescribed displacements.
    pub(super) prescribed: Vec<(usize, f64)>,
    pub(super) load: Vec<f64>,
}

/// Place of a displacement of a node among all.
pub(super) fn dof(node: usize, direction: Direction) -> usize {
    6 * node + ALL_DIRECTIONS.iter().position(|&other| other == direction).unwrap()
}

impl Assembly {
    pub(super) fn new() -> Self {
        let mesh = Mesh::in_space();
        Self { mesh, shells: Vec::new(), prescribed: Vec::new(), load: Vec::new() }
    }

    pub(super) fn node(&mut self, point: [f64; 3]) -> usize {
        self.load.extend([0.0; 6]);
        self.mesh.add_node_at(point).unwrap()
    }

    /// Nodes (nx + 1) × (ny + 1) at the points of `place`, and quadrilaterals or triangles between them.
    pub(super) fn grid(
        &mut self,
        [nx, ny]: [usize; 2],
        pattern: CellPattern,
        (material, thickness): (Material, f64),
        place: impl Fn(f64, f64) -> [f64; 3],
    ) -> Vec<Vec<usize>> {
        let mut nodes = Vec::new();
        for i in 0..=nx {
            let x = i as f64 / nx as f64;
            let row = (0..=ny).map(|j| self.node(place(x, j as f64 / ny as f64)));
            nodes.push(row.collect::<Vec<usize>>());
        }
        for i in 0..nx {
            for j in 0..ny {
                let a = nodes[i][j];
                let b = nodes[i + 1][j];
                let c = nodes[i + 1][j + 1];
                let d = nodes[i][j + 1];
                for corners in pattern.split([a, b, c, d], i + j) {
                    self.shell(&corners, material, thickness);
                }
            }
        }
        nodes
    }

    pub(super) fn shell(&mut self, nodes: &[usize], material: Material, thickness: f64) {
        let shell = Shell::new(nodes, material, thickness).unwrap();
        self.shells.push(shell.clone());
        self.mesh.add(shell).unwrap();
    }

    pub(super) fn fix(&mut self, node: usize, directions: &[Direction]) {
        self.prescribed
            .extend(directions.iter().map(|&direction| (dof(node, direction), 0.0)));
    }

    /// Elements of a list that match each other where they meet.
    pub(super) fn matched(&mut self, mut shells: Vec<Shell>) {
        Shell::match_sides(&mut shells);
        for shell in shells {
            self.shells.push(shell.clone());
            self.mesh.add(shell).unwrap();
        }
    }

    pub(super) fn points(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.mesh.nodes()[node]).collect()
    }

    pub(super) fn matrix(
        &self,
        add: impl Fn(&dyn Element, &[[f64; 3]], &mut [f64]),
    ) -> DenseMatrix {
        let order = self.load.len();
        let mut matrix = vec![vec![0.0; order]; order];
        for element in self.mesh.elements() {
            let nodes = element.nodes();
            let order = element.order();
            let mut element_matrix = vec![0.0; order * order];
            add(element, &self.points(nodes), &mut element_matrix);
            let dofs: Vec<usize> = (0..order).map(|k| 6 * nodes[k / 6] + k % 6).collect();
            for i in 0..order {
                for j in 0..order {
                    matrix[dofs[i]][dofs[j]] += element_matrix[i * order + j];
                }
            }
        }
        matrix
    }

    pub(super) fn stiffness(&self) -> DenseMatrix {
        self.matrix(Element::stiffness)
    }

    pub(super) fn mass(&self, kind: MassKind) -> DenseMatrix {
        self.matrix(|element, points, matrix| element.mass(points, kind, matrix))
    }

    /// Displacements under the load.
    pub(super) fn solve(&self) -> Vec<f64> {
        dense::solve_with_prescribed(&self.stiffness(), &self.load, &self.prescribed)
    }

    /// Displacements of the nodes of a shell.
    pub(super) fn node_displacements(shell: &Shell, displacements: &[f64]) -> Vec<f64> {
        shell
            .nodes()
            .iter()
            .flat_map(|&node| displacements[6 * node..6 * node + 6].to_vec())
            .collect()
    }
}

/// Elements of a cell of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CellPattern {
    Quads,
    /// The diagonal (i, j)–(i + 1, j + 1).
    Rising,
    /// The diagonal (i + 1, j)–(i, j + 1).
    Falling,
    /// Quadrilaterals, each second one clockwise.
    Clockwise,
}

impl CellPattern {
    fn split(self, [a, b, c, d]: [usize; 4], cell: usize) -> Vec<Vec<usize>> {
        match self {
            Self::Clockwise if cell.is_multiple_of(2) => vec![vec![b, a, d, c]],
            Self::Quads | Self::Clockwise => vec![vec![a, b, c, d]],
            Self::Rising => vec![vec![a, b, c], vec![a, c, d]],
            Self::Falling => vec![vec![a, b, d], vec![b, c, d]],
        }
    }
}

pub(super) fn material(young_modulus: f64, poisson: f64, density: f64) -> Material {
    Material::new(young_modulus, poisson, density).unwrap()
}
/// Numbers of `count` nodes from another start, or the other way round.
pub(super) fn turned_list(count: usize, start: usize, clockwise: bool) -> Vec<usize> {
    (0..count).map(|k| (start + if clockwise { count - k } else { k }) % count).collect()
}

/// A shell of the tables `shells/*.csv`, and the coordinates of its nodes.
pub(super) struct TabledShell {
    pub(super) name: &'static str,
    pub(super) shell: Shell,
    pub(super) nodes: Vec<[f64; 3]>,
}

fn tabled(
    name: &'static str,
    corners: &[[f64; 3]],
    material: Material,
    thickness: f64,
) -> TabledShell {
    let list: Vec<usize> = (0..corners.len()).collect();
    let shell = Shell::new(list, material, thickness).unwrap();
    TabledShell { name, shell, nodes: corners.to_vec() }
}

/// Shells of the tables: quadrilaterals flat, distorted and warped, triangles.
pub(super) fn tabled_shells() -> Vec<TabledShell> {
    let concrete = material(30.0e9, 0.2, 2500.0);
    let steel = material(210.0e9, 0.3, 7850.0);
    let rectangle = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let distorted_nodes = [
        [1.0, 2.0, 3.0],
        [2.940_768, 2.694_816, 3.44794],
        [2.779_765, 3.830_647, 4.459_852],
        [0.327_041, 2.836_674, 3.791_898],
    ];
    let warped = [[0.0; 3], [2.0, 0.1, 0.2], [2.2, 1.5, -0.1], [-0.2, 1.3, 0.3]];
    let right_triangle = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let oblique_triangle = [[0.0; 3], [2.1, 0.3, 0.4], [0.3, 1.8, -0.2]];
    let distant_triangle = [[5.0, 1.0, 2.0], [5.0, 3.0, 2.0], [4.2, 2.4, 3.6]];
    vec![
        tabled("shell4_1", &rectangle, concrete, 0.3),
        tabled("shell4_2", &distorted_nodes, concrete, 0.2),
        tabled("shell4_3", &warped, concrete, 0.25),
        tabled("shell3_1", &right_triangle, concrete, 0.1),
        tabled("shell3_2", &oblique_triangle, concrete, 0.2),
        tabled("shell3_3", &distant_triangle, steel, 0.02),
    ]
}
