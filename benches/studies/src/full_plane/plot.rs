//! Errors of the impedances over the length of the free surface.

use std::path::Path;

use plotters::prelude::*;

use super::{NAMES, Row};
use crate::AnyError;

const SIZE: (u32, u32) = (1100, 520);

const COLORS: [RGBColor; 4] =
    [RGBColor(31, 119, 180), RGBColor(44, 160, 44), RGBColor(148, 103, 189), RGBColor(214, 39, 40)];

/// One panel per mesh of convolution quadrature: lines from the table, dots of the truncation alone.
pub(crate) fn draw(path: &Path, rows: &[Row]) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = "Full plane, BDF2: errors of the bonded strip over the free-surface elements";
    let body = root.titled(title, ("sans-serif", 22))?;
    let stable: Vec<&Row> = rows.iter().filter(|row| row.mesh.quadrature.is_some()).collect();
    let mut meshes: Vec<usize> = stable.iter().map(|row| row.mesh.elements).collect();
    meshes.dedup();
    for (area, elements) in body.split_evenly((1, meshes.len())).iter().zip(&meshes) {
        let rows: Vec<&Row> =
            stable.iter().filter(|row| row.mesh.elements == *elements).copied().collect();
        let most = rows.iter().map(|row| row.mesh.free).max().unwrap_or(1);
        // Zero has a place on the logarithmic axis: half an element.
        let place = |row: &Row| (row.mesh.free as f64).max(0.5);
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .caption(format!("{elements} elements under the strip"), ("sans-serif", 17))
            .x_label_area_size(46)
            .y_label_area_size(66)
            .build_cartesian_2d((0.4..1.25 * most as f64).log_scale(), (2e-5..2.0).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("free elements on either side (0 at 0.5)")
            .y_desc("relative error, root mean square")
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 16))
            .light_line_style(WHITE)
            .draw()?;
        for (k, (name, color)) in NAMES.iter().zip(COLORS).enumerate() {
            let total: Vec<_> = rows.iter().map(|row| (place(row), row.total[k])).collect();
            let cut: Vec<_> = rows
                .iter()
                .filter_map(|row| row.truncation.map(|errors| (place(row), errors[k])))
                .collect();
            chart
                .draw_series(LineSeries::new(total, color.stroke_width(2)))?
                .label(format!("{name}, from the table"))
                .legend(move |(x, y)| {
                    PathElement::new(vec![(x, y), (x + 18, y)], color.stroke_width(2))
                });
            chart
                .draw_series(cut.into_iter().map(|at| Circle::new(at, 4, color.filled())))?
                .label(format!("{name}, truncation alone"))
                .legend(move |(x, y)| Circle::new((x + 9, y), 4, color.filled()));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 13))
            .draw()?;
    }
    root.present()?;
    Ok(())
}
