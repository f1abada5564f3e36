//! GOAL: pictures are well-formed and legible, show what they must, and refuse what cannot be
//! shown.
//! SCENE: every picture, with odd values, long words and distant foundations.
//! REFERENCE: the tags and texts of the SVG, laid out here.

use basemat::analyses::interaction;
use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::Probe;
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::motion::{SpectralOrdinate, el_centro_1940};
use basemat::plot::{self, Curve, Svg};
use basemat::results::Run;
use basemat::results::{DeformedShape, Quantity, Recorder, ShapePoint, TimeSeries};
use basemat::site::{EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::structure::{DofCombination, RigidBlock, ShearBuilding, Storey, StructureGroup};
use basemat::{Error, Simulation, Soil, unobserved};
use basemat_problems::faults::is_unwritable;

use crate::results::layout::assert_readable;
use basemat_problems::scenes::{self, SI, block, friction, scene};

fn simulation() -> (Simulation, DeformedShape) {
    let shape = DeformedShape::of_block(&block(SI), 6.0).unwrap();
    (scene(SI, 0.6).structure(block(SI)).interface(friction(0.35)).build().unwrap(), shape)
}

fn recorded(recorder: Recorder) -> (TimeSeries, DeformedShape) {
    let (time_series, shape, _) = ran(recorder);
    (time_series, shape)
}

fn ran(recorder: Recorder) -> (TimeSeries, DeformedShape, Run) {
    let (mut simulation, shape) = simulation();
    let mut time_series = recorder.start(&simulation).unwrap();
    let run = simulation.run(200, |state| time_series.record(state)).unwrap();
    (time_series, shape, run)
}

/// Words of the picture; its tags must be nested, its numbers finite and its texts readable.
fn words(svg: &Svg) -> String {
    let text = svg.as_str();
    assert_readable(text, "picture");
    assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"));
    let (mut open, mut words) = (Vec::new(), String::new());
    for piece in text.split('<').skip(1) {
        let (tag, rest) = piece.split_once('>').unwrap();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed));
        } else if !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().unwrap());
        }
        words += rest.trim();
        words.push(' ');
    }
    assert!(open.is_empty());
    words
}

fn shows(svg: &Svg, needed: &[&str]) {
    let words = words(svg);
    for word in needed {
        assert!(words.contains(word), "{word} in {words}");
    }
}

