//! GOAL: every text of a picture can be read, however long, and no sheet is blank.
//! SCENE: long words, many curves, odd ranges, distant foundations, control characters.
//! REFERENCE: the texts of the SVG, laid out here.

use basemat::bem::{ElasticGround, Strip};
use basemat::plot::{self, Curve, Svg};
use basemat::results::{DeformedShape, Quantity, Recorder, ShapePoint};
use basemat::structure::{DofCombination, StructureGroup};

use super::layout::assert_readable;
use super::plot::{PlottedRun, rocking_block, shows, spectral_ordinate, words};
use basemat_problems::scenes::{self, SI_UNITS, block, friction, scene};

/// A text that no sheet is wide enough for.
fn wide_text(words: &str) -> String {
    format!("{} and its end", words.repeat(20))
}

/// Curves from one corner of the axes, every third with a wide name.
fn many_curves(count: usize, from: f64, to: f64) -> Vec<Curve> {
    let mut curves = Vec::new();
    for k in 0..count {
        let name = if k % 3 == 0 { wide_text("friction ") } else { "run".into() };
        curves.push(Curve {
            name: format!("{k} {name}"),
            points: vec![(from, from), (to, to + (to - from) * k as f64)],
        });
    }
    curves
}

/// Number of marks of this colour.
fn count_polygons(svg: &Svg, color: &str) -> usize {
    let polygons = svg.as_str().split("<polygon").skip(1);
    polygons.filter(|tag| tag.split('>').next().unwrap().contains(color)).count()
}

#[test]
fn every_text_can_be_read_whatever_is_drawn() {
    let title = wide_text("base shear of a tower ");
    for (from, to) in [
        (0.0, 30.0),
        (1.000_01, 1.000_02),
        (123_456.000_1, 123_456.000_2),
        (-1e59, 1e59),
        (1e-50, 3e-50),
        (1e12, 1e12 + 2e4),
        (-0.001, 0.001),
    ] {
        for count in [1, 8, 30, 44, 200] {
            let label = wide_text("displacement, mm ");
            let svg = plot::curves(&title, &label, &label, &many_curves(count, from, to)).unwrap();
            assert_readable(svg.as_str(), &format!("{count} curves, {from} to {to}"));
            shows(&svg, &["…"]);
        }
    }
    let svg = plot::curves("T", "x", "y", &many_curves(44, 0.0, 1.0)).unwrap();
    shows(&svg, &["41 run", "… and 2 more"]);
    // More curves than colours: curves of one colour have different signs.
    let svg = plot::curves("T", "x", "y", &many_curves(15, 0.0, 1.0)).unwrap();
    let polygons = ["#1F77B4", "#D62728", "#17BECF"].map(|color| count_polygons(&svg, color));
    // Nine marks are on the curve and one is in the key; a straight line of two points has two.
    assert_eq!(polygons, [3 + 3, 3, 3]);

    for (from, to) in [(0.05, 2.0), (1e-6, 1e6), (0.3, 0.3), (1.0, 1.001), (0.02, 10.0)] {
        let spectrum = [from, to].map(|period| spectral_ordinate(period, 900.0));
        let name = wide_text("storey ");
        let list = [(name.as_str(), &spectrum[..]); 9];
        let svg = plot::spectra(&title, &list).unwrap();
        assert_readable(svg.as_str(), &format!("spectra from {from} to {to}"));
    }
    let spectrum = [0.05, 2.0].map(|period| spectral_ordinate(period, 900.0));
    let svg = plot::spectra("T", &[("a", &spectrum)]).unwrap();
    let words = words(&svg);
    for mark in ["0.05", "0.1", "0.5", "1", "2"] {
        assert_eq!(words.split_whitespace().filter(|word| *word == mark).count(), 1, "{mark}");
    }
}

/// The row with `offset` added to the numbers of its degrees of freedom.
fn raised_row(row: &DofCombination, offset: usize) -> DofCombination {
    row.into_iter().map(|(dof, weight)| (dof + offset, *weight)).collect()
}

