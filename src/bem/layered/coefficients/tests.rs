//! Tests of weights from panels against weights from all points of the circles.

use super::*;
use crate::bem::layered::test_profiles::{gmb, p1, p3};
use crate::bem::layered::wavenumber::StripWorkspace;
use crate::bem::{Grading, Strip};
use crate::history::STRIP_KINDS;
use crate::soil::{Elastic, SoilProfile};

fn quadrature(profile: SoilProfile, stages: Stages) -> Quadrature {
    let strip = Strip::new(-1.0..1.0, 4, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    Quadrature::new(profile, &classes, stages, 0.1, 1e-10)
}

fn block(quadrature: &Quadrature, block_index: usize, thread_count: usize) -> LagBlock {
    quadrature
        .block(
            block_index,
            thread_count,
            SampleProgress::new(&mut ProgressReporter::unobserved(), 0..0),
        )
        .unwrap()
}

/// Panels and points yield equal values, at every 31st point of circles.
///
/// Errors are relative to the mobilities of each pair's elements.
#[test]
fn panels_and_points_give_equal_values() {
    for (name, profile) in [
        ("damped", p1(gmb(5), gmb(1))),
        ("elastic", p1(Elastic, Elastic)),
        ("rigid bedrock", p3(gmb(5))),
        ("rigid bedrock, elastic", p3(Elastic)),
    ] {
        for stages in [Stages::Two, Stages::Three] {
            let quadrature = quadrature(profile.clone(), stages);
            let self_pairs = quadrature.panels[0].self_pairs.clone();
            let mut workspace = StripWorkspace::default();
            let mut values = vec![[Complex::default(); STRIP_KINDS]; quadrature.class_count];
            let mut compliances = values.clone();
            let mut max_error = 0.0_f64;
            let mut panel_point_count = 0;
            for block_index in [0, 2, 4] {
                let circle = LagBlock::circle(block_index, 1e-10);
                let mut reporter = ProgressReporter::unobserved();
                let mut progress = SampleProgress::new(&mut reporter, 0..0);
                let spectra = quadrature.spectra(circle, 1, &mut progress).unwrap();
                panel_point_count += (stages.count() * circle.half_circle_points())
                    .saturating_sub(progress.computed_count);
                let point_count = circle.half_circle_points();
                for point in (0..point_count).step_by(31) {
                    let log_z = [circle.log_radius, circle.angle(point)];
                    quadrature
                        .mobility(log_z, &mut workspace, &mut compliances, &mut values)
                        .unwrap();
                    for (class, class_values) in values.iter().enumerate() {
                        let mobilities = self_pairs[class]
                            .map(|class| values[class][0].abs().min(values[class][1].abs()));
                        let pair_mobility = (mobilities[0] * mobilities[1]).sqrt();
                        for (component, expected) in class_values.iter().enumerate() {
                            let computed =
                                spectra[(class * STRIP_KINDS + component) * point_count + point];
                            max_error = max_error.max((computed - *expected).abs() / pair_mobility);
                        }
                    }
                }
            }
            println!("{name}, {stages:?}: {max_error:e}, {panel_point_count} points by panels");
            assert!(max_error < 1e-10, "{name} {stages:?} {max_error:e}");
            assert!(panel_point_count > 500, "{name} {stages:?} {panel_point_count}");
        }
    }
}

/// In short runs of undamped layers, panels need at least a quarter fewer samples than points.
#[test]
fn panels_need_fewer_samples_than_points() {
    for (name, profile) in [("on rock", p1(Elastic, Elastic)), ("on rigid bedrock", p3(Elastic))] {
        for stages in [Stages::Two, Stages::Three] {
            let quadrature = quadrature(profile.clone(), stages);
            let mut sample_count = 0;
            let mut point_count = 0;
            for block_index in 0..2 {
                let circle = LagBlock::circle(block_index, 1e-10);
                let mut reporter = ProgressReporter::unobserved();
                let mut progress = SampleProgress::new(&mut reporter, 0..0);
                quadrature.spectra(circle, 1, &mut progress).unwrap();
                sample_count += progress.computed_count;
                point_count += stages.count() * circle.half_circle_points();
            }
            println!("{name}, {stages:?}: {sample_count} samples for {point_count} points");
            assert!(
                4 * sample_count < 3 * point_count,
                "{name} {stages:?}: {sample_count} for {point_count}"
            );
        }
    }
}

/// Weights from panels agree with weights from all points of the circles, relative to the largest of a component.
#[test]
fn panels_and_points_give_equal_weights() {
    for (name, profile) in [
        ("damped", p1(gmb(5), gmb(1))),
        ("elastic", p1(Elastic, Elastic)),
        ("rigid bedrock, elastic", p3(Elastic)),
    ] {
        let panel_quadrature = quadrature(profile.clone(), Stages::Two);
        let point_quadrature = quadrature(profile, Stages::Two);
        let mut max_weights = [0.0_f64; STRIP_KINDS];
        let mut max_error = 0.0_f64;
        for block_index in 0..4 {
            // All panels are marked as unresolved.
            for (node, panels) in point_quadrature.panels.iter().enumerate() {
                let circle = LagBlock::circle(block_index, 1e-10);
                let cover = circle.cover(node, |candidates| {
                    panels.stored().extend(candidates.iter().map(|panel| (*panel, None)));
                    Ok(vec![false; candidates.len()])
                });
                cover.unwrap();
            }
            let panel_block = block(&panel_quadrature, block_index, 1);
            let point_block = block(&point_quadrature, block_index, 1);
            for (index, (panel_lags, point_lags)) in
                panel_block.values.iter().zip(&point_block.values).enumerate()
            {
                let max_weight = &mut max_weights[index % STRIP_KINDS];
                *max_weight = point_lags.iter().fold(*max_weight, |max, x| max.max(x.abs()));
                let error = panel_lags
                    .iter()
                    .zip(point_lags)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f64::max);
                max_error = max_error.max(error / *max_weight);
            }
        }
        println!("{name}: {max_error:e}");
        assert!(0.0 < max_error && max_error < 1e-9, "{name} {max_error:e}");
    }
}

/// The bits of a block do not depend on earlier samples or on the number of threads.
#[test]
fn bits_of_a_block_do_not_depend_on_other_blocks() {
    let expected = block(&quadrature(p1(gmb(5), gmb(1)), Stages::Three), 3, 1);
    let used_quadrature = quadrature(p1(gmb(5), gmb(1)), Stages::Three);
    for block_index in [4, 0, 2] {
        block(&used_quadrature, block_index, 2);
    }
    let computed = block(&used_quadrature, 3, 3);
    for (expected_lags, computed_lags) in expected.values.iter().zip(&computed.values) {
        assert!(expected_lags.iter().zip(computed_lags).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

/// The contribution of each eigenvalue is continuous on the half circle.
#[test]
fn eigenvalues_are_continuous() {
    for stages in [Stages::Two, Stages::Three] {
        for log_radius in [-0.06, -1e-3, -1e-6] {
            let mut previous_roots: Vec<Complex> = vec![];
            for point in 0..4000 {
                let angle = std::f64::consts::PI * (f64::from(point) + 0.5) / 4000.0;
                let CirclePoint { z, one_less_z } = on_circle(log_radius, angle);
                let roots: Vec<_> = stages.nodes(z, one_less_z).map(|node| node.lambda).collect();
                for (root_before, root) in previous_roots.iter().zip(&roots) {
                    assert!(
                        (*root_before - *root).abs() < 0.02,
                        "{stages:?} {point} {root_before:?} {root:?}"
                    );
                }
                previous_roots = roots;
            }
        }
    }
}