#[test]
fn every_picture_has_title_labels_units_and_legend() {
    let (time_series, shape, run) = ran(Recorder::new().contact(1).motion(5));
    let runs = [("one", &time_series), ("two", &time_series)];
    for quantity in Quantity::recorded(false) {
        let svg = plot::time_series("Title", &runs, quantity).unwrap();
        shows(&svg, &["Title", "time, s", quantity.name(), "one", "two"]);
    }
    let svg = plot::time_series("Title", &runs, Quantity::SlidingSafety).unwrap();
    shows(&svg, &["1 / factor of safety against sliding", "1: sliding"]);
    // Without a friction coefficient there is no demand to be drawn, however large.
    let builder = scene(SI, 0.6).structure(block(SI)).interface(Bonded);
    let mut simulation = builder.build().unwrap();
    let mut bonded = Recorder::new().start(&simulation).unwrap();
    simulation.run(50, |state| bonded.record(state)).unwrap();
    let svg = plot::time_series("Title", &[("held", &bonded)], Quantity::SlidingSafety).unwrap();
    assert!(!words(&svg).contains("drawn at"));
    let svg = plot::time_series("a < b & c", &runs, Quantity::BaseMoment).unwrap();
    shows(&svg, &["a &lt; b &amp; c"]);
    shows(&svg, &["base moment, kN·m/m"]);
    let modes = ["stick", "slip to the left", "slip to the right", "open"];
    let svg = plot::mode_map("Modes", &time_series).unwrap();
    shows(&svg, &modes);
    shows(&svg, &["x along the base, m", "time, s"]);
    // Each of the modes has its stretches (and its key).
    for color in ["#D6DEE4", "#FFA62B", "#D62728", "#164878"] {
        assert!(svg.as_str().matches(color).count() > 2, "{color}");
    }
    let svg = plot::pressure_envelope("Pressure", &run).unwrap();
    shows(&svg, &["pressure, kPa", "largest", "static", "least"]);
    let svg = plot::energy("Energy", &time_series).unwrap();
    shows(&svg, &["energy, kJ/m", "input", "friction and impact", "soil"]);
    // A rigid block has no dampers.
    assert!(!words(&svg).contains("damping"));
    let svg = plot::deformed_shapes("Shape", &shape, &time_series, &[0.1, 0.4], 20.0).unwrap();
    shows(&svg, &["Shape", "displacements × 20", "at rest", "t = 0.10 s", "t = 0.40 s", "y, m"]);
    let svg = plot::animation("A < B & C", &shape, &time_series, 20.0, 1.0).unwrap();
    shows(&svg, &["A &lt; B &amp; C"]);
    // Path, bar of time and 40 times; no base, for its frames are others than the structure's.
    assert_eq!(svg.as_str().matches("<animate ").count(), 2 + 40);
    shows(&svg, &["t = 0.00 s", "t = 0.49 s", "structure: 2 m", "displacements: 100 mm", "× 20"]);
    let (time_series, shape) = recorded(Recorder::new().contact(5).motion(5));
    let svg = plot::animation("Block", &shape, &time_series, 20.0, 1.0).unwrap();
    shows(&svg, &modes);
    assert_eq!(svg.as_str().matches("<animate ").count(), 42 + time_series.elements().len());
    // 41 frames of the same commands.
    let path = svg.as_str().split("attributeName=\"d\"").nth(1).unwrap();
    let values = path.split("values=\"").nth(1).unwrap().split('"').next().unwrap();
    let commands = |path: &str| path.chars().filter(char::is_ascii_alphabetic).collect::<String>();
    assert_eq!(values.split(';').count(), 41);
    assert!(values.split(';').all(|path| commands(path) == "MLLLZ"));

    let spectrum =
        el_centro_1940().response_spectrum(&[0.1, 0.5, 2.0], 0.05, &mut unobserved).unwrap();
    let svg = plot::spectra("Spectra", &[("El Centro", &spectrum)]).unwrap();
    shows(&svg, &["period, s", "pseudo-acceleration, m/s²", "El Centro"]);
}

#[test]
fn sites_show_speeds_strains_and_spectra() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let rock = SoilProfile::on_half_plane(Soil::from_shear_wave_speed(900.0, 0.3, 2200.0).unwrap());
    let site = rock.with_layer(soil, 4.0).unwrap().with_layer(soil, 5.0).unwrap();
    let column = SoilColumn::new(site, VerticalWave::Shear).unwrap();
    let curves = [StrainCurves::Epri { depth: 2.0 }, StrainCurves::Epri { depth: 6.5 }];
    let record = el_centro_1940();
    let spectrum = record.response_spectrum(&[0.1, 0.5, 2.0], 0.05, &mut unobserved).unwrap();
    // Strains of some tenths of a per cent, of 1e-12, none.
    for factor in [1.0, 1e-9, 0.0] {
        let motion = record.scaled(factor).unwrap();
        let found = column
            .equivalent_linear(
                &motion,
                &curves,
                &EquivalentLinearOptions::default(),
                &mut unobserved,
            )
            .unwrap();
        let svg = plot::site_response("Site", &found, &[("El Centro", &spectrum)]).unwrap();
        shows(&svg, &["Site", "c_S, m/s", "strain, %", "y, m", "period, s"]);
        shows(&svg, &["speed at small strain", "strain-compatible speed", "effective strain"]);
        assert!(matches!(plot::site_response("S", &found, &[]), Err(Error::Size { .. })));
    }
}

