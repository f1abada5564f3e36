//! GOAL: beams and trusses.
//! SCENE: cantilevers in any direction, with and without shear flexibility; a bracket of two bars.
//! REFERENCE: Euler–Bernoulli and Timoshenko theory, orders of convergence.

use basemat::fem::{Beam, Direction, MassKind, Mesh, Truss};
use basemat::structure::{FemModel, Structure};
use basemat_problems::dense::{
    eigenvalues, form, mass, solve_with_prescribed, stiffness, submatrix,
};

const YOUNG_MODULUS: f64 = 30.0e9;
const SECTION_AREA: f64 = 0.4;
const SECOND_MOMENT: f64 = 0.02;
const MASS_DENSITY: f64 = 2400.0;

/// Straight beam of `length` in the direction `angle` with a weak bar that makes a base of two.
fn cantilever(length: f64, angle: f64, elements: usize, shear: Option<f64>) -> FemModel {
    let mut mesh = Mesh::new();
    let (sin, cos) = angle.sin_cos();
    for k in 0..=elements {
        let s = length * k as f64 / elements as f64;
        mesh.add_node(s * cos, s * sin).unwrap();
    }
    for k in 0..elements {
        let beam = Beam::new([k, k + 1], YOUNG_MODULUS, SECTION_AREA, SECOND_MOMENT, MASS_DENSITY)
            .unwrap();
        let beam = match shear {
            Some(stiffness) => beam.with_shear_stiffness(stiffness).unwrap(),
            None => beam,
        };
        mesh.add(beam).unwrap();
    }
    let other_node = mesh.add_node(-1.0, 0.0).unwrap();
    mesh.add(Truss::new([other_node, 0], 1.0, 1.0, 0.0).unwrap()).unwrap();
    FemModel::new(mesh, &[other_node, 0]).unwrap()
}

/// All degrees of freedom except at the clamped foot and at the bar's far end.
fn free_dofs(model: &FemModel) -> Vec<usize> {
    (3..model.dofs() - 2).collect()
}

#[test]
fn tip_deflection_is_that_of_euler_bernoulli_and_timoshenko() {
    let length = 5.0;
    let load = 1000.0;
    for angle in [0.0_f64, 0.5, 2.0] {
        for shear in [None, Some(2.0e9)] {
            let model = cantilever(length, angle, 3, shear);
            let n = model.dofs();
            let fixed: Vec<(usize, f64)> = [0, 1, 2, n - 2, n - 1].map(|k| (k, 0.0)).to_vec();
            let mut force = vec![0.0; n];
            let x = model.dof(3, Direction::X).unwrap();
            let y = model.dof(3, Direction::Y).unwrap();
            let turn = model.dof(3, Direction::Rotation).unwrap();
            // Across the beam, to the left: turns its tip counter-clockwise.
            force[x] = -load * angle.sin();
            force[y] = load * angle.cos();
            let computed = solve_with_prescribed(&stiffness(&model), &force, &fixed);
            let deflection = -computed[x] * angle.sin() + computed[y] * angle.cos();
            let expected = load * length.powi(3) / (3.0 * YOUNG_MODULUS * SECOND_MOMENT)
                + shear.map_or(0.0, |stiffness| load * length / stiffness);
            assert!((deflection / expected - 1.0).abs() < 1e-11, "{angle} {shear:?}");
            let slope = load * length.powi(2) / (2.0 * YOUNG_MODULUS * SECOND_MOMENT);
            assert!((computed[turn] / slope - 1.0).abs() < 1e-11);
            let along = computed[x] * angle.cos() + computed[y] * angle.sin();
            assert!(along.abs() < 1e-11 * expected);
        }
    }
}

/// Error of the squared frequency of a cantilever of 8 m.
fn frequency_error(elements: usize, kind: MassKind) -> f64 {
    let length = 8.0;
    let expected = (1.875_104_068_711_961_f64.powi(4)) * YOUNG_MODULUS * SECOND_MOMENT
        / (MASS_DENSITY * SECTION_AREA * f64::powi(length, 4));
    let model = cantilever(length, 0.7, elements, None).with_mass(kind);
    let free = free_dofs(&model);
    let computed =
        eigenvalues(&submatrix(&stiffness(&model), &free), &submatrix(&mass(&model), &free))[0];
    computed / expected - 1.0
}

/// First bending frequency of a cantilever, (1.87510407)² √(EI/(ρ A L⁴)): fourth order with
/// consistent mass, second with lumped.
#[test]
fn cantilever_frequency_converges_with_its_order() {
    for (kind, order) in [(MassKind::Consistent, 4.0), (MassKind::Lumped, 2.0)] {
        let coarse = frequency_error(4, kind);
        let fine = frequency_error(8, kind);
        println!("{kind:?}, square of the frequency, four and eight elements: {coarse:e} {fine:e}");
        assert_eq!(fine > 0.0, kind == MassKind::Consistent, "bound from above or below");
        let computed: f64 = (coarse / fine).log2();
        assert!((computed - order).abs() < 0.1, "{kind:?}: {computed}");
    }
}

/// With very small shear flexibility, Timoshenko's matrices become Euler–Bernoulli's.
#[test]
fn timoshenko_tends_to_euler_bernoulli() {
    let thin_beam = cantilever(3.0, 0.3, 1, None);
    let stiff_beam = cantilever(3.0, 0.3, 1, Some(1.0e22));
    for (a, b) in
        [(stiffness(&thin_beam), stiffness(&stiff_beam)), (mass(&thin_beam), mass(&stiff_beam))]
    {
        for (x, y) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((x - y).abs() <= 1e-9 * a[4][4]);
        }
    }
}

/// A parabola w = x² has no shear: both beams carry it exactly, and ∫ ρ A w² = ρ A L⁵/5.
#[test]
fn consistent_mass_carries_constant_curvature_exactly() {
    let length = 3.0_f64;
    for shear in [None, Some(1.0e8)] {
        let model = cantilever(length, 0.0, 1, shear);
        let mut field = vec![0.0; model.dofs()];
        field[4] = length.powi(2);
        field[5] = 2.0 * length;
        let computed = form(&field, &mass(&model), &field);
        let expected = MASS_DENSITY * SECTION_AREA * length.powi(5) / 5.0;
        assert!((computed / expected - 1.0).abs() < 1e-13, "{shear:?}");
    }
}

/// Two bars at 45° under a vertical load: each carries P/√2, the tip sinks by P L/(E A).
#[test]
fn bracket_of_two_trusses_sinks_by_its_closed_form() {
    let mut mesh = Mesh::new();
    let nodes = [[-2.0, 0.0], [2.0, 0.0], [0.0, 2.0]].map(|[x, y]| mesh.add_node(x, y).unwrap());
    let top = nodes[2];
    for foot in [nodes[0], nodes[1]] {
        mesh.add(Truss::new([foot, top], YOUNG_MODULUS, 0.01, MASS_DENSITY).unwrap())
            .unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let fixed: Vec<(usize, f64)> = (0..4).map(|index| (index, 0.0)).collect();
    let load = [0.0, 0.0, 0.0, 0.0, 700.0, -1000.0];
    let computed = solve_with_prescribed(&stiffness(&model), &load, &fixed);
    let flexibility = 8.0_f64.sqrt() / (YOUNG_MODULUS * 0.01);
    assert!((computed[5] / (-1000.0 * flexibility) - 1.0).abs() < 1e-12);
    assert!((computed[4] / (700.0 * flexibility) - 1.0).abs() < 1e-12);
}
