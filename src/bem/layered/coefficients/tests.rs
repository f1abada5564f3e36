//! Panels against the points that they replace.

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

fn block(quadrature: &Quadrature, number: usize, threads: usize) -> LagBlock {
    quadrature
        .block(number, threads, Samples::new(&mut ProgressReporter::unobserved(), 0..0))
        .unwrap()
}

/// Panels give the same values as points, at every seventh point of circles.
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
            let mut work = StripWorkspace::default();
            let mut values = vec![[Complex::default(); STRIP_KINDS]; quadrature.classes];
            let mut scratch = values.clone();
            let mut worst = 0.0_f64;
            let mut covered = 0;
            for number in [0, 2, 4] {
                let circle = LagBlock::circle(number, 1e-10);
                let mut watch = ProgressReporter::unobserved();
                let mut samples = Samples::new(&mut watch, 0..0);
                let spectra = quadrature.spectra(circle, 1, &mut samples).unwrap();
                covered += (stages.count() * circle.points()).saturating_sub(samples.done);
                let count = circle.points();
                for point in (0..count).step_by(31) {
                    let place = [circle.logarithm, circle.angle(point)];
                    quadrature.mobility(place, &mut work, &mut scratch, &mut values).unwrap();
                    for (class, value) in values.iter().enumerate() {
                        let sizes = self_pairs[class]
                            .map(|class| values[class][0].abs().min(values[class][1].abs()));
                        let unit = (sizes[0] * sizes[1]).sqrt();
                        for (component, value) in value.iter().enumerate() {
                            let found = spectra[(class * STRIP_KINDS + component) * count + point];
                            worst = worst.max((found - *value).abs() / unit);
                        }
                    }
                }
            }
            println!("{name}, {stages:?}: {worst:e}, {covered} points by panels");
            assert!(worst < 1e-10, "{name} {stages:?} {worst:e}");
            assert!(covered > 500, "{name} {stages:?} {covered}");
        }
    }
}

/// In short runs of undamped layers, panels need at least a quarter fewer samples: few samples are in vain.
#[test]
fn panels_take_fewer_samples_than_points() {
    for (name, profile) in [("on rock", p1(Elastic, Elastic)), ("on rigid bedrock", p3(Elastic))] {
        for stages in [Stages::Two, Stages::Three] {
            let quadrature = quadrature(profile.clone(), stages);
            let mut taken = 0;
            let mut points = 0;
            for number in 0..2 {
                let circle = LagBlock::circle(number, 1e-10);
                let mut watch = ProgressReporter::unobserved();
                let mut samples = Samples::new(&mut watch, 0..0);
                quadrature.spectra(circle, 1, &mut samples).unwrap();
                taken += samples.done;
                points += stages.count() * circle.points();
            }
            println!("{name}, {stages:?}: {taken} samples for {points} points");
            assert!(4 * taken < 3 * points, "{name} {stages:?}: {taken} for {points}");
        }
    }
}

/// Lags from panels against lags from every point of their circles, relative to the largest of a component.
#[test]
fn lags_are_those_of_all_points() {
    for (name, profile) in [
        ("damped", p1(gmb(5), gmb(1))),
        ("elastic", p1(Elastic, Elastic)),
        ("rigid bedrock, elastic", p3(Elastic)),
    ] {
        let panels = quadrature(profile.clone(), Stages::Two);
        let points = quadrature(profile, Stages::Two);
        let mut largest = [0.0_f64; STRIP_KINDS];
        let mut worst = 0.0_f64;
        for number in 0..4 {
            // All panels are marked as unresolved.
            for (node, panels) in points.panels.iter().enumerate() {
                let circle = LagBlock::circle(number, 1e-10);
                let cover = circle.cover(node, |places| {
                    panels.stored().extend(places.iter().map(|place| (*place, None)));
                    Ok(vec![false; places.len()])
                });
                cover.unwrap();
            }
            let one = block(&panels, number, 1);
            let two = block(&points, number, 1);
            for (place, (one, two)) in one.values.iter().zip(&two.values).enumerate() {
                let largest = &mut largest[place % STRIP_KINDS];
                *largest = two.iter().fold(*largest, |size, x| size.max(x.abs()));
                let error = one.iter().zip(two).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                worst = worst.max(error / *largest);
            }
        }
        println!("{name}: {worst:e}");
        assert!(0.0 < worst && worst < 1e-9, "{name} {worst:e}");
    }
}

/// The bits of a block do not depend on earlier samples or on the number of threads.
#[test]
fn bits_of_a_block_depend_on_nothing_else() {
    let alone = block(&quadrature(p1(gmb(5), gmb(1)), Stages::Three), 3, 1);
    let after = quadrature(p1(gmb(5), gmb(1)), Stages::Three);
    for number in [4, 0, 2] {
        block(&after, number, 2);
    }
    let found = block(&after, 3, 3);
    for (one, two) in alone.values.iter().zip(&found.values) {
        assert!(one.iter().zip(two).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

/// The contribution of each eigenvalue is continuous on the half circle.
#[test]
fn eigenvalues_keep_their_numbers() {
    for stages in [Stages::Two, Stages::Three] {
        for logarithm in [-0.06, -1e-3, -1e-6] {
            let mut previous: Vec<Complex> = vec![];
            for point in 0..4000 {
                let angle = std::f64::consts::PI * (f64::from(point) + 0.5) / 4000.0;
                let CirclePoint { z, one_less_z } = on_circle(logarithm, angle);
                let roots: Vec<_> = stages.nodes(z, one_less_z).map(|node| node.lambda).collect();
                for (one, two) in previous.iter().zip(&roots) {
                    assert!((*one - *two).abs() < 0.02, "{stages:?} {point} {one:?} {two:?}");
                }
                previous = roots;
            }
        }
    }
}
