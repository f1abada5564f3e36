//! Laws of fibres against closed forms, differences, and the energy balance.

use super::{BilinearSteel, Concrete, MenegottoPinto, UniaxialMaterial, UniaxialResponse};
use crate::error::Error;
use crate::fem::internal_energy::InternalEnergy;
use basemat_testkit::random::Random;

/// Laws with their name, a strain scale, and whether they never create dissipation.
fn laws() -> Vec<(&'static str, Box<dyn UniaxialMaterial>, f64)> {
    let steel = BilinearSteel::new(400.0e6, 200.0e9, 0.02).unwrap();
    let curved = MenegottoPinto::new(400.0e6, 200.0e9, 0.02).unwrap();
    let hardening = curved
        .with_transition(20.0, 0.9, 0.15)
        .unwrap()
        .with_isotropic_hardening([0.1, 10.0, 0.1, 10.0])
        .unwrap();
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap();
    vec![
        ("bilinear", Box::new(steel), 0.004),
        ("Menegotto and Pinto", Box::new(curved), 0.004),
        ("isotropic hardening", Box::new(hardening), 0.004),
        ("concrete", Box::new(concrete), 0.003),
    ]
}

/// Tangents are derivatives of stresses, evaluation changes nothing, and the balance of energy closes in every step.
#[test]
fn tangents_and_energies_belong_to_the_stress() {
    for (name, law, scale) in laws() {
        let mut random = Random(11);
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&mut variables);
        let mut start = 0.0;
        let mut checked_count = 0;
        for step in 0..400 {
            let end = scale * random.within(-2.0, 1.0);
            let midstep = 0.5 * (start + end);
            let response = law.response(midstep, &variables).unwrap();
            let h = 1e-7 * scale;
            let [below, above] =
                [midstep - h, midstep + h].map(|strain| law.response(strain, &variables).unwrap());
            // Not across a kink.
            let second_difference = above.stress - 2.0 * response.stress + below.stress;
            if second_difference.abs() < 1e-6 * law.modulus() * h
                && (end - start).abs() > 1e-3 * scale
            {
                let difference = (above.stress - below.stress) / (2.0 * h);
                let error = (difference - response.tangent).abs() / law.modulus();
                assert!(error < 1e-6, "{name}, step {step}: {error}");
                checked_count += 1;
            }
            // The remainder is the work of the midstep stress less the changes of energy.
            let before = law.energy(start, &variables).unwrap();
            let after = law.energy(end, &variables).unwrap();
            let work = response.stress * (end - start);
            let change = after.stored + after.dissipated - before.stored - before.dissipated;
            let remainder = law.remainder([start, midstep, end], &variables).unwrap();
            let error = (work - change - remainder).abs();
            assert!(error < 1e-9 * law.modulus() * scale * scale, "{name}, step {step}: {error}");
            let end_response = law.response(end, &variables).unwrap();
            law.commit(end, &mut variables);
            // A commit changes neither stress nor energy.
            let committed = law.response(end, &variables).unwrap();
            assert!(
                (committed.stress - end_response.stress).abs() < 1e-6 * law.modulus() * scale,
                "{name}, step {step}"
            );
            let committed_energy = law.energy(end, &variables).unwrap();
            assert!((committed_energy.stored - after.stored).abs() < 1e-6, "{name}");
            assert!(
                (committed_energy.dissipated - after.dissipated).abs()
                    < 1e-9 * law.modulus() * scale * scale,
                "{name}"
            );
            start = end;
        }
        assert!(checked_count > 200, "{name}: {checked_count}");
    }
}

/// Number of steps of the loops.
const LOOP_STEP_COUNT: usize = 20_000;

