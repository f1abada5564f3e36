//! Dense reference for structures on their ground: load factors by eigenvalues, equilibria by active sets.

use basemat::bem::Ground;
use basemat::structure::{Base, BaseNode, DofCombination, Structure};
use basemat_problems::dense::{
    Matrix, collect, dot, eigenvalues, inverse, mass, multiply, solve, stiffness,
};

use super::structures::GRAVITY;

/// Increments in which the weight is followed.
const INCREMENTS: usize = 100;

/// Displacement of a rigid base at a place as sums of degrees of freedom: down, along x and, in space, along y.
fn base_rows(base: &Base, [x, y]: [f64; 2], dofs: usize) -> Vec<Vec<f64>> {
    let nodes: Vec<&BaseNode> = base.nodes().collect();
    // Weights of three or two nodes that give the linear function of the place.
    let weights = if let Base::Lines(_) = base {
        let (left, right) = (nodes[0], nodes[nodes.len() - 1]);
        let share = (x - left.x) / (right.x - left.x);
        vec![(left, 1.0 - share), (right, share)]
    } else {
        let three = [nodes[0], nodes[1], nodes[2]];
        let places: Matrix = vec![
            vec![1.0; 3],
            three.iter().map(|node| node.x).collect(),
            three.iter().map(|node| node.y).collect(),
        ];
        let found = solve(&places, &[1.0, x, y]);
        three.into_iter().zip(found).collect()
    };
    let row = |of: fn(&BaseNode) -> &DofCombination, sign: f64| {
        let mut row = vec![0.0; dofs];
        for (node, weight) in &weights {
            of(node).iter().for_each(|&(dof, own)| row[dof] += sign * weight * own);
        }
        row
    };
    let mut rows = vec![row(|node| &node.vertical, -1.0), row(|node| &node.horizontal, 1.0)];
    if matches!(base, Base::Faces(_)) {
        rows.push(row(|node| &node.across, 1.0));
    }
    rows
}

/// Dense matrices of a scene.
pub(super) struct Reference {
    elastic: Matrix,
    geometric: Matrix,
    weight: Vec<f64>,
    /// Element means: down for all elements, then along x, then along y.
    pub(super) means: Matrix,
    areas: Vec<f64>,
    /// Number of elements.
    count: usize,
    /// Static compliance with a soft common settlement and translation, which change no equilibrium and no stability.
    compliance: Matrix,
}

/// What followed the weight from nothing.
#[derive(Debug)]
pub(super) enum Followed {
    Stands,
    /// No stable equilibrium beyond this multiple of the weight.
    Lost(f64),
}

impl Reference {
    pub(super) fn new(structure: &dyn Structure, ground: &dyn Ground, up: &[f64]) -> Self {
        let n = structure.dofs();
        let geometric = collect(structure, |m| structure.geometric_stiffness(m));
        let mut elastic = stiffness(structure);
        for (row, own) in elastic.iter_mut().zip(&geometric) {
            row.iter_mut().zip(own).for_each(|(k, g)| *k -= g);
        }
        let (base, elements) = (structure.base(), ground.elements());
        let count = elements.len();
        let by_element: Vec<_> = elements
            .iter()
            .map(|element| {
                let [x, y, _] = element.center();
                base_rows(&base, [x, y], n)
            })
            .collect();
        let directions = by_element[0].len();
        let means: Matrix = (0..directions * count)
            .map(|place| by_element[place % count][place / count].clone())
            .collect();
        let areas: Vec<f64> =
            (0..directions * count).map(|place| elements[place % count].area()).collect();
        let size = areas.len();
        let mut flat = vec![0.0; size * size];
        ground.static_compliance(&mut flat).unwrap();
        let largest = flat.iter().fold(0.0, |most: f64, value| value.abs().max(most));
        let common = 10.0 * largest * count as f64 / areas[..count].iter().sum::<f64>();
        let compliance = (0..size)
            .map(|i| {
                let together =
                    |j: usize| if i / count == j / count { common * areas[j] } else { 0.0 };
                (0..size).map(|j| flat[i * size + j] + together(j)).collect()
            })
            .collect();
        let weight = multiply(&mass(structure), up).iter().map(|p| -GRAVITY * p).collect();
        Self { elastic, geometric, weight, means, areas, count, compliance }
    }

