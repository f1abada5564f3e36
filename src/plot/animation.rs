//! Animation of structure and base: an SVG with SMIL, which browsers play.

use std::fmt::Write;

use super::deformed::{FACE_OPACITY, MIN_DRAWN_SIDE, SOIL_COLOR, SURFACE_COLOR};
use super::deformed::{bounds, check_dimension, displaced_points, trench_outline};
use super::element_state::ElementStates;
use super::marks::{self, KEY_LEFT, PixelBox, hex};
use super::svg::{Svg, discrete_animation, escaped, polygon};
use super::text_width::{fitted, length_text, short, width};
use super::ticks::round_down;
use super::view::StructureView;
use crate::error::{Result, positive, require, require_part};
use crate::geometry::enclosing_interval;
use crate::results::{DeformedShape, TimeSeries};

/// Width of the picture, pixels.
const PICTURE_WIDTH: f64 = 940.0;
/// Height of the picture, pixels.
const PICTURE_HEIGHT: f64 = 640.0;
/// Rectangle of the structure.
const STRUCTURE_BOX: PixelBox = PixelBox { left: 40.0, top: 60.0, right: 690.0, bottom: 520.0 };
/// Largest number of frames: browsers cannot play larger files smoothly.
const MAX_FRAMES: usize = 600;
/// Largest number of texts of the clock.
const MAX_CLOCK_TEXTS: usize = 150;
/// Largest length of the scale bar, pixels.
const MAX_BAR_LENGTH: f64 = 150.0;
/// Width of the soil around a base in plan, over the longer side of the base.
const FLOOR_MARGIN_RATIO: f64 = 0.15;
/// Width of the soil drawn beside a trench, over the width of the trench.
const TRENCH_SIDE_RATIO: f64 = 0.15;
/// Distance of the axes from the base, over the width of the soil around the base.
const AXIS_DISTANCE_RATIO: f64 = 0.6;

/// The structure in motion with the contact modes of its base, as an animation.
///
/// Displacements are relative to the ground and multiplied by `magnification`. The picture contains the surface of the
/// soil, the contact mode of every element below it or behind walls, a clock, and a bar with the scales of
/// lengths and of displacements. One second of the run takes `slowness` seconds.
///
/// In plan the view is from the front, the right and above, with one scale for all lengths. Shells and sides of solids
/// hide most of what lies behind them. The elements are drawn below the structure, and again in a small plan at the side.
///
/// Frames of contact are shown if there are as many as frames of motion.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if fewer than two frames of motion were kept
/// ([`crate::results::Recorder::motion`]); [`Error::Input`](crate::Error::Input) unless
/// magnification and slowness are positive, or for more than 600 frames; [`Error::Index`](crate::Error::Index) if
/// `shape` belongs to another structure, [`Error::Scene`](crate::Error::Scene) if to one of another dimension.
pub fn animation(
    title: &str,
    shape: &DeformedShape,
    time_series: &TimeSeries,
    magnification: f64,
    slowness: f64,
) -> Result<Svg> {
    positive("magnification", magnification)?;
    positive("slowness", slowness)?;
    let frames: Vec<_> = time_series.motion_frames().collect();
    let needed_motion = "the recorder must keep the motion (`Recorder::motion`)";
    require_part("animation", frames.len() > 1, needed_motion)?;
    let needed = "600 or fewer: keep fewer of them";
    require("frames of an animation", frames.len() as f64, frames.len() <= MAX_FRAMES, needed)?;
    check_dimension(shape, time_series)?;
    let times: Vec<f64> = frames.iter().map(|frame| frame.time).collect();
    let view = StructureView::overview(time_series.up());
    let mut frame_points: Vec<Vec<[f64; 2]>> = Vec::with_capacity(frames.len());
    for frame in &frames {
        frame_points.push(view.project_all(&displaced_points(shape, frame, magnification)?));
    }
    let duration = format!("{:.3}s", (times[times.len() - 1] - times[0]) * slowness);
    let mut svg_text = head(title);
    let screen = match view {
        StructureView::Slanted => {
            let floor = Floor::new(time_series);
            let screen =
                Screen::around(&frame_points, &view.project_all(&floor.corners(floor.margin)));
            svg_text += &floor.draw(time_series, &screen, frames.len(), &duration);
            screen
        }
        StructureView::AgainstX | StructureView::AlongY => {
            let trench = trench_outline(time_series.elements());
            let mut surface = vec![[frame_points[0][0][0], 0.0]];
            if let Some([left_edge, .., right_edge]) = trench {
                // The marks of the walls need space.
                let side = TRENCH_SIDE_RATIO * (right_edge[0] - left_edge[0]);
                surface.extend([[left_edge[0] - side, 0.0], [right_edge[0] + side, 0.0]]);
            }
            let screen = Screen::around(&frame_points, &surface);
            svg_text += &screen.ground(trench);
            svg_text += &marks::element_marks(
                time_series,
                screen.scale,
                |point| screen.pixels(point),
                STRUCTURE_BOX.bottom,
                frames.len(),
                &duration,
            );
            screen
        }
    };
    svg_text +=
        &screen.structure(&view.far_to_near(shape), shape.has_faces(), &frame_points, &duration);
    svg_text += &screen.scale_bar(magnification);
    svg_text += &clock(&times, &duration);
    Ok(Svg::new(svg_text + "</svg>\n"))
}

