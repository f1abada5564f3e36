//! Lamb's problem: a line load, and a uniform load on an element, on the surface of a half-plane.

use std::f64::consts::PI;

use basemat::Soil;
use basemat::bem::{ContactElement, InfluenceKernel};
use basemat::fundamental::{FundamentalSolution, HalfPlane, LoadHistory};
use plotters::prelude::SeriesLabelPosition;

use super::outcome::{ValidationCase, ValidationCheck, ValidationOutcome, worse};
use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, Figure, FigurePanel};
use basemat_problems::table;

pub(crate) const VALIDATION_CASE: ValidationCase = ValidationCase {
    name: "lamb",
    title: "Lamb's problem",
    reference: "tables from an independent Cagniard–de Hoop inversion; late-time limit",
    settings: "ν = 0, 1/4, 1/3; closed forms, and convolution weights of 8 steps",
    run,
};

const POISSON_TABLES: [(&str, f64); 3] = [("0", 0.0), ("025", 0.25), ("0333", 1.0 / 3.0)];

/// Largest error of the line load's four components, of the element's by differences of closed
/// forms, and of the element's by summed convolution weights.
fn errors(name: &str, poisson: f64) -> Result<[f64; 3], AnyError> {
    let soil = Soil::new(1.0, poisson, 1.0)?;
    let plane = HalfPlane::new(soil);
    let mut max_errors = [0.0_f64; 3];
    // Columns: ij is displacement i due to load j; y down.
    let line = table(&format!("lamb_heaviside_nu{name}.csv"));
    for [time, xx, xy, yx, yy] in line.rows(["t", "u_xx", "u_xy", "u_yx", "u_yy"]) {
        let u = plane.displacement([1.0, 0.0], time, LoadHistory::Step)?;
        for (computed, expected) in [(u[0][0], xx), (u[0][1], xy), (u[1][0], yx), (u[1][1], yy)] {
            max_errors[0] = worse(max_errors[0], (computed - expected).abs());
        }
    }
    let mean = table(&format!("lamb_galerkin_nu{name}.csv"));
    for [distance, time, xx, xy, yx, yy] in mean.rows(["d", "t", "xx", "xy", "yx", "yy"]) {
        let closed_form = plane.element_mean(unit_element(distance), unit_element(0.0), time)?;
        let summed_load = constant_load(&soil, distance, time, 8)?;
        for (k, [a, b, c]) in
            [(1, [closed_form.xx, closed_form.zx, closed_form.zz]), (2, summed_load)]
        {
            for (computed, expected) in [(a, xx), (-b, xy), (b, yx), (c, yy)] {
                max_errors[k] = worse(max_errors[k], (computed - expected).abs());
            }
        }
    }
    Ok(max_errors)
}

fn unit_element(middle: f64) -> ContactElement {
    ContactElement::new(middle - 0.5, middle + 0.5)
}

/// Mean displacement `[xx, zx, zz]` of an element after a constant traction of `steps` steps.
fn constant_load(
    soil: &Soil,
    distance: f64,
    time: f64,
    steps: usize,
) -> Result<[f64; 3], AnyError> {
    let kernel = InfluenceKernel::new(*soil, time / steps as f64)?;
    (1..=steps).try_fold([0.0; 3], |[xx, zx, zz], lag| {
        let g = kernel.coefficients(unit_element(distance), unit_element(0.0), lag)?;
        Ok([xx + g.xx, zx + g.zx, zz + g.zz])
    })
}

/// Relative distance of late convolution weights from their limit: u grows by (1−ν)/(π μ) ln t.
fn late(poisson: f64) -> Result<f64, AnyError> {
    let kernel = InfluenceKernel::new(Soil::new(1.0, poisson, 1.0)?, 0.5)?;
    let lag = 100_000;
    let limit = (1.0 - poisson) / PI * (lag as f64 / (lag as f64 - 1.0)).ln();
    let g = kernel.coefficients(unit_element(3.0), unit_element(0.0), lag)?;
    Ok(worse((g.zz / limit - 1.0).abs(), (g.xx / limit - 1.0).abs()))
}