#[test]
fn odd_values_are_pictures_or_errors() {
    let curve = |points: &[(f64, f64)]| {
        plot::curves("T", "x", "y", &[Curve { name: "n".into(), points: points.to_vec() }])
    };
    assert!(matches!(curve(&[]), Err(Error::Size { .. })));
    assert!(matches!(plot::curves("T", "x", "y", &[]), Err(Error::Size { .. })));
    for points in [
        vec![(0.0, 1.0)],
        vec![(0.0, 0.0), (1.0, 0.0)],
        vec![(0.0, f64::NAN), (f64::INFINITY, 2.0), (1.0, 3.0), (2.0, f64::NEG_INFINITY)],
        vec![(0.0, 1e-300), (1.0, 2e-300)],
        vec![(0.0, 1e12), (1.0, 1e12 + 1.0)],
        vec![(f64::NAN, f64::NAN)],
    ] {
        words(&curve(&points).unwrap());
    }
    // Too large to be drawn: left out.
    words(&curve(&[(0.0, -f64::MAX), (1.0, f64::MAX), (2.0, 1.0)]).unwrap());

    let ordinate = |period: f64, value: f64| SpectralOrdinate {
        period,
        displacement: 0.0,
        pseudo_velocity: 0.0,
        pseudo_acceleration: value,
        acceleration: 0.0,
    };
    assert!(matches!(plot::spectra("T", &[]), Err(Error::Size { .. })));
    for period in [0.0, -1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY] {
        assert!(plot::spectra("T", &[("a", &[ordinate(period, 1.0)])]).is_err());
    }
    for spectrum in [vec![ordinate(1.0, 1.0)], vec![ordinate(0.1, 0.0), ordinate(1.0, f64::NAN)]] {
        words(&plot::spectra("T", &[("a", &spectrum)]).unwrap());
    }
}

#[test]
fn bad_requests_are_errors() {
    let (time_series, shape) = recorded(Recorder::new());
    assert!(matches!(plot::mode_map("T", &time_series), Err(Error::Scene { .. })));
    let shapes = |time_series, times: &[f64], scale| {
        plot::deformed_shapes("T", &shape, time_series, times, scale)
    };
    assert!(matches!(shapes(&time_series, &[0.1], 1.0), Err(Error::Scene { .. })));
    assert!(plot::animation("T", &shape, &time_series, 1.0, 1.0).is_err());
    let runs = [("a", &time_series)];
    let fault = plot::probe_time_series("T", &runs, "nobody");
    assert!(matches!(fault, Err(Error::Name { .. })));
    // A folder cannot be made beneath a file.
    let nowhere = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml/picture.svg");
    let fault = plot::time_series("T", &runs, Quantity::BaseShear).unwrap().save(nowhere);
    assert!(is_unwritable(&fault));
    let with = |probe| {
        let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(0.35));
        let simulation = builder.probe(probe).build().unwrap();
        Recorder::new().start(&simulation).unwrap()
    };
    let turn = || Probe::displacement("turn", RigidBlock::ROTATION);
    let [length, angle] = [with(turn()), with(turn().in_unit("rad"))];
    let svg = plot::probe_time_series("T", &[("a", &angle)], "turn").unwrap();
    assert!(svg.as_str().contains("turn, mrad"));
    let fault = plot::probe_time_series("T", &[("a", &angle), ("b", &length)], "turn");
    assert!(matches!(fault, Err(Error::Scene { .. })));

    let (time_series, shape) = recorded(Recorder::new().motion(1));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(plot::deformed_shapes("T", &shape, &time_series, &[0.1], value).is_err());
        assert!(plot::animation("T", &shape, &time_series, value, 1.0).is_err());
        assert!(plot::animation("T", &shape, &time_series, 1.0, value).is_err());
    }
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[], 1.0).is_err());
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[f64::NAN], 1.0).is_err());
    let fault = plot::deformed_shapes("T", &shape, &time_series, &[0.4], f64::MAX);
    assert!(matches!(fault, Err(Error::Input { .. })));
    // Far away is the nearest instant.
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[1e9], 1.0).is_ok());
}

/// Names that no sheet is wide enough for.
fn long(words: &str) -> String {
    format!("{} and its end", words.repeat(20))
}

