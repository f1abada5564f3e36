//! GOAL: simple shear of Iwan's model follows the backbone, and Masing's rules after reversals.
//! REFERENCE: τ = f(γ), and τ − τ_r = 2 f((γ − γ_r)/2) from a reversal (γ_r, τ_r) on (Masing 1926).

use super::{Iwan, SolidMaterial, hyperbolic_clay, table_clays, variables_at_rest};

/// Allowed error of a stress, relative to the strength.
const MASING_TOLERANCE: f64 = 1e-10;
/// Number of steps from one reversal to the next.
const BRANCH_STEP_COUNT: u32 = 23;

/// Backbone of points, linear between them, for strains of both signs.
fn backbone(points: &[[f64; 2]], strain: f64) -> f64 {
    let mut previous_point = [0.0; 2];
    for &point in points {
        if strain.abs() <= point[0] {
            let fraction = (strain.abs() - previous_point[0]) / (point[0] - previous_point[0]);
            let stress = previous_point[1] + fraction * (point[1] - previous_point[1]);
            return stress.copysign(strain);
        }
        previous_point = point;
    }
    previous_point[1].copysign(strain)
}

/// Shears in small steps to the strain `end`, and compares each stress with a scaled branch of the backbone.
///
/// The branch begins at the strain and stress of the last reversal; its strains and stresses are `factor` times those
/// of the backbone. Returns the strain and stress at the end.
fn follow(
    clay: &Iwan,
    variables: &mut [f64],
    [origin_strain, origin_stress]: [f64; 2],
    factor: f64,
    end: f64,
) -> [f64; 2] {
    let mut shear = origin_stress;
    for step in 1..=BRANCH_STEP_COUNT {
        let strain =
            origin_strain + (end - origin_strain) * f64::from(step) / f64::from(BRANCH_STEP_COUNT);
        let stress = clay.stress([0.0, 0.0, 0.0, strain], variables).unwrap();
        shear = stress[3];
        let branch = factor * backbone(clay.points(), (strain - origin_strain) / factor);
        let error = (shear - origin_stress - branch).abs();
        assert!(error <= MASING_TOLERANCE * clay.strength(), "{strain}: {shear}, {branch}");
        assert!(stress[..3].iter().all(|normal| normal.abs() <= 1e-9), "{stress:?}");
        clay.commit([0.0, 0.0, 0.0, strain], variables);
    }
    [end, shear]
}

#[test]
fn simple_shear_follows_masings_rules() {
    for clay in [&table_clays()[..], &[hyperbolic_clay()]].concat() {
        let limit_strain = clay.points().last().unwrap()[0];
        for amplitude in [0.02 * limit_strain, 0.3 * limit_strain, 1.7 * limit_strain] {
            let mut variables = variables_at_rest(&clay, [0.0; 4]);
            let top = follow(&clay, &mut variables, [0.0; 2], 1.0, amplitude);
            let bottom = follow(&clay, &mut variables, top, 2.0, -amplitude);
            // A smaller loop inside of the first one.
            let reversal = follow(&clay, &mut variables, bottom, 2.0, 0.5 * amplitude);
            let inner_reversal = follow(&clay, &mut variables, reversal, 2.0, -0.25 * amplitude);
            follow(&clay, &mut variables, inner_reversal, 2.0, 0.5 * amplitude);
            // Beyond the inner loop the stress is that of the branch from the bottom again.
            let strain = [0.0, 0.0, 0.0, 0.9 * amplitude];
            let shear = clay.stress(strain, &variables).unwrap()[3];
            let branch = bottom[1] + 2.0 * backbone(clay.points(), 0.95 * amplitude);
            assert!((shear - branch).abs() <= MASING_TOLERANCE * clay.strength());
        }
    }
}

/// The energy that a closed loop dissipates is its area.
#[test]
fn a_closed_loop_dissipates_its_area() {
    // The loop of one component is a parallelogram with elastic flanks; its area is 4 τ (γ − τ/G).
    let clay = Iwan::new(&[[1e-3, 20.0e3]], 0.3, 0.0).unwrap();
    let mut variables = variables_at_rest(&clay, [0.0; 4]);
    let mut dissipated_energies = [0.0; 2];
    for (reversal_index, strain) in [0.004, -0.004, 0.004].into_iter().enumerate() {
        clay.commit([0.0, 0.0, 0.0, strain], &mut variables);
        let energy = clay.energy([0.0, 0.0, 0.0, strain], &variables).unwrap();
        assert!((energy.stored - 0.5 * 20.0e3 * 1e-3).abs() < 1e-10);
        if reversal_index != 1 {
            dissipated_energies[reversal_index / 2] = energy.dissipated;
        }
        let state = clay.state([0.0, 0.0, 0.0, strain], &variables);
        assert!((state.plastic_strain - 0.003).abs() < 1e-12);
        assert!((state.mobilised_strength - 1.0).abs() < 1e-12);
    }
    assert!((dissipated_energies[0] - 20.0e3 * 0.003).abs() < 1e-9);
    assert!((dissipated_energies[1] - dissipated_energies[0] - 4.0 * 20.0e3 * 0.003).abs() < 1e-9);
}