fn run(_short: bool) -> Result<ValidationOutcome, AnyError> {
    let mut max_errors = [0.0_f64; 4];
    for (name, poisson) in POISSON_TABLES {
        let errors = errors(name, poisson)?;
        for (max_errors, error) in
            max_errors.iter_mut().zip(errors.into_iter().chain([late(poisson)?]))
        {
            *max_errors = worse(*max_errors, error);
        }
    }
    let names = [
        "line load H(t), all components, error of μu/F",
        "element mean of element, closed form, error of μu/(pl)",
        "the same, sum of the convolution weights that are marched with",
        "convolution weights at lag 100 000 against (1−ν)/(πμ) ln t, relative",
    ];
    let checks = ValidationCheck::list(&names, &max_errors, &[1e-12, 1e-11, 1e-11, 1e-8]);
    Ok(ValidationOutcome { checks, figure: figure()? })
}

fn figure() -> Result<Figure, AnyError> {
    let soil = Soil::new(1.0, 0.25, 1.0)?;
    let plane = HalfPlane::new(soil);
    let components =
        [("u_xx", [0, 0], CURVE_BLUE), ("u_zz", [1, 1], CURVE_RED), ("u_zx", [1, 0], CURVE_GREEN)];
    let line = table("lamb_heaviside_nu025.csv");
    let mut left = FigurePanel::new("c_S t / x", "μ u / F").legend(SeriesLabelPosition::LowerRight);
    for (name, [i, j], color) in components {
        let column = ["u_xx", "u_xy", "u_yx", "u_yy"][2 * i + j];
        let points: Vec<_> =
            line.rows(["t", column]).into_iter().filter(|row| row[0] <= 3.0).collect();
        left = left.reference(
            &format!("{name}, table"),
            color,
            points.iter().map(|row| (row[0], row[1])).collect(),
        );
        let mut computed = Vec::new();
        for k in 1..=600 {
            let time = 0.005 * f64::from(k);
            let u = plane.displacement([1.0, 0.0], time, LoadHistory::Step)?;
            computed.push((time, u[i][j]));
        }
        left = left.line(&format!("{name}, basemat"), color, computed);
    }
    let mean = table("lamb_galerkin_nu025.csv");
    let rows = mean.rows(["d", "t", "yy"]);
    let mut right = FigurePanel::new("c_S t / l", "μ ū_zz / (p l)")
        .legend(SeriesLabelPosition::UpperLeft)
        .room(0.05, 0.35);
    let end = rows.iter().fold(0.0_f64, |end, row| end.max(row[1])).min(3.5);
    for (distance, name, color) in [
        (0.0, "the loaded element", CURVE_BLUE),
        (1.0, "its neighbour", CURVE_RED),
        (2.0, "the next one", CURVE_GREEN),
    ] {
        let points: Vec<_> =
            rows.iter().filter(|row| row[0] == distance && row[1] <= end).collect();
        if points.is_empty() {
            continue;
        }
        let points = points.into_iter().map(|row| (row[1], row[2])).collect();
        right = right.circles(&format!("{name}, table"), color, points);
        let kernel = InfluenceKernel::new(soil, 0.02)?;
        let mut sum = 0.0;
        let mut computed = vec![(0.0, 0.0)];
        for lag in 1.. {
            let time = 0.02 * lag as f64;
            if time > end {
                break;
            }
            sum += kernel.coefficients(unit_element(distance), unit_element(0.0), lag)?.zz;
            computed.push((time, sum));
        }
        right = right.line("basemat, summed coefficients", color, computed);
    }
    Ok(Figure::new(
        "Lamb's problem, ν = 1/4: line load (left), uniform load on an element of length l (right)",
        2,
        vec![left, right],
    ))
}
