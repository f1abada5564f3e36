//! Forms of W on a lattice against its entries.

use super::super::newton::Newton;
use super::super::problem::{Bounds, ConeProblem};
use super::super::{
    compliance::ComplianceForm, lattice::LatticeCompliance, proximal::Proximal, search::find_forces,
};
use super::*;
use basemat_testkit::random::Random;

/// Elements along a side of the mat.
const SIDE_COUNT: usize = 10;
const ELEMENT_COUNT: usize = SIDE_COUNT * SIDE_COUNT;

/// Compliance between two elements of a lattice, without the structure.
fn soil(row: usize, column: usize) -> f64 {
    let cells = cells();
    let receiver = cells[row % ELEMENT_COUNT].map(|k| k as f64);
    let source = cells[column % ELEMENT_COUNT].map(|k| k as f64);
    let dx = source[0] - receiver[0];
    let distance = dx.hypot(source[1] - receiver[1]);
    match (row / ELEMENT_COUNT, column / ELEMENT_COUNT) {
        (i, j) if i == j => (-3.0 * distance).exp() * if i == 0 { 0.8 } else { 1.0 },
        (0, 1) => 0.1 * dx * (-4.0 * distance).exp(),
        (1, 0) => -0.1 * dx * (-4.0 * distance).exp(),
        _ => 0.0,
    }
}

/// Column and row of each element.
fn cells() -> Vec<[usize; 2]> {
    (0..ELEMENT_COUNT).map(|e| [e % SIDE_COUNT, e / SIDE_COUNT]).collect()
}

/// Near-field blocks of a problem on this soil.
fn blocks(problem: &ConeProblem, soil: impl Fn(usize, usize) -> f64) -> Option<NearFieldBlocks> {
    NearFieldBlocks::new(&problem.w, &problem.rho, &cells(), soil, |_| 0.0)
}

/// A rigid body on the lattice that partly lifts off and slides.
fn rocking_body(random: &mut Random, friction: f64) -> ConeProblem {
    let size = 3 * ELEMENT_COUNT;
    let mut problem = ConeProblem::new(ELEMENT_COUNT);
    let arms: Vec<[f64; 2]> = cells()
        .iter()
        .map(|cell| cell.map(|k| k as f64 - 0.5 * (SIDE_COUNT - 1) as f64))
        .collect();
    let modes: Vec<[f64; 4]> = (0..size)
        .map(|i| {
            let arm = arms[i % ELEMENT_COUNT];
            let normal_mode = [0.1, 0.0, 0.02 * arm[0], 0.02 * arm[1]];
            [normal_mode, [0.0, 0.1, 0.0, 0.05], [0.0, 0.0, 0.05, 0.0]][i / ELEMENT_COUNT]
        })
        .collect();
    for i in 0..size {
        for j in 0..size {
            let rigid: f64 = modes[i].iter().zip(&modes[j]).map(|(a, b)| a * b).sum();
            problem.w[i * size + j] = soil(i, j) + rigid;
        }
        let arm = arms[i % ELEMENT_COUNT];
        problem.static_force[i] = if i < ELEMENT_COUNT { 1.0 } else { 0.0 };
        problem.q[i] = 0.1 * random.within(-1.0, 1.0)
            + [0.25 * arm[0] - 0.1 * arm[1], 0.5, 0.3][i / ELEMENT_COUNT] * random.within(0.9, 1.1);
    }
    problem.bounds.fill(Bounds { friction, ..Bounds::WITHOUT_FRICTION });
    for bounds in problem.bounds.iter_mut().step_by(3) {
        (bounds.interval[1], bounds.hardening) = (1.2, 0.8);
    }
    problem.min_force_scale = 1.0;
    problem.update_scales();
    problem
}

/// The lattice form of W, whose elements have layers within the soil's compliance.
fn lattice_form(problem: &ConeProblem) -> ComplianceForm {
    let layer = |row: usize| if row < ELEMENT_COUNT { 0.3 } else { 0.2 };
    let soil = |i, j| soil(i, j) - if i == j { layer(i) } else { 0.0 };
    let lattice = LatticeCompliance::new(&problem.w, &cells(), soil, layer).unwrap();
    ComplianceForm::Lattice(Box::new(lattice))
}

/// Compares products with those of the entries, then with a number on the diagonal.
fn assert_multiplies_as_entries(problem: &mut ConeProblem, expected: &[f64]) {
    for added_diagonal in [0.0, 0.1] {
        problem.added_diagonal = added_diagonal;
        problem.update_displacements();
        let terms = problem.y.iter().zip(expected).zip(&problem.force_change);
        for ((computed, expected), change) in terms {
            let difference = computed - expected - added_diagonal * change;
            assert!(difference.abs() < 1e-13, "{computed} {expected}");
        }
    }
    problem.added_diagonal = 0.0;
}

