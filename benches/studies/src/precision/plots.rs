//! Error against time, in logarithms.

use std::ops::Range;
use std::path::Path;

use basemat::bem::Grading;
use plotters::prelude::*;

use super::settings::{HISTORY_METHODS, HistorySetting, OTHER_SCHEMES, SchemeSetting};
use super::sweep::{SweepOutcome, SweepPoint};
use crate::AnyError;
use crate::key::{self, LegendSample, SheetArea};

/// Width and height, pixels.
const PICTURE_SIZE: (u32, u32) = (1480, 620);
const FRONT_COLOR: RGBColor = RGBColor(214, 39, 40);

type LogChart<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<
        plotters::coord::combinators::LogCoord<f64>,
        plotters::coord::combinators::LogCoord<f64>,
    >,
>;

/// A family of points with its name, colour and shape.
struct PointFamily {
    name: String,
    color: RGBColor,
    shape: MarkerShape,
    grading: Grading,
    history: HistorySetting,
    scheme: SchemeSetting,
}

#[derive(Clone, Copy)]
enum MarkerShape {
    Circle,
    Triangle,
    Cross,
    Ring,
}

fn families() -> Vec<PointFamily> {
    let colors = [
        RGBColor(31, 119, 180),
        RGBColor(148, 103, 189),
        RGBColor(44, 160, 44),
        RGBColor(23, 190, 207),
        RGBColor(188, 189, 34),
        RGBColor(255, 140, 0),
        RGBColor(140, 86, 75),
        RGBColor(227, 119, 194),
    ];
    let kinds = HISTORY_METHODS
        .iter()
        .map(|&history| (history.name.to_owned(), history, SchemeSetting::Midpoint))
        .chain(OTHER_SCHEMES.iter().map(|&scheme| (scheme.name(), HISTORY_METHODS[0], scheme)));
    let mut list = Vec::new();
    for ((name, history, scheme), color) in kinds.zip(colors.iter().cycle()) {
        let shapes = match scheme {
            SchemeSetting::Midpoint => [MarkerShape::Circle, MarkerShape::Triangle],
            _ => [MarkerShape::Cross, MarkerShape::Ring],
        };
        let gradings = [(Grading::Uniform, "uniform"), (Grading::Cosine, "cosine")];
        for ((grading, grading_name), shape) in gradings.into_iter().zip(shapes) {
            let name = format!("{grading_name}, {name}");
            list.push(PointFamily { name, color: *color, shape, grading, history, scheme });
        }
    }
    list
}

/// Draws the error of the time series on the left, of the peak on the right.
pub(crate) fn draw(path: &Path, sweep: &SweepOutcome) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, PICTURE_SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Base shear, {}: error against processor time", sweep.scene);
    let body = root.titled(&title, ("sans-serif", 24))?;
    let mut entries =
        vec![("front: none faster and closer".to_owned(), LegendSample::Line(FRONT_COLOR))];
    let families = families().into_iter();
    let used_families =
        families.filter(|family| sweep.points.iter().any(|point| family.contains(point)));
    entries.extend(used_families.map(|family| (family.name.clone(), family.sample())));
    let body = key::draw(&body, 30, &entries)?;
    let halves = body.split_evenly((1, 2));
    draw_panel(&halves[0], "error of the history (relative L2)", sweep, true, |point| {
        point.errors.series
    })?;
    draw_panel(&halves[1], "error of the peak (relative)", sweep, false, |point| {
        point.errors.peak
    })?;
    root.present()?;
    Ok(())
}

fn draw_panel(
    area: &SheetArea,
    label: &str,
    sweep: &SweepOutcome,
    front: bool,
    value: impl Fn(&SweepPoint) -> f64,
) -> Result<(), AnyError> {
    // Peaks can agree by chance to any digit.
    let position = |point: &SweepPoint| (point.seconds, value(point).max(1e-5));
    let errors = axis_range(sweep.points.iter().map(|point| position(point).1));
    let times = axis_range(sweep.points.iter().map(|point| point.seconds));
    let mut chart: LogChart = ChartBuilder::on(area)
        .margin(14)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(times.log_scale(), errors.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("processor time, s")
        .y_desc(label)
        .x_labels(5)
        .x_label_formatter(&|x| power(*x))
        .y_label_formatter(&|y| power(*y))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .light_line_style(WHITE)
        .draw()?;
    if front {
        let front = sweep.points.iter().filter(|point| point.front);
        let mut line: Vec<_> = front.map(position).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        chart.draw_series(LineSeries::new(line, FRONT_COLOR.stroke_width(2)))?;
    }
    for family in families() {
        let points: Vec<_> =
            sweep.points.iter().filter(|point| family.contains(point)).map(position).collect();
        if !points.is_empty() {
            family.draw(&mut chart, points)?;
        }
    }
    Ok(())
}

/// Range of a logarithmic axis, with margins.
fn axis_range(values: impl Iterator<Item = f64> + Clone) -> Range<f64> {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    0.6 * low..1.8 * values.fold(0.0, f64::max)
}

impl PointFamily {
    fn contains(&self, point: &SweepPoint) -> bool {
        let settings = &point.settings;
        settings.grading == self.grading
            && settings.history == self.history
            && settings.scheme == self.scheme
    }

    fn sample(&self) -> LegendSample {
        match self.shape {
            MarkerShape::Circle => LegendSample::Circle(self.color),
            MarkerShape::Triangle => LegendSample::Triangle(self.color),
            MarkerShape::Cross => LegendSample::Cross(self.color),
            MarkerShape::Ring => LegendSample::Ring(self.color),
        }
    }

    fn draw(&self, chart: &mut LogChart, points: Vec<(f64, f64)>) -> Result<(), AnyError> {
        let points = points.into_iter();
        let style = self.color.filled();
        // Each shape has a separate type.
        match self.shape {
            MarkerShape::Circle => chart.draw_series(points.map(|at| Circle::new(at, 4, style)))?,
            MarkerShape::Triangle => {
                chart.draw_series(points.map(|at| TriangleMarker::new(at, 5, style)))?
            }
            MarkerShape::Cross => {
                chart.draw_series(points.map(|at| Cross::new(at, 4, self.color)))?
            }
            MarkerShape::Ring => {
                chart.draw_series(points.map(|at| Circle::new(at, 4, self.color)))?
            }
        };
        Ok(())
    }
}

/// A power of ten, such as 1e-3.
fn power(value: f64) -> String {
    format!("{value:.0e}")
}
