//! Work that is estimated against work that is done, point by point.

use super::*;
use crate::bem::layered::coefficients::Circle;
use crate::bem::layered::runge_kutta::Stages;
use crate::bem::layered::test_profiles::{gmb, p1, p3};
use crate::bem::layered::wavenumber::Wavenumbers;
use crate::bem::{Grading, Strip};
use crate::history::PairClasses;
use crate::soil::{Elastic, Soil, SoilProfile};

/// Evaluations, and layers that they go through, of every point of the blocks up to `last` and of the gate.
fn done(quadrature: &Quadrature, last: usize) -> [f64; 2] {
    let mut work = Workspace::default();
    let mut values = vec![[Complex::default(); 3]; quadrature.classes];
    let mut scratch = values.clone();
    let mut at = |place: [f64; 2]| {
        quadrature.mobility(place, &mut work, &mut scratch, &mut values).unwrap();
    };
    for number in 0..=last {
        let circle = Circle::new(number, quadrature.tolerance);
        for point in 0..circle.points() {
            at([circle.logarithm, circle.angle(point)]);
        }
    }
    for point in 0..passivity::POINTS {
        let angle = std::f64::consts::PI * (point as f64 + 0.5) / passivity::POINTS as f64;
        at([passivity::RADIUS.ln(), angle]);
    }
    [work.evaluations as f64, work.compliance.visited as f64]
}

/// To a factor of two, on twelve grounds with two and three stages; in a fraction of the time.
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
    ];
    for (name, profile, elements, time_step, last) in cases {
        for stages in [Stages::Two, Stages::Three] {
            let strip = Strip::new(-1.0..1.0, elements, Grading::Cosine).unwrap();
            let classes = PairClasses::new(strip.elements()).unwrap();
            let tolerance = 1e-10;
            let integrals = Wavenumbers::new(&classes, tolerance);
            let (profile, classes) = (profile.clone(), classes.count());
            let quadrature =
                Quadrature { profile, integrals, classes, stages, time_step, tolerance };
            let mut work = Workspace::default();
            let count = |s| quadrature.integrals.counts(&quadrature.profile, s, &mut work);
            let total = quadrature.on_circles(0..last + 1, true, count).unwrap();
            let evaluations = POINTS as f64 * total.sum.panels + total.sum.halves;
            let found = [evaluations, evaluations + total.sum.layers];
            let wanted = done(&quadrature, last);
            let looked_at = work.evaluations as f64 / wanted[0];
            let ratios = [0, 1].map(|k| found[k] / wanted[k]);
            println!(
                "{name}, {stages:?}: {ratios:.3?} of {:.1e}, looked at {looked_at:.3}",
                wanted[0]
            );
            assert!(ratios.iter().all(|ratio| (0.5..2.0).contains(ratio)), "{name} {ratios:?}");
            assert!(looked_at < 0.3, "{name} {looked_at}");
        }
    }
}