/// Scale and origin of metres on the screen.
struct Screen {
    /// Pixels per metre.
    scale: f64,
    /// Left end of the structure, pixels.
    left: f64,
    /// Lower end of the structure, pixels.
    bottom: f64,
    /// The point at the left and lower ends, m.
    origin: [f64; 2],
}

impl Screen {
    /// Screen that contains the points of all frames and of the surface.
    fn around(frame_points: &[Vec<[f64; 2]>], surface: &[[f64; 2]]) -> Self {
        let mut all_points: Vec<[f64; 2]> = frame_points.iter().flatten().copied().collect();
        all_points.extend(surface);
        let bounds = bounds(&all_points);
        let sides = bounds.map(|[low, high]| (high - low).max(MIN_DRAWN_SIDE));
        let PixelBox { left, top, right, bottom } = STRUCTURE_BOX;
        let scale = ((right - left) / sides[0]).min((bottom - top) / sides[1]);
        let structure_left = left + 0.5 * (right - left - scale * sides[0]);
        Self { scale, left: structure_left, bottom, origin: bounds.map(|[low, _]| low) }
    }

    /// Pixels of a point in m.
    fn pixels(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + self.scale * (x - self.origin[0]),
            self.bottom - self.scale * (y - self.origin[1]),
        ]
    }

    /// Pixels of corners (x, height, y) on the floor, in the slanted view.
    fn corners(&self, corners: [[f64; 3]; 4]) -> [[f64; 2]; 4] {
        corners.map(|corner| self.pixels(StructureView::Slanted.project(corner)))
    }

    /// The cells at all instants, as SVG; cells that are faces hide what was drawn before.
    fn structure(
        &self,
        cells: &[&[usize]],
        are_faces: bool,
        frame_points: &[Vec<[f64; 2]>],
        duration: &str,
    ) -> String {
        // Faces are drawn one by one, so that each face hides the faces behind it.
        let cells_per_path = if are_faces { 1 } else { cells.len().max(1) };
        let fill = if are_faces { "#fff" } else { "none" };
        let mut svg_text = format!(
            "<g fill=\"{fill}\" fill-opacity=\"{FACE_OPACITY}\" stroke=\"#1f77b4\" stroke-width=\"1.2\" \
             stroke-linejoin=\"round\">\n"
        );
        for path_cells in cells.chunks(cells_per_path) {
            let paths: Vec<String> =
                frame_points.iter().map(|points| self.path(path_cells, points)).collect();
            let _ = writeln!(
                svg_text,
                "<path d=\"{}\"><animate attributeName=\"d\" dur=\"{duration}\" \
                 repeatCount=\"indefinite\" values=\"{}\"/></path>",
                paths[0],
                paths.join(";")
            );
        }
        svg_text + "</g>\n"
    }

    /// Outlines of the cells as an SVG path, with the same commands for every frame.
    fn path(&self, cells: &[&[usize]], points: &[[f64; 2]]) -> String {
        let mut path = String::new();
        for corners in cells {
            for (k, &corner) in corners.iter().enumerate() {
                let [x, y] = self.pixels(points[corner]);
                let command = if k == 0 { 'M' } else { 'L' };
                let _ = write!(path, "{command}{x:.1} {y:.1}");
            }
            if corners.len() > 2 {
                path.push('Z');
            }
        }
        path
    }

    /// The soil and its surface, with the outline of a trench.
    fn ground(&self, trench: Option<[[f64; 2]; 4]>) -> String {
        let PixelBox { left, right, bottom, .. } = STRUCTURE_BOX;
        let surface = self.pixels([0.0; 2])[1];
        let mut trench_path = String::new();
        for [x, y] in trench.iter().flatten().map(|corner| self.pixels(*corner)) {
            let _ = write!(trench_path, "L{x:.1} {y:.1}");
        }
        format!(
            "<rect x=\"{left}\" y=\"{surface:.1}\" width=\"{}\" height=\"{:.1}\" fill=\"{}\"/>\n\
             <path stroke=\"{}\" stroke-width=\"1.5\" fill=\"#fff\" d=\"M{left} {surface:.1}{trench_path}H{right}\"/>\n",
            right - left,
            bottom + 30.0 - surface,
            hex(SOIL_COLOR),
            hex(SURFACE_COLOR)
        )
    }

    /// A bar with its length in the scale of the structure and of its displacements, as SVG.
    fn scale_bar(&self, magnification: f64) -> String {
        let length = round_down(MAX_BAR_LENGTH / self.scale);
        let end = KEY_LEFT + self.scale * length;
        let y = 300.0;
        format!(
            "<path fill=\"none\" stroke=\"#444\" stroke-width=\"2\" \
             d=\"M{KEY_LEFT} {}v10M{KEY_LEFT} {y}H{end:.1}M{end:.1} {}v10\"/>\n\
             <text x=\"{KEY_LEFT}\" y=\"{}\">structure: {}</text>\n\
             <text x=\"{KEY_LEFT}\" y=\"{}\">displacements: {}</text>\n\
             <text x=\"{KEY_LEFT}\" y=\"{}\">(magnified × {})</text>\n",
            y - 5.0,
            y - 5.0,
            y + 24.0,
            length_text(length),
            y + 44.0,
            length_text(length / magnification),
            y + 64.0,
            short(magnification)
        )
    }
}

