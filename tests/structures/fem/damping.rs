//! GOAL: Rayleigh damping and dashpots.
//! SCENE: pairs of frequencies and ratios; a meshed column with a spring and a dashpot.
//! REFERENCE: the ratios at both frequencies; α M + β K plus the dashpots.

use basemat::fem::{Dashpot, Direction, Layer, Material, Mesh, Spring};
use basemat::structure::{FemModel, RayleighDamping};
use basemat_problems::dense::{damping, mass, stiffness};

#[test]
fn ratios_are_met_at_both_frequencies() {
    for (frequencies, ratios) in
        [([0.8, 7.0], [0.05, 0.05]), ([7.0, 0.8], [0.03, 0.02]), ([2.0, 3.0], [0.02, 0.03])]
    {
        let damping = RayleighDamping::from_ratios(frequencies, ratios).unwrap();
        for (frequency, ratio) in frequencies.into_iter().zip(ratios) {
            assert!((damping.ratio(frequency) - ratio).abs() < 1e-15);
        }
    }
    // α = 2 ζ ω₁ω₂/(ω₁+ω₂), β = 2 ζ/(ω₁+ω₂) for equal ratios
    let tau = std::f64::consts::TAU;
    let equal = RayleighDamping::from_ratios([1.0, 4.0], [0.05, 0.05]).unwrap();
    assert!((equal.mass() - 0.1 * tau * 4.0 / 5.0).abs() < 1e-15);
    assert!((equal.stiffness() - 0.1 / (5.0 * tau)).abs() < 1e-17);
}

/// A column of two quadrilaterals; with a dashpot it has a spring, too.
fn column_mesh(dashpot: Option<f64>) -> Mesh {
    let layers = [Layer::new(2.0, 2, Material::new(1.0e7, 0.2, 2000.0).unwrap())];
    let mut mesh = Mesh::layered_block(0.0..1.0, 1, &layers).unwrap();
    if let Some(coefficient) = dashpot {
        mesh.add(Dashpot::new([2, 4], Direction::X, coefficient).unwrap()).unwrap();
        mesh.add(Spring::axial([0, 3], 9.0e5).unwrap()).unwrap();
    }
    mesh
}

#[test]
fn damping_matrix_is_alpha_m_plus_beta_k_plus_dashpots() {
    let rayleigh = RayleighDamping::new(0.3, 0.002).unwrap();
    let model = FemModel::on_base(column_mesh(Some(500.0))).unwrap().with_rayleigh(rayleigh);
    let computed = damping(&model);
    let m = mass(&model);
    let k = stiffness(&model);
    for i in 0..computed.len() {
        for j in 0..computed.len() {
            let dashpot = match (i, j) {
                (4, 4) | (8, 8) => 500.0,
                (4, 8) | (8, 4) => -500.0,
                _ => 0.0,
            };
            let expected = 0.3 * m[i][j] + 0.002 * k[i][j] + dashpot;
            assert!((computed[i][j] - expected).abs() < 1e-9 * computed[i][i], "({i}, {j})");
        }
    }
    let undamped_model = FemModel::on_base(column_mesh(None)).unwrap();
    assert!(damping(&undamped_model).iter().flatten().all(|&value| value == 0.0));
}
