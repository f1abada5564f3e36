//! Curves over time, as SVG.

use std::path::Path;

use plotters::prelude::*;

#[path = "key.rs"]
pub(crate) mod key;
use key::Sample;

pub(crate) const SIZE: (u32, u32) = (1200, 640);
/// Points per curve: more than pixels help nobody.
const POINTS: usize = 4000;
const COLORS: [RGBColor; 6] = [
    RGBColor(40, 40, 40),
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(255, 140, 0),
    RGBColor(148, 103, 189),
];

/// A named curve of (time, value).
pub(crate) type Curve = (String, Vec<(f64, f64)>);

/// Draws the curves in one picture.
pub(crate) fn draw(
    path: &Path,
    title: &str,
    unit: &str,
    curves: Vec<Curve>,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let thin = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        let every = points.len().div_ceil(POINTS).max(1);
        points.into_iter().step_by(every).collect()
    };
    let curves: Vec<_> = curves.into_iter().map(|(name, points)| (name, thin(points))).collect();
    let points = || curves.iter().flat_map(|curve| &curve.1);
    let end = points().fold(0.0_f64, |m, p| m.max(p.0));
    let low = points().fold(0.0_f64, |m, p| m.min(p.1));
    let high = points().fold(0.0_f64, |m, p| m.max(p.1));
    let margin = 0.05 * (high - low).max(f64::MIN_POSITIVE);

    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let color = |k: usize| COLORS[k % COLORS.len()];
    let names = curves.iter().enumerate();
    let entries: Vec<_> =
        names.map(|(k, (name, _))| (name.clone(), Sample::Line(color(k)))).collect();
    let area = key::draw(&root, 64, &entries)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 24))
        .margin(16)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(0.0..end, low - margin..high + margin)?;
    chart
        .configure_mesh()
        .x_desc("time, s")
        .y_desc(unit)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .label_style(("sans-serif", 16))
        .axis_desc_style(("sans-serif", 18))
        .light_line_style(WHITE)
        .draw()?;
    for (k, (_, line)) in curves.into_iter().enumerate() {
        chart.draw_series(LineSeries::new(line, color(k).stroke_width(1)))?;
    }
    root.present()?;
    Ok(())
}