#[test]
fn forms_on_a_lattice_multiply_as_the_entries_of_w() {
    let mut random = Random(3);
    let mut problem = rocking_body(&mut random, 0.5);
    let near_field = blocks(&problem, soil).unwrap();
    assert!(
        near_field.mode_count == 4 && near_field.near.blocks.len() < 20,
        "{} {}",
        near_field.mode_count,
        near_field.near.blocks.len()
    );
    // Each element is in one group, without elements near it.
    let mut has_group = [false; ELEMENT_COUNT];
    for group in &near_field.groups {
        let elements = group.iter().filter(|e| **e < ELEMENT_COUNT);
        for e in elements {
            assert!(!std::mem::replace(&mut has_group[*e], true));
            let links = near_field.near.of(*e);
            let links_in_group =
                links.iter().filter(|link| group.contains(&(link.element as usize))).count();
            assert!(links.len() < 20 && links_in_group == 1);
        }
    }
    assert!(has_group.iter().all(|has_group| *has_group) && near_field.groups.len() < 30);
    problem.force_change.iter_mut().for_each(|change| *change = random.within(-1.0, 1.0));
    problem.force_change[7] = 0.0;
    problem.update_displacements();
    let expected = problem.y.clone();
    problem.form = lattice_form(&problem);
    assert_multiplies_as_entries(&mut problem, &expected);
    problem.form = ComplianceForm::NearField(Box::new(near_field));
    assert_multiplies_as_entries(&mut problem, &expected);
    problem.update_displacements();
    // The stored product has the same bits as a new product.
    let stored = problem.y.clone();
    let change = problem.force_change.clone();
    problem.force_change.iter_mut().for_each(|change| *change *= 0.3);
    problem.update_displacements();
    problem.force_change.copy_from_slice(&change);
    problem.update_displacements();
    assert_eq!(stored, problem.y);
    problem.update_displacements();
    assert_eq!(stored, problem.y);
    // The structure's part of W is not positive.
    assert!(blocks(&problem, |i, j| 1.1 * soil(i, j)).is_none());
    // Blocks of equal offset differ, or the structure's part has too many modes.
    assert!(blocks(&problem, |i, j| soil(i, j) * (1 + i + j) as f64).is_none());
    assert!(blocks(&problem, |_, _| 0.0).is_none());
}

#[test]
fn sweeps_of_all_forms_find_the_same_forces() {
    let mut random = Random(5);
    let mut open_count = 0;
    let mut slide_count = 0;
    for friction in [0.2, 0.6, 1.5] {
        let mut problem = rocking_body(&mut random, friction);
        let near_field = blocks(&problem, soil).unwrap();
        let lattice = lattice_form(&problem);
        let mut solve = |form: ComplianceForm| {
            problem.form = form;
            problem.force_change.fill(0.0);
            let mut newton = Newton::new(ELEMENT_COUNT);
            let mut proximal = Proximal::new(ELEMENT_COUNT);
            let mut scratch = [(); 2].map(|()| vec![0.0; 3 * ELEMENT_COUNT]);
            let [initial, limited] = &mut scratch;
            let outcome =
                find_forces(&mut problem, &mut newton, &mut proximal, initial, limited, true);
            assert!(outcome.method.is_some() && problem.is_solved());
            // The proximal point method alone, too.
            let forces: Vec<f64> = (0..3 * ELEMENT_COUNT).map(|i| problem.force(i)).collect();
            problem.force_change.fill(0.0);
            let sweep = |problem: &mut ConeProblem| problem.sweep(200).is_solved;
            assert!(proximal.solve(&mut problem, sweep));
            for (i, expected) in forces.iter().enumerate() {
                assert!((problem.force(i) - expected).abs() < 1e-9, "{friction}, {i}");
            }
            forces
        };
        let expected = solve(ComplianceForm::Entries);
        for form in [ComplianceForm::NearField(Box::new(near_field)), lattice] {
            for (i, (expected, computed)) in expected.iter().zip(&solve(form)).enumerate() {
                assert!(
                    (expected - computed).abs() < 1e-10,
                    "{friction}, {i}: {expected} {computed}"
                );
            }
        }
        open_count += expected[..ELEMENT_COUNT].iter().filter(|p| **p == 0.0).count();
        slide_count += (0..ELEMENT_COUNT)
            .filter(|e| expected[*e] > 0.0 && problem.y[ELEMENT_COUNT + e].abs() > 1e-6)
            .count();
    }
    assert!(open_count > 10 && slide_count > 10, "{open_count} {slide_count}");
}