/// The beginning of the file, with the title.
fn head(title: &str) -> String {
    // Font sizes here are SVG sizes; sizes in plotters are 1.24 times as large.
    let title = fitted(title, 25, PICTURE_WIDTH - 40.0);
    let title = escaped(&title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {PICTURE_WIDTH} {PICTURE_HEIGHT}\" \
         width=\"{PICTURE_WIDTH}\" height=\"{PICTURE_HEIGHT}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{}\" y=\"34\" font-size=\"20\" text-anchor=\"middle\">{title}</text>\n",
        0.5 * PICTURE_WIDTH
    )
}

/// The surface around a base in plan.
struct Floor {
    /// Ends of the base along x and y, m.
    ends: [[f64; 2]; 2],
    /// Width of the soil drawn around the base, m.
    margin: f64,
}

/// Rectangle of the plan at the side.
const PLAN_BOX: PixelBox = PixelBox { left: KEY_LEFT, top: 440.0, right: 915.0, bottom: 585.0 };

impl Floor {
    fn new(time_series: &TimeSeries) -> Self {
        let elements = time_series.elements();
        let x_ends = enclosing_interval(elements.iter().map(|element| element.ends()[0]));
        let y_ends = enclosing_interval(elements.iter().map(|element| element.ends()[1]));
        let longer_side = (x_ends[1] - x_ends[0]).max(y_ends[1] - y_ends[0]);
        Self { ends: [x_ends, y_ends], margin: FLOOR_MARGIN_RATIO * longer_side }
    }

    /// Corners (x, height, y) at a distance `margin` outside the base.
    fn corners(&self, margin: f64) -> [[f64; 3]; 4] {
        let [[left, right], [front, back]] =
            self.ends.map(|[low, high]| [low - margin, high + margin]);
        [[left, front], [right, front], [right, back], [left, back]].map(|[x, y]| [x, 0.0, y])
    }

    /// Draws soil, axes, and the elements, coloured by their modes, below the structure and at the side.
    fn draw(
        &self,
        time_series: &TimeSeries,
        screen: &Screen,
        frame_count: usize,
        duration: &str,
    ) -> String {
        let soil = polygon(&screen.corners(self.corners(self.margin)));
        let mut svg_text = format!(
            "<path d=\"{soil}\" fill=\"{}\" stroke=\"{}\"/>\n",
            hex(SOIL_COLOR),
            hex(SURFACE_COLOR)
        );
        self.draw_axes(screen, &mut svg_text);
        let [[left, _], [_, back]] = self.ends;
        let contact: Vec<_> = time_series.contact_frames().collect();
        if contact.len() != frame_count {
            return svg_text;
        }
        let states = ElementStates::new(&contact, true);
        svg_text += &marks::color_key(states.key_states.clone());
        let _ = writeln!(
            svg_text,
            "<text x=\"{}\" y=\"{}\" font-size=\"12\">contact from above, x to the right</text>",
            PLAN_BOX.left,
            PLAN_BOX.top - 8.0
        );
        let sides = self.ends.map(|[low, high]| high - low);
        let scale = ((PLAN_BOX.right - PLAN_BOX.left) / sides[0])
            .min((PLAN_BOX.bottom - PLAN_BOX.top) / sides[1]);
        for (e, element) in time_series.elements().iter().enumerate() {
            let corners = Self { ends: element.ends(), margin: 0.0 }.corners(0.0);
            let plan_corners = corners.map(|[x, _, y]| {
                [PLAN_BOX.left + scale * (x - left), PLAN_BOX.top + scale * (back - y)]
            });
            let colors: Vec<String> =
                states.frame_states.iter().map(|frame| hex(frame[e].color())).collect();
            let color_changes = discrete_animation("fill", &colors, duration);
            for cell in [polygon(&screen.corners(corners)), polygon(&plan_corners)] {
                let _ = writeln!(
                    svg_text,
                    "<path d=\"{cell}\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.6\">{color_changes}</path>",
                    colors[0]
                );
            }
        }
        svg_text
    }

