//! Closest points of convex sets: no point of the set makes an acute angle with the way outside.

use basemat_testkit::random::Random;

use super::super::convex_set::ConvexSet;
use super::super::ellipse::Ellipse;
use super::super::parabola::DoubleParabola;
use super::super::polygon::Polygon;

/// Points of the boundary by its equation.
type Boundary = Vec<[f64; 2]>;

/// Sets of different shapes, with many points of their boundaries.
fn sets() -> Vec<(&'static str, Box<dyn ConvexSet<2>>, Boundary)> {
    let angles = (0..4000).map(|k| f64::from(k) * std::f64::consts::TAU / 4000.0);
    let ellipse = |a: f64, b: f64| angles.clone().map(|t| [a * t.cos(), b * t.sin()]).collect();
    let parabolas = |a: f64, b: f64| {
        let halves = (-1000..=1000).map(|k| 0.001 * f64::from(k));
        halves
            .flat_map(|nu| [1.0, -1.0].map(|sign| [a * nu, sign * b * (1.0 - nu * nu)]))
            .collect()
    };
    let corners = vec![[2.0, 0.0], [0.5, 1.5], [-4.0, 1.0], [-4.0, -0.5], [0.0, -1.0]];
    vec![
        ("circle", Box::new(Ellipse { semi_axes: [3.0, 3.0] }), ellipse(3.0, 3.0)),
        ("ellipse", Box::new(Ellipse { semi_axes: [3.0, 0.2] }), ellipse(3.0, 0.2)),
        ("thin ellipse", Box::new(Ellipse { semi_axes: [1e-3, 40.0] }), ellipse(1e-3, 40.0)),
        ("parabolas", Box::new(DoubleParabola { semi_axes: [2.0, 1.0] }), parabolas(2.0, 1.0)),
        ("flat", Box::new(DoubleParabola { semi_axes: [30.0, 0.1] }), parabolas(30.0, 0.1)),
        ("high", Box::new(DoubleParabola { semi_axes: [0.1, 30.0] }), parabolas(0.1, 30.0)),
        ("polygon", Box::new(Polygon { corners: corners.clone() }), corners),
    ]
}

#[test]
fn closest_points_fulfil_the_variational_inequality() {
    for (name, set, boundary) in sets() {
        let size = boundary.as_flattened().iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        let mut random = Random(17);
        for number in 0..2000 {
            let reach = random.pick(&[0.3, 1.2, 5.0, 1.0e3]);
            let mut trial = [0, 1].map(|_| size * random.within(-reach, reach));
            // Points on the axes of symmetry, too.
            if random.chance(0.1) {
                trial[random.pick(&[0, 1])] = 0.0;
            }
            let Some(closest) = set.closest_point(&trial) else { continue };
            let out = [0, 1].map(|k| trial[k] - closest.point[k]);
            let distance = out[0].hypot(out[1]);
            for point in &boundary {
                let along = [0, 1].map(|k| point[k] - closest.point[k]);
                let cosine_part = (out[0] * along[0] + out[1] * along[1]) / distance;
                assert!(cosine_part < 1e-9 * size, "{name}, {number}: {cosine_part:e}");
            }
            // The closest point is on the boundary, so that slightly less is inside and slightly more outside.
            let [inside, outside] = [1.0 - 1e-9, 1.0 + 1e-9]
                .map(|factor| set.closest_point(&closest.point.map(|x| factor * x)));
            assert!(inside.is_none() && outside.is_some(), "{name}, {number}: {closest:?}");
        }
    }
}

/// An ellipsoid's closest point has its normal along the way outside, in any dimension.
#[test]
fn the_way_outside_an_ellipsoid_is_its_normal() {
    let semi_axes = [3.0, 0.5, 1.2];
    let set = Ellipse { semi_axes };
    let mut random = Random(23);
    for _ in 0..500 {
        let trial: [f64; 3] = std::array::from_fn(|_| random.within(-9.0, 9.0));
        let Some(closest) = set.closest_point(&trial) else { continue };
        let value: f64 = (0..3).map(|i| (closest.point[i] / semi_axes[i]).powi(2)).sum();
        assert!((value - 1.0).abs() < 1e-14);
        let normal: [f64; 3] = std::array::from_fn(|i| closest.point[i] / semi_axes[i].powi(2));
        let out: [f64; 3] = std::array::from_fn(|i| trial[i] - closest.point[i]);
        let lengths = [normal, out].map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt());
        let cosine: f64 = (0..3).map(|i| normal[i] * out[i]).sum::<f64>() / lengths[0] / lengths[1];
        assert!(cosine > 1.0 - 1e-12 || lengths[1] < 1e-6, "{cosine}");
    }
}
