//! Dense reference for structures on their ground: load factors by eigenvalues, equilibria by active sets.

use basemat::bem::Ground;
use basemat::structure::{Base, BaseNode, DofCombination, Structure};
use basemat_problems::dense::{
    DenseMatrix, collect, dot, eigenvalues, inverse, mass, multiply, solve, stiffness,
};

use super::structures::GRAVITY_ACCELERATION;

/// Increments in which the weight is applied.
const WEIGHT_INCREMENTS: usize = 100;
/// Largest number of changes of the set of closed elements in an increment.
const MAX_SET_CHANGES: usize = 40;

/// Nodes with weights that give any linear function of the place from its values at the nodes.
fn interpolation(base: &Base, [x, y]: [f64; 2]) -> Vec<(&BaseNode, f64)> {
    let nodes: Vec<&BaseNode> = base.nodes().collect();
    if let Base::Lines(_) = base {
        let left = nodes[0];
        let right = nodes[nodes.len() - 1];
        let fraction = (x - left.x) / (right.x - left.x);
        return vec![(left, 1.0 - fraction), (right, fraction)];
    }
    let corners = [nodes[0], nodes[1], nodes[2]];
    let coordinates: DenseMatrix = vec![
        vec![1.0; 3],
        corners.iter().map(|node| node.x).collect(),
        corners.iter().map(|node| node.y).collect(),
    ];
    let weights = solve(&coordinates, &[1.0, x, y]);
    corners.into_iter().zip(weights).collect()
}

/// Sum of one displacement of the nodes with these weights, as a row over all degrees of freedom.
fn weighted_row(
    nodes: &[(&BaseNode, f64)],
    displacement: fn(&BaseNode) -> &DofCombination,
    sign: f64,
    dofs: usize,
) -> Vec<f64> {
    let mut row = vec![0.0; dofs];
    for (node, weight) in nodes {
        for &(dof, factor) in displacement(node) {
            row[dof] += sign * weight * factor;
        }
    }
    row
}

/// Displacement of a rigid base at a place as sums of degrees of freedom: down, along x and, in space, along y.
fn base_rows(base: &Base, place: [f64; 2], dofs: usize) -> Vec<Vec<f64>> {
    let nodes = interpolation(base, place);
    let mut rows = vec![
        weighted_row(&nodes, |node| &node.vertical, -1.0, dofs),
        weighted_row(&nodes, |node| &node.horizontal, 1.0, dofs),
    ];
    if matches!(base, Base::Faces(_)) {
        rows.push(weighted_row(&nodes, |node| &node.across, 1.0, dofs));
    }
    rows
}

/// Static compliance with a soft common settlement and translation, which change no equilibrium and no stability.
fn compliance_with_common_motion(ground: &dyn Ground, areas: &[f64]) -> DenseMatrix {
    let count = ground.elements().len();
    let size = areas.len();
    let mut compliance = vec![0.0; size * size];
    ground.static_compliance(&mut compliance).unwrap();
    let max_magnitude = largest_absolute(&compliance);
    let common = 10.0 * max_magnitude * count as f64 / areas[..count].iter().sum::<f64>();
    let mut matrix = vec![vec![0.0; size]; size];
    for i in 0..size {
        for j in 0..size {
            let common_motion = if i / count == j / count { common * areas[j] } else { 0.0 };
            matrix[i][j] = compliance[i * size + j] + common_motion;
        }
    }
    matrix
}

fn largest_absolute(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| value.abs().max(largest))
}

/// Dense matrices of a scene.
pub(super) struct Reference {
    elastic: DenseMatrix,
    geometric: DenseMatrix,
    weight: Vec<f64>,
    /// Mean displacements of the elements: down for all elements, then along x, then along y.
    pub(super) means: DenseMatrix,
    areas: Vec<f64>,
    /// Number of elements.
    count: usize,
    compliance: DenseMatrix,
}