/// Blocks of 4 m at these distances from the first.
fn distant_blocks(distances: &[f64]) -> PlottedRun {
    let mut group = StructureGroup::new().with(block(SI_UNITS), 0.0).unwrap();
    let mut strips = vec![Strip::uniform(-2.0..2.0, 4).unwrap()];
    let single_shape = DeformedShape::of_block(&block(SI_UNITS), 6.0).unwrap();
    let mut points = single_shape.points().to_vec();
    let mut cells = single_shape.cells().to_vec();
    for (k, distance) in distances.iter().enumerate() {
        group = group.with(block(SI_UNITS), *distance).unwrap();
        strips.push(Strip::uniform(distance - 2.0..distance + 2.0, 4).unwrap());
        let first = points.len();
        let moved_points = single_shape.points().iter().map(|point| ShapePoint {
            position: [point.position[0] + distance, point.position[1]],
            horizontal: raised_row(&point.horizontal, 3 * (k + 1)),
            vertical: raised_row(&point.vertical, 3 * (k + 1)),
            ..ShapePoint::default()
        });
        points.extend(moved_points);
        cells.extend(
            single_shape.cells().iter().map(|cell| cell.iter().map(|k| k + first).collect()),
        );
    }
    let ground = ElasticGround::new(scenes::soil(SI_UNITS), &strips).unwrap();
    let scene = scene(SI_UNITS, 0.6).structure(group).ground(ground).interface(friction(0.35));
    let mut simulation = scene.build().unwrap();
    let recorder = Recorder::new().contact(4).motion(4);
    let mut time_series = recorder.start(&simulation).unwrap();
    let run = simulation.run(160, |state| time_series.record(state)).unwrap();
    PlottedRun { time_series, shape: DeformedShape::new(points, cells).unwrap(), run }
}

#[test]
fn foundations_far_apart_leave_no_sheet_blank() {
    let title = wide_text("two blocks ");
    for distances in [&[40.0][..], &[4.3], &[9.0, 1000.0, 1007.0, 1_000_000.0]] {
        let PlottedRun { time_series, shape, run } = distant_blocks(distances);
        let name = format!("foundations at {distances:?}");
        for svg in [
            plot::mode_map(&title, &time_series),
            plot::pressure_envelope(&title, &run),
            plot::energy(&title, &time_series),
            plot::deformed_shapes(&title, &shape, &time_series, &[0.1; 30], 1.234_567_890_1e-7),
            plot::animation(&title, &shape, &time_series, 1.234_567_890_1e-7, 1e9),
            plot::animation(&title, &shape, &time_series, 1e9, 1.0),
        ] {
            assert_readable(svg.unwrap().as_str(), &name);
        }
        if distances.len() == 4 {
            shows(&plot::mode_map("T", &time_series).unwrap(), &["1000000", "gap 5 m"]);
        }
        for quantity in Quantity::recorded(false) {
            let runs = [(title.as_str(), &time_series); 9];
            let svg = plot::time_series(&title, &runs, quantity).unwrap();
            assert_readable(svg.as_str(), quantity.name());
        }
    }
    let distant_run = distant_blocks(&[40.0]);
    let svg = plot::mode_map("Far", &distant_run.time_series).unwrap();
    shows(&svg, &["gap 36 m", "-2", "38", "42"]);
    // Elements are 1 m high of 8.8 m between the axes.
    let heights = svg.as_str().split("<rect").filter(|tag| tag.contains("#D6DEE4")).map(|tag| {
        let value = tag.split("height=\"").nth(1).unwrap().split('"').next().unwrap();
        value.parse::<f64>().unwrap()
    });
    assert!(heights.fold(0.0, f64::max) > 40.0);
}

/// Names in files of other programs contain control characters that XML does not allow.
#[test]
fn control_characters_leave_a_picture_valid() {
    let signs: String =
        (0..32).chain([0x7f, 0x85, 0xfffe, 0xffff]).filter_map(char::from_u32).collect();
    let PlottedRun { time_series, shape, run } = rocking_block(Recorder::new().motion(20));
    let title = format!("a{signs}<b>");
    for svg in [
        plot::pressure_envelope(&title, &run).unwrap(),
        plot::animation(&title, &shape, &time_series, 10.0, 1.0).unwrap(),
    ] {
        let text = svg.as_str();
        let unknown = text.chars().find(|&c| {
            (c < ' ' && !['\t', '\n', '\r'].contains(&c)) || ['\u{fffe}', '\u{ffff}'].contains(&c)
        });
        assert_eq!(unknown, None);
        assert!(text.contains("\u{fffd}") && text.contains("&lt;b&gt;"));
    }
}
