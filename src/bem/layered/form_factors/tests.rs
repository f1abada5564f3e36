//! Form factors on wide panels, and the functions from which they are computed.

use super::*;
use crate::bem::{Grading, Strip};

/// Integrals by a wide panel equal the sum of its narrow panels, for elements with themselves and far apart.
#[test]
fn wide_panels_are_sums_of_narrow_ones() {
    let strip = Strip::new(-1.0..1.0, 7, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let forms = FormFactors::new(&classes);
    for (level, index) in [(1, 2), (1, 9), (3, 5), (6, 2), (6, 3)] {
        let panel = Panel { level, index };
        let mut wide = vec![Sums::default(); forms.blocks()];
        add_panel(&forms, panel, &mut wide);
        let mut narrow = vec![Sums::default(); forms.blocks()];
        for index in index << level..(index + 1) << level {
            add_panel(&forms, Panel { level: 0, index }, &mut narrow);
        }
        let narrow_sums = narrow.iter().flatten().flatten();
        let largest = narrow_sums.clone().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (one, two) in wide.iter().flatten().flatten().zip(narrow_sums) {
            assert!((one - two).abs() < 1e-11 * largest, "{level} {index} {one} {two}");
        }
    }
}

/// Adds the integral of a smooth compliance over a panel.
fn add_panel(forms: &FormFactors, panel: Panel, sums: &mut [Sums]) {
    let extent = forms.extent(panel);
    let left = extent[0];
    let width = extent[1];
    let coefficients: [[f64; 6]; PANEL_POINTS] = std::array::from_fn(|i| {
        let k = left + 0.5 * width * (1.0 + forms.rule.nodes[i]);
        let c = 0.5 * width * forms.rule.weights[i] / (k + 20.0 * forms.width);
        [c, -2.0 * c, c, c, 3.0 * c, c]
    });
    forms.with_values(panel, |rows| accumulate(rows, &coefficients, sums));
}

/// Closed forms of the first three, and the recurrence, where the method changes.
#[test]
fn bessel_functions_are_spherical() {
    for t in [1e-12, 1e-3, 0.5, 0.999_999, 1.0, 3.1, 9.0, 15.9, 16.1, 300.0_f64] {
        let found = spherical_bessel(t);
        let sin = t.sin();
        let cos = t.cos();
        if t > 0.4 {
            let two = (3.0 / t.powi(3) - 1.0 / t) * sin - 3.0 * cos / (t * t);
            for (found, wanted) in found.iter().zip([sin / t, (sin / t - cos) / t, two]) {
                assert!((found - wanted).abs() < 1e-14, "{t} {found} {wanted}");
            }
        }
        for n in 1..PANEL_POINTS - 1 {
            let sum = found[n - 1] + found[n + 1];
            let wanted = (2 * n + 1) as f64 / t * found[n];
            assert!((sum - wanted).abs() < 1e-13 * sum.abs().max(1e-3), "{t} {n}");
        }
    }
    assert_eq!(spherical_bessel(0.0)[..2], [1.0, 0.0]);
}
