//! Work that is estimated against work that is done, point by point.

use super::*;
use crate::bem::layered::coefficients::Samples;
use crate::bem::layered::runge_kutta::Stages;
use crate::bem::layered::test_profiles::{gmb, p1, p3};
use crate::bem::{Grading, Strip};
use crate::error::Watch;
use crate::history::PairClasses;
use crate::soil::{Base, Elastic, Soil, SoilProfile};

/// Evaluations, layers that they go through and tables made, of every sample of the blocks up to `last` and of the
/// gate.
fn done(quadrature: &Quadrature, last: usize) -> [f64; 3] {
    let mut work = Workspace::default();
    let mut values = vec![[Complex::default(); 3]; quadrature.classes];
    let mut scratch = values.clone();
    let mut watch = Watch::nobody();
    for number in 0..=last {
        let samples = Samples::new(&mut watch, 0..0);
        quadrature.block(number, 1, samples).unwrap();
    }
    for (node, panels) in quadrature.panels.iter().enumerate() {
        let mut met = std::collections::HashSet::new();
        let mut samples: Vec<_> = passivity::places().collect();
        for number in 0..=last {
            let circle = Block::circle(number, quadrature.tolerance);
            let (_, alone) = circle
                .covered(node, |places| {
                    met.extend(places.iter().copied());
                    Ok(places.iter().map(|place| panels.known(*place).unwrap()).collect())
                })
                .unwrap();
            samples.extend(alone.iter().map(|p| [circle.logarithm, circle.angle(*p)]));
        }
        samples.extend(met.iter().flat_map(|place| place.places()));
        for sample in samples {
            let node = quadrature.nodes(sample).nth(node).unwrap();
            quadrature.add(node, &mut work, &mut scratch, &mut values).unwrap();
        }
    }
    let tables: usize = quadrature.integrals.forms.made().iter().sum();
    [work.panels.evaluations as f64, work.compliance.visited as f64, tables as f64]
}

/// Estimates are right to a factor of two, on fifteen grounds with two and three stages; in a fraction of the time.
#[test]
fn work_is_known_beforehand() {
    let soft = Soil::new(1.0, 0.333, 1.0).unwrap();
    let stiff = Soil::new(100.0, 0.2, 1.3).unwrap();
    let skin = |thickness: f64| {
        let base = SoilProfile::on_half_plane(stiff).with_base_damping(gmb(1));
        let skin = base.with_layer(stiff, thickness).unwrap().with_damping(gmb(1));
        skin.with_layer(soft, 2.0).unwrap().with_damping(gmb(5))
    };
    let mut many = SoilProfile::on_rigid_base();
    for index in 1..7 {
        let soil = Soil::new(f64::from(index), 0.4, 1.0).unwrap();
        many = many.with_layer(soil, 0.5).unwrap().with_damping(gmb(5));
    }
    let bare = SoilProfile::on_half_plane(stiff).with_layer(stiff, 3e-3).unwrap();
    let elastic_skin = bare.with_layer(soft, 2.0).unwrap();
    let damped = || p1(gmb(5), gmb(1));
    let slab = SoilProfile::on_half_plane(soft).with_layer(stiff, 0.2).unwrap();
    let half_plane = SoilProfile::on_half_plane(soft).with_damping(gmb(5));
    let cases = [
        ("damped", damped(), 8, 0.1, 1),
        ("elastic", p1(Elastic, Elastic), 8, 0.1, 1),
        ("rigid base", p3(gmb(5)), 8, 0.1, 1),
        ("rigid base, elastic", p3(Elastic), 8, 0.1, 1),
        ("half-plane", half_plane, 8, 0.1, 1),
        ("slab", slab, 8, 0.1, 1),
        ("six layers", many, 8, 0.1, 1),
        ("skin", skin(1e-2), 8, 0.1, 0),
        ("thin skin", skin(3e-3), 8, 0.1, 0),
        ("short steps", damped(), 8, 2.5e-3, 0),
        ("32 elements", damped(), 32, 0.1, 0),
        ("long run", damped(), 2, 0.1, 4),
        ("very short steps", damped(), 6, 1e-4, 2),
        ("thin skin, long run", skin(1e-3), 2, 0.1, 3),
        ("thin skin, elastic", elastic_skin, 2, 0.1, 2),
    ];
    for (name, profile, elements, time_step, last) in cases {
        for stages in [Stages::Two, Stages::Three] {
            let strip = Strip::new(-1.0..1.0, elements, Grading::Cosine).unwrap();
            let classes = PairClasses::new(strip.elements()).unwrap();
            let quadrature = Quadrature::new(profile.clone(), &classes, stages, time_step, 1e-10);
            let mut work = Workspace::default();
            let outlook = quadrature.outlook(0..last + 1, &mut work).unwrap();
            let total = quadrature.total(&outlook, true, &mut work).unwrap();
            let rigid = matches!(profile.base(), Base::Rigid);
            let lowest = if rigid { 0.5 } else { 1.0 };
            let evaluations = total.sum.evaluations;
            let tables = quadrature.tables(&total.met).map(|[kept, _]| kept).iter().sum();
            let found = [evaluations, lowest * evaluations + total.sum.layers, tables];
            let wanted = done(&quadrature, last);
            let looked_at = work.panels.evaluations as f64 / wanted[0];
            let ratios = [0, 1, 2].map(|k| found[k] / wanted[k]);
            println!(
                "{name}, {stages:?}: {ratios:.3?} of {:.1e}, looked at {looked_at:.3}",
                wanted[0]
            );
            assert!(ratios.iter().all(|ratio| (0.5..2.0).contains(ratio)), "{name} {ratios:?}");
            assert!(looked_at < 0.3, "{name} {looked_at}");
        }
    }
}
