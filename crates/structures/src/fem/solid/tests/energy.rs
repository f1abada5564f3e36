//! GOAL: work of the stress = stored energy + dissipation + mid-step remainder, and the signs of the last two.
//! SCENE: thousands of random steps, with and without an initial stress, through the tip of cones.
//! REFERENCE: the definition of the remainder; the projection inequality.

use basemat_testkit::random::Random;

use super::{
    DruckerPrager, Iwan, SolidMaterial, associated_sand, elastic, hyperbolic_clay, random_strain,
    table_clays, table_sands, variables_at_rest,
};
use crate::fem::internal_energy::InternalEnergy;
use crate::fem::solid::StrainPath;

/// Statistics of the energies in random steps of a material.
#[derive(Debug, Default)]
struct EnergyRange {
    /// Number of steps that dissipate energy.
    yielding_count: usize,
    /// Smallest remainder, relative to the energy of the step.
    min_remainder_ratio: f64,
    /// Largest remainder, relative to the energy of the step.
    max_remainder_ratio: f64,
}

/// Checks the energies of random steps, and returns their statistics.
fn checked_energy_range(
    material: &dyn SolidMaterial,
    initial_stress: [f64; 4],
    seed: u64,
) -> EnergyRange {
    let mut random = Random(seed);
    let mut energy_range = EnergyRange::default();
    for _ in 0..300 {
        let mut variables = variables_at_rest(material, initial_stress);
        let strain_size = random.log_within(1e-5, 1e-2);
        let mut start = [0.0; 4];
        let mut start_energy = material.energy(start, &variables).unwrap();
        // Rounding can place a component slightly outside of its yield surface, from where it returns.
        assert!(start_energy.stored.abs() < 1e-11 && start_energy.dissipated < 1e-12);
        start_energy = InternalEnergy::default();
        for _ in 0..12 {
            let increment = random_strain(&mut random, strain_size);
            let end = std::array::from_fn(|i| start[i] + increment[i]);
            // Most time schemes evaluate the stress in the middle of the step, others at a later strain.
            let position = if random.chance(0.8) { 0.5 } else { random.within(0.5, 1.0) };
            let midstep = std::array::from_fn(|i| start[i] + position * increment[i]);
            let path = StrainPath { start, midstep, end };
            let stress = material.stress(midstep, &variables).unwrap();
            let end_energy = material.energy(end, &variables).unwrap();
            let work: f64 = (0..4).map(|i| stress[i] * increment[i]).sum();
            let dissipation = end_energy.dissipated - start_energy.dissipated;
            let stored_change = end_energy.stored - start_energy.stored;
            let remainder = material.remainder(&path, &variables).unwrap();
            let scale = start_energy.stored.abs()
                + end_energy.stored.abs()
                + end_energy.dissipated
                + (0..4).map(|i| (stress[i] * increment[i]).abs()).sum::<f64>();
            assert!(
                (work - stored_change - dissipation - remainder).abs() <= 1e-11 * scale,
                "{material:?}, {path:?}: {work}, {stored_change}, {dissipation}, {remainder}"
            );
            assert!(dissipation >= 0.0, "{material:?}, {path:?}: {dissipation}");
            if position == 0.5 {
                let ratio = remainder / scale;
                energy_range.min_remainder_ratio = energy_range.min_remainder_ratio.min(ratio);
                energy_range.max_remainder_ratio = energy_range.max_remainder_ratio.max(ratio);
            }
            energy_range.yielding_count += usize::from(dissipation > 1e-6 * scale);
            material.commit(end, &mut variables);
            start = end;
            start_energy = end_energy;
            let state = material.state(end, &variables);
            assert!(state.plastic_strain >= 0.0 && (0.0..=1.0).contains(&state.mobilised_strength));
        }
    }
    energy_range
}

/// Rounding of a remainder, relative to the energy of the step.
const REMAINDER_ROUNDING: f64 = 1e-12;

#[test]
fn iwans_model_dissipates_and_loses_work_at_midstep() {
    let mut clays = table_clays();
    clays.push(hyperbolic_clay());
    clays.push(Iwan::new(&[[1e-4, 1.0e3]], -0.2, 0.0).unwrap());
    for (seed, clay) in clays.iter().enumerate() {
        let shear = 0.5 * clay.strength();
        for initial_stress in [[0.0; 4], [-2.0e5, -2.0e5 + shear, -2.2e5, -0.5 * shear]] {
            if clay.strength() < 2.0e4 && initial_stress != [0.0; 4] {
                continue;
            }
            let energy_range = checked_energy_range(clay, initial_stress, seed as u64);
            assert!(energy_range.min_remainder_ratio >= -REMAINDER_ROUNDING, "{energy_range:?}");
            assert!(energy_range.max_remainder_ratio > 1e-3, "{energy_range:?}");
            assert!(energy_range.yielding_count > 1000, "{energy_range:?}");
        }
    }
}