#[test]
fn every_text_can_be_read_whatever_is_drawn() {
    let title = long("base shear of a tower ");
    let many = |count: usize, from: f64, to: f64| -> Vec<Curve> {
        (0..count)
            .map(|k| Curve {
                name: format!("{k} {}", if k % 3 == 0 { long("friction ") } else { "run".into() }),
                points: vec![(from, from), (to, to + (to - from) * k as f64)],
            })
            .collect()
    };
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
            let label = long("displacement, mm ");
            let svg = plot::curves(&title, &label, &label, &many(count, from, to)).unwrap();
            assert_readable(svg.as_str(), &format!("{count} curves, {from} to {to}"));
            shows(&svg, &["…"]);
        }
    }
    let svg = plot::curves("T", "x", "y", &many(44, 0.0, 1.0)).unwrap();
    shows(&svg, &["41 run", "… and 2 more"]);
    // More curves than colours: curves of one colour have different signs.
    let svg = plot::curves("T", "x", "y", &many(15, 0.0, 1.0)).unwrap();
    let signs = |color: &str| {
        let polygons = svg.as_str().split("<polygon").skip(1);
        polygons.filter(|tag| tag.split('>').next().unwrap().contains(color)).count()
    };
    // Nine on the curve and one in the key; a straight line of two points has two.
    assert_eq!(["#1F77B4", "#D62728", "#17BECF"].map(signs), [3 + 3, 3, 3]);

    let ordinate = |period: f64| SpectralOrdinate {
        period,
        displacement: 0.0,
        pseudo_velocity: 0.0,
        pseudo_acceleration: 900.0,
        acceleration: 0.0,
    };
    for (from, to) in [(0.05, 2.0), (1e-6, 1e6), (0.3, 0.3), (1.0, 1.001), (0.02, 10.0)] {
        let spectrum = [ordinate(from), ordinate(to)];
        let name = long("storey ");
        let list = [(name.as_str(), &spectrum[..]); 9];
        let svg = plot::spectra(&title, &list).unwrap();
        assert_readable(svg.as_str(), &format!("spectra from {from} to {to}"));
    }
    let svg = plot::spectra("T", &[("a", &[ordinate(0.05), ordinate(2.0)])]).unwrap();
    let words = words(&svg);
    for mark in ["0.05", "0.1", "0.5", "1", "2"] {
        assert_eq!(words.split_whitespace().filter(|word| *word == mark).count(), 1, "{mark}");
    }
}

/// Blocks of 4 m, so far apart.
fn apart(distances: &[f64]) -> (TimeSeries, DeformedShape, Run) {
    let mut group = StructureGroup::new().with(block(SI), 0.0).unwrap();
    let mut strips = vec![Strip::uniform(-2.0..2.0, 4).unwrap()];
    let single = DeformedShape::of_block(&block(SI), 6.0).unwrap();
    let (mut points, mut cells) = (single.points().to_vec(), single.cells().to_vec());
    for (k, distance) in distances.iter().enumerate() {
        group = group.with(block(SI), *distance).unwrap();
        strips.push(Strip::uniform(distance - 2.0..distance + 2.0, 4).unwrap());
        let first = points.len();
        let shift = |row: &DofCombination| {
            row.into_iter().map(|(unknown, weight)| (unknown + 3 * (k + 1), *weight)).collect()
        };
        let moved = single.points().iter().map(|point| ShapePoint {
            position: [point.position[0] + distance, point.position[1]],
            horizontal: shift(&point.horizontal),
            vertical: shift(&point.vertical),
            ..ShapePoint::default()
        });
        points.extend(moved);
        cells.extend(single.cells().iter().map(|cell| cell.iter().map(|k| k + first).collect()));
    }
    let ground = ElasticGround::new(scenes::soil(SI), &strips).unwrap();
    let scene = scene(SI, 0.6).structure(group).ground(ground).interface(friction(0.35));
    let mut simulation = scene.build().unwrap();
    let recorder = Recorder::new().contact(4).motion(4);
    let mut time_series = recorder.start(&simulation).unwrap();
    let run = simulation.run(160, |state| time_series.record(state)).unwrap();
    (time_series, DeformedShape::new(points, cells).unwrap(), run)
}