    /// Stiffness of the ground under these element components, and their rows of tractions by displacements.
    fn ground(&self, places: &[usize]) -> (Matrix, Matrix) {
        let size = places.len();
        let flat: Vec<f64> = places
            .iter()
            .flat_map(|&i| places.iter().map(move |&j| self.compliance[i][j]))
            .collect();
        let inverse = inverse(&flat, size);
        let n = self.weight.len();
        let tractions: Matrix = (0..size)
            .map(|i| {
                let mut row = vec![0.0; n];
                for (j, &place) in places.iter().enumerate() {
                    let own = inverse[i * size + j];
                    row.iter_mut().zip(&self.means[place]).for_each(|(r, b)| *r += own * b);
                }
                row
            })
            .collect();
        let mut matrix = vec![vec![0.0; n]; n];
        for (row, &place) in tractions.iter().zip(places) {
            for i in 0..n {
                let own = self.areas[place] * self.means[place][i];
                if own != 0.0 {
                    (0..n).for_each(|j| matrix[i][j] += own * row[j]);
                }
            }
        }
        (matrix, tractions)
    }

    /// Smallest multiple of the forces at rest at which the structure buckles, bonded to these components.
    pub(super) fn load_factor(&self, places: &[usize]) -> f64 {
        let mut sum = self.ground(places).0;
        let n = sum.len();
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (sum[i][j] + sum[j][i]);
                (sum[i][j], sum[j][i]) = (mean, mean);
            }
        }
        (0..n).for_each(|i| (0..n).for_each(|j| sum[i][j] += self.elastic[i][j]));
        let lowest = eigenvalues(&self.geometric, &sum)[0];
        if lowest < 0.0 { -1.0 / lowest } else { f64::INFINITY }
    }

    /// Follows the equilibrium without friction while the weight and its P–Δ grow together.
    pub(super) fn follow(&self) -> Followed {
        let (n, count) = (self.weight.len(), self.count);
        let mut closed: Vec<usize> = (0..count).collect();
        for increment in 1..=INCREMENTS {
            let factor = increment as f64 / INCREMENTS as f64;
            let lost = || Followed::Lost((increment - 1) as f64 / INCREMENTS as f64);
            let mut rounds = 0;
            loop {
                rounds += 1;
                if rounds > 40 || closed.is_empty() {
                    return lost();
                }
                let (ground, tractions) = self.ground(&closed);
                let mut matrix = ground;
                for i in 0..n {
                    for j in 0..n {
                        matrix[i][j] += self.elastic[i][j] + factor * self.geometric[i][j];
                    }
                }
                // Nothing pushes along the ground: a soft spring there has no force.
                for place in count..self.means.len() {
                    let soft = 1e-3 / self.compliance[place][place];
                    let row = &self.means[place];
                    for i in (0..n).filter(|i| row[*i] != 0.0) {
                        (0..n).for_each(|j| matrix[i][j] += soft * row[i] * row[j]);
                    }
                }
                if !is_definite(&matrix) {
                    return lost();
                }
                let load: Vec<f64> = self.weight.iter().map(|force| factor * force).collect();
                let u = solve(&matrix, &load);
                let pressures = multiply(&tractions, &u);
                let largest = pressures.iter().fold(0.0, |most: f64, p| p.abs().max(most));
                let worst =
                    (0..closed.len()).min_by(|&i, &j| pressures[i].total_cmp(&pressures[j]));
                if let Some(worst) = worst.filter(|&k| pressures[k] < -1e-9 * largest) {
                    closed.remove(worst);
                    continue;
                }
                let gap = |place: usize| {
                    let soil = closed.iter().zip(&pressures);
                    let soil: f64 = soil.map(|(&j, p)| self.compliance[place][j] * p).sum();
                    soil - dot(&self.means[place], &u)
                };
                let size = u.iter().fold(0.0, |most: f64, x| x.abs().max(most));
                let open = (0..count).filter(|place| !closed.contains(place));
                match open.map(|place| (gap(place), place)).min_by(|a, b| a.0.total_cmp(&b.0)) {
                    Some((gap, place)) if gap < -1e-9 * size => {
                        closed.push(place);
                        closed.sort_unstable();
                    }
                    _ => break,
                }
            }
        }
        Followed::Stands
    }
}

/// Whether Cholesky's factors of a symmetric matrix exist.
fn is_definite(matrix: &Matrix) -> bool {
    let n = matrix.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let mean = 0.5 * (matrix[i][j] + matrix[j][i]);
            let rest: f64 = mean - dot(&lower[i][..j], &lower[j][..j]);
            if i == j && rest <= 0.0 {
                return false;
            }
            lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
        }
    }
    true
}