/// End of the path of equilibria under growing weight.
#[derive(Debug)]
pub(super) enum PathEnd {
    Stands,
    /// No stable equilibrium exists beyond this multiple of the weight.
    LostAt(f64),
}

/// Stiffness of the ground, and tractions on it as rows over all degrees of freedom.
struct GroundStiffness {
    stiffness: DenseMatrix,
    tractions: DenseMatrix,
}

impl Reference {
    pub(super) fn new(
        structure: &dyn Structure,
        ground: &dyn Ground,
        vertical_translation: &[f64],
    ) -> Self {
        let dofs = structure.dofs();
        let geometric = collect(structure, |matrix| structure.geometric_stiffness(matrix));
        let mut elastic = stiffness(structure);
        for (elastic, geometric) in elastic.iter_mut().zip(&geometric) {
            elastic.iter_mut().zip(geometric).for_each(|(k, g)| *k -= g);
        }
        let base = structure.base();
        let elements = ground.elements();
        let count = elements.len();
        let mut rows_by_element = Vec::new();
        for element in elements {
            let [x, y, _] = element.center();
            rows_by_element.push(base_rows(&base, [x, y], dofs));
        }
        let mut means = Vec::new();
        let mut areas = Vec::new();
        for direction in 0..rows_by_element[0].len() {
            for (rows, element) in rows_by_element.iter().zip(elements) {
                means.push(rows[direction].clone());
                areas.push(element.area());
            }
        }
        let compliance = compliance_with_common_motion(ground, &areas);
        let masses = multiply(&mass(structure), vertical_translation);
        let weight = masses.iter().map(|mass| -GRAVITY_ACCELERATION * mass).collect();
        Self { elastic, geometric, weight, means, areas, count, compliance }
    }

    /// Ground below these components of the elements.
    fn ground(&self, places: &[usize]) -> GroundStiffness {
        let size = places.len();
        let entries: Vec<f64> = places
            .iter()
            .flat_map(|&i| places.iter().map(move |&j| self.compliance[i][j]))
            .collect();
        let inverse = inverse(&entries, size);
        let dofs = self.weight.len();
        let mut tractions = vec![vec![0.0; dofs]; size];
        for i in 0..size {
            for (j, &place) in places.iter().enumerate() {
                let factor = inverse[i * size + j];
                let row = &mut tractions[i];
                row.iter_mut().zip(&self.means[place]).for_each(|(r, b)| *r += factor * b);
            }
        }
        let mut stiffness = vec![vec![0.0; dofs]; dofs];
        for (row, &place) in tractions.iter().zip(places) {
            for i in 0..dofs {
                let factor = self.areas[place] * self.means[place][i];
                if factor != 0.0 {
                    (0..dofs).for_each(|j| stiffness[i][j] += factor * row[j]);
                }
            }
        }
        GroundStiffness { stiffness, tractions }
    }

    /// Smallest multiple of the forces at rest at which the structure buckles, bonded to these components.
    pub(super) fn load_factor(&self, places: &[usize]) -> f64 {
        let mut sum = self.ground(places).stiffness;
        let dofs = sum.len();
        for i in 0..dofs {
            for j in 0..i {
                let mean = 0.5 * (sum[i][j] + sum[j][i]);
                sum[i][j] = mean;
                sum[j][i] = mean;
            }
        }
        (0..dofs).for_each(|i| (0..dofs).for_each(|j| sum[i][j] += self.elastic[i][j]));
        let min_eigenvalue = eigenvalues(&self.geometric, &sum)[0];
        if min_eigenvalue < 0.0 { -1.0 / min_eigenvalue } else { f64::INFINITY }
    }