#[test]
fn foundations_far_apart_leave_no_sheet_blank() {
    let title = long("two blocks ");
    for distances in [&[40.0][..], &[4.3], &[9.0, 1000.0, 1007.0, 1_000_000.0]] {
        let (time_series, shape, run) = apart(distances);
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
    let (time_series, ..) = apart(&[40.0]);
    let svg = plot::mode_map("Far", &time_series).unwrap();
    shows(&svg, &["gap 36 m", "-2", "38", "42"]);
    // Elements are 1 m high of 8.8 m between the axes.
    let heights = svg.as_str().split("<rect").filter(|tag| tag.contains("#D6DEE4")).map(|tag| {
        let value = tag.split("height=\"").nth(1).unwrap().split('"').next().unwrap();
        value.parse::<f64>().unwrap()
    });
    assert!(heights.fold(0.0, f64::max) > 40.0);
}

/// GOAL: with infinite friction nothing is shown to slide; what the law's modes of slip are there
/// for, touching without a pressure, is.
#[test]
fn nothing_slides_with_infinite_friction() {
    let law = Coulomb::uplift_only();
    let mut simulation = scene(SI, 0.6).structure(block(SI)).interface(law).build().unwrap();
    let mut time_series = Recorder::new().contact(1).start(&simulation).unwrap();
    simulation.run(400, |state| time_series.record(state)).unwrap();
    let slips = |mode: &Mode| matches!(mode, Mode::SlipLeft | Mode::SlipRight);
    let svg = plot::mode_map("T", &time_series).unwrap();
    // Colours that occur only in the key.
    for color in ["#FFA62B", "#D62728"] {
        assert_eq!(svg.as_str().matches(color).count(), 1, "{color}");
    }
    let occurs = time_series.contact_frames().any(|frame| frame.modes.iter().any(slips));
    assert_eq!(words(&svg).contains("touching without pressure"), occurs);
    assert!(occurs);
}

/// Signs that XML does not know come from names in files of others.
#[test]
fn control_characters_leave_a_picture_valid() {
    let signs: String =
        (0..32).chain([0x7f, 0x85, 0xfffe, 0xffff]).filter_map(char::from_u32).collect();
    let (time_series, shape, run) = ran(Recorder::new().motion(20));
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

/// A page of one run: motion, model, peaks beside the fixed base, first mode and pictures, all inside one file.
#[test]
fn a_page_holds_motion_model_peaks_and_pictures() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let scene = || {
        let building = ShearBuilding::new(8.0, 20.0e3, 1.0e5, &[Storey::new(9.0, 80.0e3, 8.0e6)])?;
        Ok(Simulation::builder(0.01)
            .ground(ElasticGround::under(soil, &building, 8)?)
            .probe(Probe::displacement("drift <1>", building.drift(0)?))
            .structure(building.with_stiffness_damping(0.05)?)
            .interface(Coulomb::new(0.5)?)
            .motion(el_centro_1940()))
    };
    let found = interaction(3.0, scene).unwrap();
    let mut simulation = scene().unwrap().build().unwrap();
    let mut series = Recorder::new().start(&simulation).unwrap();
    simulation.run(300, |state| series.record(state)).unwrap();
    let text = format!("{}\n{}\n{found}", SoilProfile::on_half_plane(soil), found.on_ground);
    let runs = [("on the ground", &series)];
    let pictures = [Quantity::BaseShear, Quantity::BaseMoment]
        .map(|quantity| plot::time_series("Run 7", &runs, quantity).unwrap());
    let page = plot::page("Run 7 & its \"fixed base\"", &text, &pictures);

    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("<title>Run 7 &amp; its"), "{page}");
    let shown = page.split_once("<pre>").unwrap().1.split_once("</pre>").unwrap().0;
    for line in text.lines().filter(|line| !line.contains(['<', '>', '&', '"', '\''])) {
        assert!(shown.contains(line), "{line}");
    }
    // Motion, model, fixed base.
    let peak = format!("Ground motion: peak {:.3}", found.on_ground.ground_motion.peak);
    for words in [&peak, "Weight on the base: 980", "fixed base", "T̃/T = ", "drift &lt;1&gt;"] {
        assert!(shown.contains(words), "{words} in {shown}");
    }
    // The last table has each peak on the ground, on the fixed base, and their ratio.
    let table = shown.split_once("fixed base").unwrap().1;
    for (name, quantity) in
        [("base shear", Quantity::BaseShear), ("base moment", Quantity::BaseMoment)]
    {
        let line = table.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        let mut numbers = line.split_whitespace().rev();
        let mut next = || numbers.next().unwrap().parse::<f64>().unwrap();
        let (ratio, fixed, ground) = (next(), next(), next());
        let known = 1e-3 * found.on_fixed_base.whole.extremes(quantity).magnitude();
        assert!((fixed / known - 1.0).abs() < 2e-3, "{line}");
        assert!((ground / fixed / found.ratio(quantity) - 1.0).abs() < 4e-3, "{line}");
        assert!((ratio - found.ratio(quantity)).abs() < 1e-3, "{line}");
    }
    // Pictures stand in the page, whole, and nothing is loaded from elsewhere.
    for picture in &pictures {
        assert!(page.contains(picture.as_str()));
    }
    for word in ["<img", "<script", "<link", "href=", "src=", "url("] {
        assert!(!page.contains(word), "{word}");
    }
}
