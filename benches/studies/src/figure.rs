//! Pictures: panels with curves and markers, as SVG.

use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use plotters::style::SizeDesc;

use crate::AnyError;

type FigureArea<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Points of a curve; more points than pixels would not be visible.
const MAX_CURVE_POINTS: usize = 700;

/// Pixels of the drawing to one of the picture: coordinates in SVG files are whole numbers here.
const PIXEL_SCALE: i32 = 4;
/// Width of a thin line, pixels of the drawing.
const THIN_LINE_WIDTH: u32 = 4;

pub(crate) const CURVE_BLUE: RGBColor = RGBColor(31, 119, 180);
pub(crate) const CURVE_RED: RGBColor = RGBColor(214, 39, 40);
pub(crate) const CURVE_GREEN: RGBColor = RGBColor(44, 160, 44);
pub(crate) const CURVE_ORANGE: RGBColor = RGBColor(255, 140, 0);
pub(crate) const CURVE_VIOLET: RGBColor = RGBColor(148, 103, 189);
pub(crate) const CURVE_GRAY: RGBColor = RGBColor(70, 70, 70);

/// Panels under a title.
pub(crate) struct Figure {
    pub(crate) title: String,
    pub(crate) columns: usize,
    pub(crate) panels: Vec<FigurePanel>,
}

/// Style in which a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum SeriesStyle {
    /// Wide and pale, below the others: references.
    Wide,
    /// Thin: results of the crate.
    Thin,
    Dashed,
    Circles,
    Crosses,
}

struct FigureSeries {
    name: String,
    color: RGBColor,
    style: SeriesStyle,
    points: Vec<(f64, f64)>,
}

/// Axes with series.
pub(crate) struct FigurePanel {
    x: String,
    y: String,
    logarithmic: [bool; 2],
    /// Whether values increase downwards.
    is_downward: bool,
    legend: SeriesLabelPosition,
    categories: Vec<String>,
    /// Part of the height that is kept free for the legend: below, above.
    room: [f64; 2],
    series: Vec<FigureSeries>,
}

impl FigurePanel {
    pub(crate) fn new(x: &str, y: &str) -> Self {
        Self {
            x: x.into(),
            y: y.into(),
            logarithmic: [false; 2],
            is_downward: false,
            legend: SeriesLabelPosition::UpperRight,
            categories: Vec::new(),
            room: [0.05; 2],
            series: Vec::new(),
        }
    }

    /// With a logarithmic vertical axis.
    pub(crate) fn logarithmic(mut self) -> Self {
        self.logarithmic[1] = true;
        self
    }

    /// With two logarithmic axes.
    pub(crate) fn double_logarithmic(mut self) -> Self {
        self.logarithmic = [true; 2];
        self
    }

    /// With values that increase downwards, on a linear vertical axis.
    pub(crate) fn downward(mut self) -> Self {
        self.is_downward = true;
        self
    }

    /// With the legend somewhere else than at the upper right.
    pub(crate) fn legend(mut self, position: SeriesLabelPosition) -> Self {
        self.legend = position;
        self
    }

    /// With free parts of the height below and above the curves.
    pub(crate) fn room(mut self, below: f64, above: f64) -> Self {
        self.room = [below, above];
        self
    }

    /// With names instead of the numbers 0, 1, 2, … along x.
    pub(crate) fn categories(mut self, names: &[&str]) -> Self {
        self.categories = names.iter().map(|&name| name.to_owned()).collect();
        self
    }