/// Work of small steps around closed loops is the dissipated energy.
#[test]
fn work_of_loops_is_the_dissipated_energy() {
    for (name, law, scale) in laws() {
        let mut variables = vec![0.0; law.variable_count()];
        law.initialize(&mut variables);
        let mut work = 0.0;
        let mut last_strain = 0.0;
        let mut last_dissipated = 0.0;
        let mut last_stress = 0.0;
        let mut decrease_count = 0;
        let rounding = 1e-9 * law.modulus() * scale * scale;
        for step in 1..=LOOP_STEP_COUNT {
            let t = step as f64 / LOOP_STEP_COUNT as f64;
            let strain = 2.0 * scale * t * (6.0 * std::f64::consts::PI * t).sin();
            let stress = law.response(0.5 * (last_strain + strain), &variables).unwrap().stress;
            work += stress * (strain - last_strain);
            let dissipated = law.energy(strain, &variables).unwrap().dissipated;
            let change = dissipated - last_dissipated;
            let end_stress = law.response(strain, &variables).unwrap().stress;
            let mean_stress = 0.5 * (last_stress + end_stress);
            let tolerance = match name {
                // The residual strain falls by 0.006 ε_c0 at the strain 2 ε_c0, as in its source.
                "concrete" => 0.5 * 30.0e6 * 0.006 * 0.002,
                // Unloading leaves the straight line of σ²/(2E) at once, and recovers more.
                "Menegotto and Pinto" | "isotropic hardening"
                    if mean_stress * (strain - last_strain) < 0.0 =>
                {
                    let elastic_change = (end_stress - last_stress) / law.modulus();
                    let expected = mean_stress * (strain - last_strain - elastic_change);
                    assert!((change - expected).abs() < rounding, "{name}, step {step}");
                    f64::INFINITY
                }
                _ => rounding,
            };
            assert!(change >= -tolerance, "{name}, step {step}: {change}");
            decrease_count += usize::from(change < -rounding);
            law.commit(strain, &mut variables);
            last_strain = strain;
            last_stress = end_stress;
            last_dissipated = dissipated;
        }
        assert!(
            decrease_count <= 1 || name.contains("hardening") || name.contains("Pinto"),
            "{name}"
        );
        let energy = law.energy(last_strain, &variables).unwrap();
        let total = energy.stored + energy.dissipated;
        assert!((work - total).abs() < 1e-4 * total, "{name}: {work} {total}");
        assert!(energy.dissipated > 0.5 * total, "{name}");
    }
}

/// Steel yields at its stress in tension and compression; its hardening is kinematic.
#[test]
fn bilinear_steel_has_the_elastic_range_of_twice_its_yield_stress() {
    let steel = BilinearSteel::new(400.0e6, 200.0e9, 0.1).unwrap();
    let mut variables = vec![0.0; 2];
    steel.commit(0.012, &mut variables);
    // 400 MPa at 0.002, then 20 GPa.
    let peak = steel.response(0.012, &variables).unwrap().stress;
    assert!((peak - 600.0e6).abs() < 1.0);
    let reversed = steel.response(0.012 - 0.004, &variables).unwrap();
    assert!((reversed.stress + 200.0e6).abs() < 1.0);
    let beyond = steel.response(0.012 - 0.014, &variables).unwrap();
    assert!((beyond.stress + 400.0e6).abs() < 1.0 && (beyond.tangent - 20.0e9).abs() < 1.0);
}

/// Concrete unloads to the residual strains of Karsan and Jirsa, and cracks open without stress.
#[test]
fn concrete_unloads_to_residual_strains_and_cracks() {
    let concrete = Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap();
    for (compression, residual_ratio) in
        [(0.003, 0.145 * 2.25 + 0.13 * 1.5), (0.005, 0.707 * 0.5 + 0.834)]
    {
        let mut variables = [0.0; 4];
        concrete.initialize(&mut variables);
        concrete.commit(-compression, &mut variables);
        let residual = 0.002 * residual_ratio;
        let stress = concrete.response(-compression, &variables).unwrap().stress;
        let middle = concrete.response(-0.5 * (compression + residual), &variables).unwrap();
        assert!((middle.stress - 0.5 * stress).abs() < 1.0, "{compression}");
        assert_eq!(concrete.response(-residual + 1e-9, &variables).unwrap().stress, 0.0);
        assert_eq!(concrete.response(0.01, &variables).unwrap().stress, 0.0);
    }
    // Beyond the ultimate strain the stress is constant.
    let mut variables = [0.0; 4];
    concrete.initialize(&mut variables);
    assert_eq!(concrete.response(-0.02, &variables).unwrap().stress, -6.0e6);
}