#[test]
fn drucker_pragers_law_dissipates_and_with_associated_flow_loses_work_at_midstep() {
    let mut sands = table_sands();
    sands.push(associated_sand());
    let no_cohesion = DruckerPrager::new(elastic(3.0e7, 5.0e7), 0.0, 0.6, 0.6).unwrap();
    sands.push(no_cohesion);
    for (seed, sand) in sands.iter().enumerate() {
        for initial_stress in [[0.0; 4], [-0.9e5, -1.0e5, -0.8e5, 0.5e4]] {
            let energy_range = checked_energy_range(sand, initial_stress, seed as u64);
            let is_associated = sand.friction_angle() == sand.dilation_angle();
            let has_lost_work_only = energy_range.min_remainder_ratio >= -REMAINDER_ROUNDING;
            assert_eq!(has_lost_work_only, is_associated, "{sand:?}: {energy_range:?}");
            assert!(energy_range.max_remainder_ratio > 1e-3, "{sand:?}: {energy_range:?}");
            // Without cohesion and with ψ = φ all work is stored, or lost at mid-step.
            let dissipates = sand.cohesion() > 0.0 || !is_associated;
            assert_eq!(energy_range.yielding_count > 500, dissipates, "{sand:?}: {energy_range:?}");
        }
    }
}

/// A linear material uses the trait's default, which is the definition of the remainder.
#[test]
fn a_linear_material_loses_no_work_at_midstep() {
    let material = elastic(3.0e7, 5.0e7);
    let energy_range = checked_energy_range(&material, [0.0; 4], 1);
    assert_eq!(energy_range.yielding_count, 0);
    assert!(energy_range.min_remainder_ratio >= -REMAINDER_ROUNDING, "{energy_range:?}");
    assert!(energy_range.max_remainder_ratio <= REMAINDER_ROUNDING, "{energy_range:?}");
}

/// R ≥ |2 s_m − s_0 − s_1|²/(4 G) for a component.
#[test]
fn the_remainder_of_a_component_has_a_lower_bound() {
    let shear_modulus = 10.0e6;
    let clay = Iwan::new(&[[1e-3, 1e-3 * shear_modulus]], 0.3, 0.0).unwrap();
    let mut random = Random(5);
    let mut variables = variables_at_rest(&clay, [0.0; 4]);
    let mut start = [0.0; 4];
    for _ in 0..3000 {
        let increment = random_strain(&mut random, 2e-3);
        let end = std::array::from_fn(|i| start[i] + increment[i]);
        let midstep = std::array::from_fn(|i| start[i] + 0.5 * increment[i]);
        let stresses = [start, midstep, end].map(|strain| clay.stress(strain, &variables).unwrap());
        let curvature =
            std::array::from_fn(|i| 2.0 * stresses[1][i] - stresses[0][i] - stresses[2][i]);
        let [xx, yy, zz, xy] = curvature;
        let bound = (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy) / (4.0 * shear_modulus);
        let remainder = clay.remainder(&StrainPath { start, midstep, end }, &variables).unwrap();
        assert!(remainder >= bound - 1e-9, "{remainder} < {bound}");
        clay.commit(end, &mut variables);
        start = end;
    }
}

/// The ratio of remainder to dissipation falls with the square of the step.
///
/// It falls by a factor of 64 for steps an eighth as long.
///
/// The factor scatters, because it depends on where in a step the material begins to yield.
#[test]
fn the_remainder_is_of_second_order() {
    let clay = hyperbolic_clay();
    let sand = associated_sand();
    for (material, amplitude) in [(&clay as &dyn SolidMaterial, 5e-3), (&sand, 1e-2)] {
        let ratios = [400_u32, 3200].map(|step_count| {
            let mut variables = variables_at_rest(material, [-1.0e5, -1.0e5, -1.0e5, 0.0]);
            let mut start = [0.0; 4];
            let mut sum = 0.0;
            for step in 1..=step_count {
                let phase = std::f64::consts::TAU * f64::from(step) / f64::from(step_count);
                let stretch = 0.5 * amplitude * (1.0 - phase.cos());
                // The direction of the strain changes in every step.
                let end = [-stretch, stretch, 0.0, amplitude * phase.sin()];
                let midstep = std::array::from_fn(|i| 0.5 * (start[i] + end[i]));
                let path = StrainPath { start, midstep, end };
                sum += material.remainder(&path, &variables).unwrap();
                material.commit(end, &mut variables);
                start = end;
            }
            sum / material.energy(start, &variables).unwrap().dissipated
        });
        assert!((35.0..120.0).contains(&(ratios[0] / ratios[1])), "{ratios:?}");
    }
}