    /// A reference curve.
    pub(crate) fn reference(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, SeriesStyle::Wide, points)
    }

    /// A curve that was computed.
    pub(crate) fn line(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, SeriesStyle::Thin, points)
    }

    /// A curve for orientation.
    pub(crate) fn dashed(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, SeriesStyle::Dashed, points)
    }

    /// Single values.
    pub(crate) fn circles(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, SeriesStyle::Circles, points)
    }

    /// Single values of a reference.
    pub(crate) fn crosses(self, name: &str, color: RGBColor, points: Vec<(f64, f64)>) -> Self {
        self.series(name, color, SeriesStyle::Crosses, points)
    }

    fn series(
        mut self,
        name: &str,
        color: RGBColor,
        style: SeriesStyle,
        points: Vec<(f64, f64)>,
    ) -> Self {
        let stride = points.len().div_ceil(MAX_CURVE_POINTS).max(1);
        let points: Vec<_> = points.into_iter().step_by(stride).collect();
        self.series.push(FigureSeries { name: name.into(), color, style, points });
        self
    }

    /// Extent of the series along one axis, with room beside them.
    fn range(
        &self,
        [below, above]: [f64; 2],
        logarithmic: bool,
        coordinate: impl Fn(&(f64, f64)) -> f64,
    ) -> Range<f64> {
        let points = self.series.iter().flat_map(|series| &series.points);
        let low = points.clone().map(&coordinate).fold(f64::INFINITY, f64::min);
        let high = points.map(&coordinate).fold(f64::NEG_INFINITY, f64::max);
        if logarithmic {
            let span = (high / low).ln();
            return low * (-below * span).exp()..high * (above * span).exp();
        }
        let span = (high - low).max(f64::MIN_POSITIVE);
        low - below * span..high + above * span
    }

    fn draw(&self, area: &FigureArea) -> Result<(), AnyError> {
        // Markers and names of categories extend beyond their points.
        let has_markers = self
            .series
            .iter()
            .any(|series| matches!(series.style, SeriesStyle::Circles | SeriesStyle::Crosses));
        let sides = match (has_markers, self.categories.is_empty()) {
            (_, false) => 0.12,
            (true, true) => 0.06,
            (false, true) => 0.0,
        };
        let x = self.range([sides; 2], self.logarithmic[0], |point| point.0);
        let y = self.range(self.room, self.logarithmic[1], |point| point.1);
        let mut builder = ChartBuilder::on(area);
        builder
            .margin(PIXEL_SCALE * 12)
            .x_label_area_size(PIXEL_SCALE * 48)
            .y_label_area_size(PIXEL_SCALE * 78);
        let category = |value: &f64| self.category_at(*value);
        let plain_x = plain(&x);
        let plain_y = plain(&y);
        let format_x: &dyn Fn(&f64) -> String =
            if self.categories.is_empty() { &plain_x } else { &category };
        match self.logarithmic {
            [true, _] => {
                let chart = builder.build_cartesian_2d(x.log_scale(), y.log_scale())?;
                self.fill(chart, &|value| format!("{value}"), &|value| power_of_ten(*value))
            }
            [_, true] => {
                let chart = builder.build_cartesian_2d(x, y.log_scale())?;
                self.fill(chart, format_x, &|value| power_of_ten(*value))
            }
            _ => {
                let y = if self.is_downward { y.end..y.start } else { y };
                self.fill(builder.build_cartesian_2d(x, y)?, format_x, &plain_y)
            }
        }
    }

    /// Name of the category at this coordinate, or nothing between categories.
    fn category_at(&self, value: f64) -> String {
        let mut categories = self.categories.iter().enumerate();
        let category = categories.find(|(k, _)| (*k as f64 - value).abs() < 0.01);
        category.map_or_else(String::new, |(_, name)| name.clone())
    }

    /// Draws mesh, series and legend.
    fn fill<'a, 'b: 'a, X, Y>(
        &self,
        mut chart: ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
        format_x: &dyn Fn(&f64) -> String,
        format_y: &dyn Fn(&f64) -> String,
    ) -> Result<(), AnyError>
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| format_x(x))
            .y_label_formatter(&|y| format_y(y))
            .label_style(("sans-serif", PIXEL_SCALE * 14))
            .axis_desc_style(("sans-serif", PIXEL_SCALE * 16))
            .x_labels(if self.categories.is_empty() { 11 } else { self.categories.len() })
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.15).stroke_width(THIN_LINE_WIDTH))
            .axis_style(BLACK.stroke_width(THIN_LINE_WIDTH))
            .set_all_tick_mark_size(PIXEL_SCALE * 5)
            .draw()?;
        for series in &self.series {
            series.draw(&mut chart)?;
        }
        if self.series.iter().any(|series| !series.name.is_empty()) {
            chart
                .configure_series_labels()
                .position(self.legend.clone())
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3).stroke_width(THIN_LINE_WIDTH))
                .margin(PIXEL_SCALE * 8)
                .legend_area_size(PIXEL_SCALE * 30)
                .label_font(("sans-serif", PIXEL_SCALE * 14))
                .draw()?;
        }
        Ok(())
    }
}