/// A reversal of one unit in the last place on the asymptote gives a finite stress.
#[test]
fn curved_steel_survives_reversals_by_rounding() {
    for hardening_ratio in [0.0, 0.02] {
        let steel = MenegottoPinto::new(400.0e6, 200.0e9, hardening_ratio).unwrap();
        // At the last two, rounding puts the reversal on the asymptote, without and with hardening.
        for peak in [0.002_f64, 0.01, 0.037_797_484_290_084_275, 0.060_461_340_276_849_03] {
            let mut variables = vec![0.0; steel.variable_count()];
            for strain in [peak, peak.next_down(), peak] {
                steel.commit(strain, &mut variables);
            }
            let response = steel.response(peak + 1e-4, &variables).unwrap();
            assert!(response.stress.is_finite() && response.tangent.is_finite(), "{peak}");
            assert!(response.stress > 200.0e6 && response.stress < 700.0e6, "{response:?}");
        }
    }
}

/// A wrong number of internal variables is an error, and commits nothing.
#[test]
fn wrong_numbers_of_variables_are_refused() {
    let laws: [&dyn UniaxialMaterial; 3] = [
        &BilinearSteel::new(400.0e6, 200.0e9, 0.01).unwrap(),
        &MenegottoPinto::new(400.0e6, 200.0e9, 0.01).unwrap(),
        &Concrete::new(30.0e6, 0.002, 6.0e6, 0.006).unwrap(),
    ];
    for law in laws {
        assert!(matches!(law.response(-0.001, &[]), Err(Error::Size { .. })), "{law:?}");
        assert!(matches!(law.energy(-0.001, &[0.0; 12]), Err(Error::Size { .. })), "{law:?}");
        assert!(law.remainder([0.0, -0.001, -0.002], &[0.0]).is_err(), "{law:?}");
        let mut variables = [0.0];
        law.commit(-0.001, &mut variables);
        assert_eq!(variables, [0.0], "{law:?}");
    }
}

/// Values that no law can have are refused.
#[test]
fn impossible_laws_are_refused() {
    assert!(BilinearSteel::new(0.0, 200.0e9, 0.01).is_err());
    assert!(BilinearSteel::new(400.0e6, 200.0e9, 1.0).is_err());
    assert!(MenegottoPinto::new(400.0e6, f64::NAN, 0.01).is_err());
    assert!(Concrete::new(30.0e6, 0.002, 31.0e6, 0.006).is_err());
    assert!(Concrete::new(30.0e6, 0.002, 6.0e6, 0.002).is_err());
    let steel = MenegottoPinto::new(400.0e6, 200.0e9, 0.01).unwrap();
    assert!(steel.with_transition(20.0, 1.0, 0.15).is_err());
    assert!(steel.with_isotropic_hardening([0.1, 0.0, 0.1, 1.0]).is_err());
}

/// Many fibres at once have the responses, energies, remainders and variables of one after the other.
#[test]
fn many_fibres_at_once_are_those_one_after_the_other() {
    for (name, law, scale) in laws() {
        let mut random = Random(23);
        let count = law.variable_count();
        for fiber_count in [1, 2, 7, 8, 9, 16] {
            let mut variables = vec![0.0; fiber_count * count];
            variables.chunks_mut(count).for_each(|fiber| law.initialize(fiber));
            let mut start = vec![0.0; fiber_count];
            for step in 0..50 {
                let end: Vec<f64> =
                    (0..fiber_count).map(|_| scale * random.within(-2.0, 1.0)).collect();
                let midstep: Vec<f64> =
                    start.iter().zip(&end).map(|(start, end)| 0.5 * (start + end)).collect();
                let mut responses = vec![UniaxialResponse::default(); fiber_count];
                law.responses(&end, &variables, &mut responses).unwrap();
                let mut energies = vec![InternalEnergy::default(); fiber_count];
                law.energies(&end, &variables, &mut energies).unwrap();
                let mut midstep_responses = vec![UniaxialResponse::default(); fiber_count];
                law.responses(&midstep, &variables, &mut midstep_responses).unwrap();
                let mut stresses: Vec<f64> =
                    midstep_responses.iter().map(|response| response.stress).collect();
                let mut remainders = vec![0.0; fiber_count];
                let mut end_energies = energies.clone();
                let strains = [&start[..], &midstep, &end];
                law.end_step(
                    strains,
                    &[&variables],
                    &mut stresses,
                    &mut remainders,
                    &mut end_energies,
                )
                .unwrap();
                let mut committed = variables.clone();
                law.commit_fibers(&end, &mut committed);
                for (k, variables) in variables.chunks_mut(count).enumerate() {
                    let text = format!("{name}, fibre {k} of {fiber_count}, step {step}");
                    assert_eq!(responses[k], law.response(end[k], variables).unwrap(), "{text}");
                    assert_eq!(energies[k], law.energy(end[k], variables).unwrap(), "{text}");
                    let remainder = law.remainder([start[k], midstep[k], end[k]], variables);
                    assert_eq!(remainders[k], remainder.unwrap(), "{text}");
                    law.commit(end[k], variables);
                    assert_eq!(committed[k * count..][..count], *variables, "{text}");
                }
                start = end;
            }
        }
    }
}