    /// Follows the equilibrium without friction while the weight and its P–Δ grow together.
    pub(super) fn follow_path(&self) -> PathEnd {
        let mut closed_elements: Vec<usize> = (0..self.count).collect();
        for increment in 1..=WEIGHT_INCREMENTS {
            let factor = increment as f64 / WEIGHT_INCREMENTS as f64;
            let mut set_changes = 0;
            loop {
                set_changes += 1;
                if set_changes > MAX_SET_CHANGES || closed_elements.is_empty() {
                    return path_lost_before(increment);
                }
                let Some(change) = self.set_change(&closed_elements, factor) else {
                    return path_lost_before(increment);
                };
                match change {
                    SetChange::Open(index) => {
                        closed_elements.remove(index);
                    }
                    SetChange::Close(place) => {
                        closed_elements.push(place);
                        closed_elements.sort_unstable();
                    }
                    SetChange::None => break,
                }
            }
        }
        PathEnd::Stands
    }

    /// Change of the closed elements that their equilibrium needs; `None` if that is not stable.
    fn set_change(&self, closed_elements: &[usize], factor: f64) -> Option<SetChange> {
        let GroundStiffness { stiffness: mut matrix, tractions } = self.ground(closed_elements);
        let dofs = self.weight.len();
        for i in 0..dofs {
            for j in 0..dofs {
                matrix[i][j] += self.elastic[i][j] + factor * self.geometric[i][j];
            }
        }
        self.add_soft_springs_along_the_ground(&mut matrix);
        if !is_definite(&matrix) {
            return None;
        }
        let load: Vec<f64> = self.weight.iter().map(|force| factor * force).collect();
        let displacement = solve(&matrix, &load);
        let pressures = multiply(&tractions, &displacement);
        let min_pressure_element =
            (0..closed_elements.len()).min_by(|&i, &j| pressures[i].total_cmp(&pressures[j]));
        if let Some(index) = min_pressure_element
            && pressures[index] < -1e-9 * largest_absolute(&pressures)
        {
            return Some(SetChange::Open(index));
        }
        let open_elements = (0..self.count).filter(|place| !closed_elements.contains(place));
        let smallest_gap = open_elements
            .map(|place| (self.gap(place, closed_elements, &pressures, &displacement), place))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        Some(match smallest_gap {
            Some((gap, place)) if gap < -1e-9 * largest_absolute(&displacement) => {
                SetChange::Close(place)
            }
            _ => SetChange::None,
        })
    }

    /// Adds springs that carry no force, since nothing pushes along the ground.
    fn add_soft_springs_along_the_ground(&self, matrix: &mut DenseMatrix) {
        let dofs = self.weight.len();
        for place in self.count..self.means.len() {
            let stiffness = 1e-3 / self.compliance[place][place];
            let row = &self.means[place];
            for i in (0..dofs).filter(|i| row[*i] != 0.0) {
                (0..dofs).for_each(|j| matrix[i][j] += stiffness * row[i] * row[j]);
            }
        }
    }

    /// Gap of an open element above the soil that the pressures of the closed elements deform.
    fn gap(
        &self,
        place: usize,
        closed_elements: &[usize],
        pressures: &[f64],
        displacement: &[f64],
    ) -> f64 {
        let products = closed_elements
            .iter()
            .zip(pressures)
            .map(|(&j, pressure)| self.compliance[place][j] * pressure);
        products.sum::<f64>() - dot(&self.means[place], displacement)
    }
}

/// Change of the set of closed elements.
enum SetChange {
    /// The closed element of this index opens.
    Open(usize),
    /// This element closes.
    Close(usize),
    None,
}

fn path_lost_before(increment: usize) -> PathEnd {
    PathEnd::LostAt((increment - 1) as f64 / WEIGHT_INCREMENTS as f64)
}

/// Whether a symmetric matrix is positive definite, by Cholesky's factors.
fn is_definite(matrix: &DenseMatrix) -> bool {
    let n = matrix.len();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let mean = 0.5 * (matrix[i][j] + matrix[j][i]);
            let remainder: f64 = mean - dot(&lower[i][..j], &lower[j][..j]);
            if i == j && remainder <= 0.0 {
                return false;
            }
            lower[i][j] = if i == j { remainder.sqrt() } else { remainder / lower[j][j] };
        }
    }
    true
}
