//! GOAL: elements of several cells are sums of their cells.
//! SCENE: a rectangle of 35 cells in 15 unions, tractions in three directions.
//! REFERENCE: the ground of the cells under tractions equal over each union, and means over it.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground};
use basemat::soil::SoilProfile;
use basemat::{Result, Soil, unobserved};
use basemat_problems::dense::{dot, largest};
use basemat_problems::random::Random;

const CELL_COUNT: usize = 35;
const UNION_COUNT: usize = 15;
/// Cells of the unions along x and y.
const UNION_COLUMNS: [usize; 3] = [1, 3, 1];
const UNION_ROWS: [usize; 5] = [1, 2, 2, 1, 1];

fn half_space() -> SoilProfile {
    Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap().into()
}

fn rectangle() -> Plan {
    Plan::rectangle(-1.0..1.0, -1.5..1.5, 5).unwrap()
}

/// Assignment of cells to unions.
struct UnionMap {
    /// Union of each cell.
    union_of_cell: Vec<usize>,
    /// Number of cells of each union.
    sizes: Vec<usize>,
}

impl UnionMap {
    fn new() -> Self {
        let union_columns = repeated_indices(&UNION_COLUMNS);
        let union_rows = repeated_indices(&UNION_ROWS);
        let union_of_cell: Vec<usize> = (0..CELL_COUNT)
            .map(|cell| union_rows[cell / 5] * UNION_COLUMNS.len() + union_columns[cell % 5])
            .collect();
        let mut sizes = vec![0; UNION_COUNT];
        for union in &union_of_cell {
            sizes[*union] += 1;
        }
        Self { union_of_cell, sizes }
    }

    /// Means over the unions of values of the cells, in three directions.
    fn means(&self, values: &[f64]) -> Vec<f64> {
        let mut means = vec![0.0; 3 * UNION_COUNT];
        for (index, value) in values.iter().enumerate() {
            let union = self.union_of_cell[index % CELL_COUNT];
            means[index / CELL_COUNT * UNION_COUNT + union] += value / self.sizes[union] as f64;
        }
        means
    }

    /// Values of the unions at their cells, in three directions.
    fn at_cells(&self, values: &[f64]) -> Vec<f64> {
        (0..3 * CELL_COUNT)
            .map(|n| values[n / CELL_COUNT * UNION_COUNT + self.union_of_cell[n % CELL_COUNT]])
            .collect()
    }
}

/// Each index, repeated as often as its count.
fn repeated_indices(counts: &[usize]) -> Vec<usize> {
    counts.iter().enumerate().flat_map(|(index, count)| vec![index; *count]).collect()
}

/// Product of a compliance matrix, row by row, and a vector.
fn multiply(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| dot(row, vector)).collect()
}

/// Largest difference, relative to the largest expected value.
fn relative_difference(computed: &[f64], expected: &[f64]) -> f64 {
    let differences = computed.iter().zip(expected).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / largest(expected)
}

/// Displacements by the step compliance, or by the static compliance.
fn displacements(ground: &ElasticGround, is_static: bool, tractions: &[f64]) -> Vec<f64> {
    let mut matrix = vec![0.0; tractions.len() * tractions.len()];
    if is_static {
        ground.static_compliance(&mut matrix).unwrap();
    } else {
        ground.step_compliance(&mut matrix).unwrap();
    }
    multiply(&matrix, tractions)
}

/// GOAL: areas, histories and compliances of unions are those of their cells.
#[test]
fn unions_are_sums_of_cells() {
    let plan = rectangle();
    let united = plan.clone().with_unions(&UNION_COLUMNS, &UNION_ROWS).unwrap();
    let mut cells = ElasticGround::in_plan(half_space(), plan.clone()).unwrap();
    let mut unions = ElasticGround::in_plan(half_space(), united).unwrap();
    assert_eq!((cells.elements().len(), unions.elements().len()), (CELL_COUNT, UNION_COUNT));
    let map = UnionMap::new();
    let cell_area = plan.pitch()[0] * plan.pitch()[1];
    for (element, size) in unions.elements().iter().zip(&map.sizes) {
        let area = element.sides()[0] * element.sides()[1];
        assert!((area / cell_area - *size as f64).abs() < 1e-12);
    }
    for ground in [&mut cells, &mut unions] {
        ground.prepare(0.2, None, &mut unobserved).unwrap();
    }
    let mut random = Random(6);
    let mut traction = vec![0.0; 3 * UNION_COUNT];
    let mut computed = vec![0.0; 3 * UNION_COUNT];
    let mut cell_history = vec![0.0; 3 * CELL_COUNT];
    for _ in 0..40 {
        traction.fill_with(|| random.within(-1.0, 1.0));
        unions.history(&mut computed).unwrap();
        cells.history(&mut cell_history).unwrap();
        let error = relative_difference(&computed, &map.means(&cell_history));
        assert!(cell_history[0] == 0.0 || error < 1e-13, "{error:e}");
        unions.commit(&traction);
        cells.commit(&map.at_cells(&traction));
    }
    for is_static in [false, true] {
        let computed = displacements(&unions, is_static, &traction);
        let expected = map.means(&displacements(&cells, is_static, &map.at_cells(&traction)));
        assert!(relative_difference(&computed, &expected) < 1e-13);
    }
}

fn with_unions(columns: &[usize], rows: &[usize]) -> Result<Plan> {
    rectangle().with_unions(columns, rows)
}

/// An L in a mask of four by four cells.
fn l_shape_with_unions(columns: &[usize], rows: &[usize]) -> Result<Plan> {
    let mask = "##..##..########".chars().map(|c| c == '#').collect::<Vec<_>>();
    Plan::masked([-1.0; 2], [0.5; 2], 4, &mask).unwrap().with_unions(columns, rows)
}

/// GOAL: unions that do not fill the cells of a mat are errors.
#[test]
fn invalid_unions_are_errors() {
    for columns in [&[1, 4][..], &[2, 2, 1], &[1, 3]] {
        assert!(with_unions(columns, &UNION_ROWS).is_err(), "{columns:?}");
    }
    assert!(with_unions(&UNION_COLUMNS, &[1, 2, 2, 2]).is_err());
    // Sums beyond the range of numbers, and unions without cells.
    for sizes in [&[usize::MAX, 5][..], &[usize::MAX, usize::MAX, 1], &[0, 1, 3, 1]] {
        assert!(with_unions(sizes, &UNION_ROWS).is_err(), "{sizes:?}");
        assert!(with_unions(&UNION_COLUMNS, sizes).is_err(), "{sizes:?}");
    }
    // A union over the missing corner.
    assert!(l_shape_with_unions(&[1, 2, 1], &[1, 1, 1, 1]).is_err());
    assert!(l_shape_with_unions(&[1, 1, 1, 1], &[1, 1, 1, 1]).is_ok());
}
