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
use basemat_problems::dense::{self, Matrix};

pub(super) use basemat_problems::supported::{CLAMPED as ALL, RX, RY, RZ, X, Y, Z};

/// Shells in space with supports and loads at their nodes.
pub(super) struct Assembly {
    pub(super) mesh: Mesh,
    pub(super) shells: Vec<Shell>,
    pub(super) held: Vec<(usize, f64)>,
    pub(super) load: Vec<f64>,
}

/// Place of a displacement of a node among all.
pub(super) fn dof(node: usize, direction: Direction) -> usize {
    6 * node + ALL.iter().position(|&own| own == direction).unwrap()
}

impl Assembly {
    pub(super) fn new() -> Self {
        let mesh = Mesh::in_space();
        Self { mesh, shells: Vec::new(), held: Vec::new(), load: Vec::new() }
    }

    pub(super) fn node(&mut self, point: [f64; 3]) -> usize {
        self.load.extend([0.0; 6]);
        self.mesh.add_node_at(point).unwrap()
    }

    /// Nodes (nx + 1) × (ny + 1) at the points of `place`, and quadrilaterals or triangles between them.
    pub(super) fn grid(
        &mut self,
        [nx, ny]: [usize; 2],
        pattern: Pattern,
        (material, thickness): (Material, f64),
        place: impl Fn(f64, f64) -> [f64; 3],
    ) -> Vec<Vec<usize>> {
        let ratio = |k: usize, n: usize| k as f64 / n as f64;
        let nodes: Vec<Vec<usize>> = (0..=nx)
            .map(|i| (0..=ny).map(|j| self.node(place(ratio(i, nx), ratio(j, ny)))).collect())
            .collect();
        for i in 0..nx {
            for j in 0..ny {
                let [a, b] = [nodes[i][j], nodes[i + 1][j]];
                let [d, c] = [nodes[i][j + 1], nodes[i + 1][j + 1]];
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

    pub(super) fn hold(&mut self, node: usize, directions: &[Direction]) {
        self.held.extend(directions.iter().map(|&direction| (dof(node, direction), 0.0)));
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

    pub(super) fn matrix(&self, add: impl Fn(&dyn Element, &[[f64; 3]], &mut [f64])) -> Matrix {
        let order = self.load.len();
        let mut all = vec![vec![0.0; order]; order];
        for element in self.mesh.elements() {
            let (nodes, order) = (element.nodes(), element.order());
            let mut own = vec![0.0; order * order];
            add(element, &self.points(nodes), &mut own);
            let place = |k: usize| 6 * nodes[k / 6] + k % 6;
            for i in 0..order {
                for j in 0..order {
                    all[place(i)][place(j)] += own[i * order + j];
                }
            }
        }
        all
    }

    pub(super) fn stiffness(&self) -> Matrix {
        self.matrix(Element::stiffness)
    }

    pub(super) fn mass(&self, kind: MassKind) -> Matrix {
        self.matrix(|element, points, matrix| element.mass(points, kind, matrix))
    }

    /// Displacements under the load.
    pub(super) fn solve(&self) -> Vec<f64> {
        dense::solve_held(&self.stiffness(), &self.load, &self.held)
    }

    /// Displacements of the nodes of a shell.
    pub(super) fn of(shell: &Shell, all: &[f64]) -> Vec<f64> {
        shell.nodes().iter().flat_map(|&node| all[6 * node..6 * node + 6].to_vec()).collect()
    }
}

/// Elements of a cell of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pattern {
    Quads,
    /// The diagonal (i, j)–(i + 1, j + 1).
    Rising,
    /// The diagonal (i + 1, j)–(i, j + 1).
    Falling,
    /// Quadrilaterals, each second one clockwise.
    Clockwise,
}

impl Pattern {
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

/// Shells and coordinates of the tables `shells/*.csv`: quadrilaterals flat, distorted and warped, triangles.
pub(super) fn tabled() -> Vec<(&'static str, Shell, Vec<[f64; 3]>)> {
    let concrete = material(30.0e9, 0.2, 2500.0);
    let shell = |nodes: &[[f64; 3]], material, thickness| {
        let list: Vec<usize> = (0..nodes.len()).collect();
        (Shell::new(list, material, thickness).unwrap(), nodes.to_vec())
    };
    let quad = |corners: [[f64; 3]; 4], thickness| shell(&corners, concrete, thickness);
    let triangle =
        |corners: [[f64; 3]; 3], material, thickness| shell(&corners, material, thickness);
    [
        ("shell4_1", quad([[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]], 0.3)),
        (
            "shell4_2",
            quad(
                [
                    [1.0, 2.0, 3.0],
                    [2.940_768, 2.694_816, 3.44794],
                    [2.779_765, 3.830_647, 4.459_852],
                    [0.327_041, 2.836_674, 3.791_898],
                ],
                0.2,
            ),
        ),
        ("shell4_3", quad([[0.0; 3], [2.0, 0.1, 0.2], [2.2, 1.5, -0.1], [-0.2, 1.3, 0.3]], 0.25)),
        ("shell3_1", triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], concrete, 0.1)),
        ("shell3_2", triangle([[0.0; 3], [2.1, 0.3, 0.4], [0.3, 1.8, -0.2]], concrete, 0.2)),
        (
            "shell3_3",
            triangle(
                [[5.0, 1.0, 2.0], [5.0, 3.0, 2.0], [4.2, 2.4, 3.6]],
                material(210.0e9, 0.3, 7850.0),
                0.02,
            ),
        ),
    ]
    .into_iter()
    .map(|(name, (shell, nodes))| (name, shell, nodes))
    .collect()
}