/// Fibres of several sections at once are those of one section after the other, also with the stresses of a step.
#[test]
fn fibres_of_several_sections_are_those_of_one_after_the_other() {
    for (name, law, scale) in laws() {
        let mut random = Random(31);
        for [section_count, fiber_count] in [[1, 1], [2, 7], [5, 6], [5, 13], [4, 16]] {
            let count = section_count * fiber_count;
            let section_variable_count = fiber_count * law.variable_count();
            let mut variables = vec![0.0; count * law.variable_count()];
            variables.chunks_mut(law.variable_count()).for_each(|fiber| law.initialize(fiber));
            let mut start = vec![0.0; count];
            for step in 0..50 {
                let text = format!("{name}, {section_count} sections, step {step}");
                let end: Vec<f64> =
                    start
                        .iter()
                        .map(|start| {
                            if random.chance(0.1) {
                                *start
                            } else {
                                scale * random.within(-2.0, 1.0)
                            }
                        })
                        .collect();
                let midstep: Vec<f64> =
                    start.iter().zip(&end).map(|(start, end)| 0.5 * (start + end)).collect();
                let sections: Vec<_> = variables.chunks(section_variable_count).collect();
                let mut responses = vec![UniaxialResponse::default(); count];
                law.responses_of_sections(&midstep, &sections, &mut responses).unwrap();
                let mut stresses: Vec<f64> =
                    responses.iter().map(|response| response.stress).collect();
                let mut remainders = vec![0.0; count];
                let mut energies = vec![InternalEnergy::default(); count];
                let strains = [&start[..], &midstep, &end];
                law.end_step(strains, &sections, &mut stresses, &mut remainders, &mut energies)
                    .unwrap();
                let mut committed = variables.clone();
                for (k, variables) in variables.chunks_mut(section_variable_count).enumerate() {
                    let fibers = k * fiber_count..(k + 1) * fiber_count;
                    let strains = strains.map(|strains| &strains[fibers.clone()]);
                    let mut expected = vec![UniaxialResponse::default(); fiber_count];
                    law.responses(strains[1], variables, &mut expected).unwrap();
                    assert_eq!(responses[fibers.clone()], expected, "{text}");
                    let fiber_variables = variables.chunks(law.variable_count());
                    for (fiber, variables) in fibers.clone().zip(fiber_variables) {
                        let path = [start[fiber], midstep[fiber], end[fiber]];
                        let expected = law.remainder(path, variables).unwrap();
                        assert_eq!(remainders[fiber], expected, "{text}");
                    }
                    let mut expected = vec![InternalEnergy::default(); fiber_count];
                    law.energies(strains[2], variables, &mut expected).unwrap();
                    assert_eq!(energies[fibers.clone()], expected, "{text}");
                    law.commit_fibers(strains[2], variables);
                    let committed =
                        &mut committed[k * section_variable_count..][..section_variable_count];
                    law.commit_stresses(strains[2], &stresses[fibers], committed);
                    assert_eq!(*committed, *variables, "{text}");
                }
                start = end;
            }
        }
    }
}
