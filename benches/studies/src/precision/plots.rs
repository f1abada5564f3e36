//! Error against time, in logarithms.

use std::path::Path;

use basemat::bem::Grading;
use plotters::prelude::*;

use super::settings::{HISTORIES, Past, SCHEMES, Scheme};
use super::sweep::{Outcome, Point};
use crate::AnyError;
use crate::key::{self, Area, Sample};

const SIZE: (u32, u32) = (1480, 620);
const FRONT: RGBColor = RGBColor(214, 39, 40);

type Chart<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<
        plotters::coord::combinators::LogCoord<f64>,
        plotters::coord::combinators::LogCoord<f64>,
    >,
>;

/// A family of points with its name, colour and shape.
struct Family {
    name: String,
    color: RGBColor,
    shape: Shape,
    grading: Grading,
    history: Past,
    scheme: Scheme,
}

#[derive(Clone, Copy)]
enum Shape {
    Circle,
    Triangle,
    Cross,
    Ring,
}

fn families() -> Vec<Family> {
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
    let kinds = HISTORIES
        .iter()
        .map(|&history| (history.name.to_owned(), history, Scheme::Midpoint))
        .chain(SCHEMES.iter().map(|&scheme| (scheme.name(), HISTORIES[0], scheme)));
    let mut list = Vec::new();
    for ((name, history, scheme), color) in kinds.zip(colors.iter().cycle()) {
        let shapes = match scheme {
            Scheme::Midpoint => [Shape::Circle, Shape::Triangle],
            _ => [Shape::Cross, Shape::Ring],
        };
        let gradings = [(Grading::Uniform, "uniform"), (Grading::Cosine, "cosine")];
        for ((grading, word), shape) in gradings.into_iter().zip(shapes) {
            let name = format!("{word}, {name}");
            list.push(Family { name, color: *color, shape, grading, history, scheme });
        }
    }
    list
}

/// One file: the history's error on the left, the peak's on the right.
pub(crate) fn draw(path: &Path, sweep: &Outcome) -> Result<(), AnyError> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Base shear, {}: error against processor time", sweep.scene);
    let body = root.titled(&title, ("sans-serif", 24))?;
    let mut entries = vec![("front: none faster and closer".to_owned(), Sample::Line(FRONT))];
    let families = families().into_iter();
    let there = families.filter(|family| sweep.points.iter().any(|point| family.holds(point)));
    entries.extend(there.map(|family| (family.name.clone(), family.sample())));
    let body = key::draw(&body, 30, &entries)?;
    let halves = body.split_evenly((1, 2));
    panel(&halves[0], "error of the history (relative L2)", sweep, true, |p| p.errors.history)?;
    panel(&halves[1], "error of the peak (relative)", sweep, false, |p| p.errors.peak)?;
    root.present()?;
    Ok(())
}

fn panel(
    area: &Area,
    label: &str,
    sweep: &Outcome,
    front: bool,
    value: impl Fn(&Point) -> f64,
) -> Result<(), AnyError> {
    // Peaks can agree by chance to any digit.
    let place = |point: &Point| (point.seconds, value(point).max(1e-5));
    let range = |pick: &dyn Fn(&Point) -> f64| {
        let values = || sweep.points.iter().map(pick);
        let low = values().fold(f64::INFINITY, f64::min);
        0.6 * low..1.8 * values().fold(0.0, f64::max)
    };
    let errors = range(&|p| place(p).1);
    let mut chart: Chart = ChartBuilder::on(area)
        .margin(14)
        .x_label_area_size(48)
        .y_label_area_size(76)
        .build_cartesian_2d(range(&|p| place(p).0).log_scale(), errors.log_scale())?;
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
        let mut line: Vec<_> = sweep.points.iter().filter(|point| point.front).map(place).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        chart.draw_series(LineSeries::new(line, FRONT.stroke_width(2)))?;
    }
    for family in families() {
        let points: Vec<_> =
            sweep.points.iter().filter(|point| family.holds(point)).map(place).collect();
        if !points.is_empty() {
            family.draw(&mut chart, points)?;
        }
    }
    Ok(())
}

impl Family {
    fn holds(&self, point: &Point) -> bool {
        let s = &point.settings;
        s.grading == self.grading && s.history == self.history && s.scheme == self.scheme
    }

    fn sample(&self) -> Sample {
        match self.shape {
            Shape::Circle => Sample::Circle(self.color),
            Shape::Triangle => Sample::Triangle(self.color),
            Shape::Cross => Sample::Cross(self.color),
            Shape::Ring => Sample::Ring(self.color),
        }
    }

    fn draw(&self, chart: &mut Chart, points: Vec<(f64, f64)>) -> Result<(), AnyError> {
        let (points, style) = (points.into_iter(), self.color.filled());
        // Each shape is a type of its own.
        match self.shape {
            Shape::Circle => chart.draw_series(points.map(|at| Circle::new(at, 4, style)))?,
            Shape::Triangle => {
                chart.draw_series(points.map(|at| TriangleMarker::new(at, 5, style)))?
            }
            Shape::Cross => chart.draw_series(points.map(|at| Cross::new(at, 4, self.color)))?,
            Shape::Ring => chart.draw_series(points.map(|at| Circle::new(at, 4, self.color)))?,
        };
        Ok(())
    }
}

/// 1e-3 and the like.
fn power(value: f64) -> String {
    format!("{value:.0e}")
}