impl FigureSeries {
    fn draw<'a, 'b: 'a, X, Y>(
        &self,
        chart: &mut ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>,
    ) -> Result<(), AnyError>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let color = self.color;
        let points = self.points.iter().copied();
        let stroke = match self.style {
            SeriesStyle::Wide => color.mix(0.35).stroke_width(6 * THIN_LINE_WIDTH),
            SeriesStyle::Crosses => color.stroke_width(2 * THIN_LINE_WIDTH),
            SeriesStyle::Thin | SeriesStyle::Dashed | SeriesStyle::Circles => {
                color.stroke_width(THIN_LINE_WIDTH + THIN_LINE_WIDTH / 2)
            }
        };
        let radius = PIXEL_SCALE * 4;
        let arm = PIXEL_SCALE * 5;
        let drawn = match self.style {
            SeriesStyle::Wide | SeriesStyle::Thin => {
                chart.draw_series(LineSeries::new(points, stroke))?
            }
            SeriesStyle::Dashed => {
                let dash = (PIXEL_SCALE * 5).in_pixels(&(1, 1));
                let space = (PIXEL_SCALE * 4).in_pixels(&(1, 1));
                chart.draw_series(DashedLineSeries::new(points, dash, space, stroke))?
            }
            SeriesStyle::Circles => {
                chart.draw_series(points.map(|at| Circle::new(at, radius, stroke)))?
            }
            SeriesStyle::Crosses => {
                chart.draw_series(points.map(|at| Cross::new(at, arm, stroke)))?
            }
        };
        if self.name.is_empty() {
            return Ok(());
        }
        let drawn = drawn.label(&self.name);
        // Each marker has a separate type.
        match self.style {
            SeriesStyle::Wide | SeriesStyle::Thin => drawn.legend(move |(x, y)| {
                PathElement::new(vec![(x, y), (x + PIXEL_SCALE * 22, y)], stroke)
            }),
            SeriesStyle::Dashed => drawn.legend(move |at| {
                EmptyElement::at(at) + dash(0, stroke) + dash(9, stroke) + dash(18, stroke)
            }),
            SeriesStyle::Circles => {
                drawn.legend(move |(x, y)| Circle::new((x + PIXEL_SCALE * 11, y), radius, stroke))
            }
            SeriesStyle::Crosses => {
                drawn.legend(move |(x, y)| Cross::new((x + PIXEL_SCALE * 11, y), arm, stroke))
            }
        };
        Ok(())
    }
}

/// Dash of a legend from this pixel on.
fn dash(from: i32, stroke: ShapeStyle) -> PathElement<(i32, i32)> {
    PathElement::new(vec![(PIXEL_SCALE * from, 0), (PIXEL_SCALE * (from + 5), 0)], stroke)
}

fn power_of_ten(value: f64) -> String {
    format!("{value:.0e}")
}

impl Figure {
    pub(crate) fn new(title: &str, columns: usize, panels: Vec<FigurePanel>) -> Self {
        Self { title: title.into(), columns, panels }
    }

    /// Writes the SVG.
    pub(crate) fn draw(&self, path: &Path) -> Result<(), AnyError> {
        let rows = self.panels.len().div_ceil(self.columns);
        let width = 1200;
        let height = if rows == 1 { 460 } else { 60 + 290 * rows };
        let scale = usize::try_from(PIXEL_SCALE)?;
        let size = (u32::try_from(scale * width)?, u32::try_from(scale * height)?);
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&WHITE)?;
            let body = root
                .margin(PIXEL_SCALE * 10, 0, 0, 0)
                .titled(&self.title, ("sans-serif", PIXEL_SCALE * 22))?;
            for (area, panel) in body.split_evenly((rows, self.columns)).iter().zip(&self.panels) {
                panel.draw(area)?;
            }
            root.present()?;
        }
        // The view box keeps the drawing's pixels.
        let drawing_size = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
        let picture_size = format!("width=\"{width}\" height=\"{height}\"");
        Ok(std::fs::write(path, text.replacen(&drawing_size, &picture_size, 1))?)
    }
}

/// Decimal numbers with as many digits as a tenth of the range needs.
fn plain(range: &Range<f64>) -> impl Fn(&f64) -> String + use<> {
    let step = (range.end - range.start) / 10.0;
    let digits = (-step.log10()).ceil().clamp(0.0, 6.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 6")]
    let digits = digits as usize;
    move |value| format!("{:.digits$}", if value.abs() < 1e-12 { 0.0 } else { *value })
}