    /// Draws the axes x and y beside the soil.
    fn draw_axes(&self, screen: &Screen, svg_text: &mut String) {
        let [[left, right], [front, back]] = self.ends;
        let distance = AXIS_DISTANCE_RATIO * self.margin;
        for (name, start, end) in [
            ("x", [left, 0.0, front - distance], [right, 0.0, front - distance]),
            ("y", [right + distance, 0.0, front], [right + distance, 0.0, back]),
        ] {
            let [[start_x, start_y], [end_x, end_y]] =
                [start, end].map(|point| screen.pixels(StructureView::Slanted.project(point)));
            let _ = writeln!(
                svg_text,
                "<path d=\"M{start_x:.1} {start_y:.1}L{end_x:.1} {end_y:.1}\" stroke=\"{}\"/>\
                 <circle cx=\"{end_x:.1}\" cy=\"{end_y:.1}\" r=\"3\" fill=\"{}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{name}</text>",
                hex(SURFACE_COLOR),
                hex(SURFACE_COLOR),
                end_x + 7.0,
                end_y + 5.0
            );
        }
    }
}

/// The running time as SVG: a bar, and a sequence of texts, because SMIL has no counter.
fn clock(times: &[f64], duration: &str) -> String {
    let begin_time = times[0];
    let end_time = times[times.len() - 1];
    let begin_text = format!("{begin_time:.2} s");
    let end_text = format!("{end_time:.2} s");
    let left = 30.0 + width(&begin_text, 18).max(width(&end_text, 18));
    let length = PICTURE_WIDTH - 2.0 * left;
    let y = 600.0;
    let mut svg_text = format!(
        "<rect x=\"{left:.1}\" y=\"{y}\" width=\"{length:.1}\" height=\"8\" fill=\"#ddd\"/>\
         <rect x=\"{left:.1}\" y=\"{y}\" width=\"0\" height=\"8\" fill=\"#444\">\
         <animate attributeName=\"width\" from=\"0\" to=\"{length:.1}\" dur=\"{duration}\" \
         repeatCount=\"indefinite\"/></rect>\n\
         <text x=\"{:.1}\" y=\"{}\" text-anchor=\"end\">{begin_text}</text>\
         <text x=\"{:.1}\" y=\"{}\">{end_text}</text>\n",
        left - 10.0,
        y + 9.0,
        left + length + 10.0,
        y + 9.0
    );
    // The last frame has no duration, so only the other frames have texts.
    let frames_per_text = (times.len() - 1).div_ceil(MAX_CLOCK_TEXTS);
    let text_times: Vec<f64> =
        times[..times.len() - 1].iter().copied().step_by(frames_per_text).collect();
    // Fractions of the run at which texts begin, and 1 for its end.
    let mut fractions: Vec<f64> = text_times
        .iter()
        .map(|time| ((time - begin_time) / (end_time - begin_time)).clamp(0.0, 1.0))
        .collect();
    fractions.push(1.0);
    for (k, &time) in text_times.iter().enumerate() {
        let text_start = fractions[k];
        let text_end = fractions[k + 1];
        let is_visible_at_start = k == 0;
        let (initial_state, states, key_times) = if is_visible_at_start {
            ("visible", "visible;hidden", format!("0;{text_end:.5}"))
        } else {
            ("hidden", "hidden;visible;hidden", format!("0;{text_start:.5};{text_end:.5}"))
        };
        let _ = writeln!(
            svg_text,
            "<text x=\"{KEY_LEFT}\" y=\"400\" font-size=\"20\" visibility=\"{initial_state}\">t = {time:.2} s\
             <animate attributeName=\"visibility\" calcMode=\"discrete\" dur=\"{duration}\" \
             repeatCount=\"indefinite\" values=\"{states}\" keyTimes=\"{key_times}\"/></text>"
        );
    }
    svg_text
}
