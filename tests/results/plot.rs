//! GOAL: pictures are well-formed and legible, show what they must, and return errors for what cannot be
//! shown.
//! SCENE: every picture, with usual and odd values.
//! REFERENCE: the tags and texts of the SVG, laid out here.

use basemat::analyses::interaction;
use basemat::bem::ElasticGround;
use basemat::coupled::{Probe, SimulationBuilder};
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::motion::{SpectralOrdinate, el_centro_1940};
use basemat::plot::{self, Curve, Svg};
use basemat::results::Run;
use basemat::results::{DeformedShape, Quantity, Recorder, TimeSeries};
use basemat::site::{EquivalentLinearOptions, SoilColumn, VerticalWave};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::structure::{RigidBlock, ShearBuilding, Storey};
use basemat::{Error, Result, Simulation, Soil, unobserved};
use basemat_problems::faults::is_unwritable;

use crate::results::layout::assert_readable;
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

/// A run, and the data for its pictures.
pub(super) struct PlottedRun {
    pub(super) time_series: TimeSeries,
    pub(super) shape: DeformedShape,
    pub(super) run: Run,
}

pub(super) fn rocking_block(recorder: Recorder) -> PlottedRun {
    let shape = DeformedShape::of_block(&block(SI_UNITS), 6.0).unwrap();
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(friction(0.35));
    let mut simulation = builder.build().unwrap();
    let mut time_series = recorder.start(&simulation).unwrap();
    let run = simulation.run(200, |state| time_series.record(state)).unwrap();
    PlottedRun { time_series, shape, run }
}

/// Words of the picture; its tags must be nested, its numbers finite and its texts readable.
pub(super) fn words(svg: &Svg) -> String {
    let text = svg.as_str();
    assert_readable(text, "picture");
    assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"));
    let mut open_tags = Vec::new();
    let mut words = String::new();
    for piece in text.split('<').skip(1) {
        let (tag, rest) = piece.split_once('>').unwrap();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open_tags.pop(), Some(closed));
        } else if !tag.ends_with('/') {
            open_tags.push(tag.split_whitespace().next().unwrap());
        }
        words += rest.trim();
        words.push(' ');
    }
    assert!(open_tags.is_empty());
    words
}

pub(super) fn shows(svg: &Svg, needed: &[&str]) {
    let words = words(svg);
    for word in needed {
        assert!(words.contains(word), "{word} in {words}");
    }
}

/// The commands of a path without their numbers.
fn path_commands(path: &str) -> String {
    path.chars().filter(char::is_ascii_alphabetic).collect()
}

#[test]
fn every_picture_has_title_labels_units_and_legend() {
    let PlottedRun { time_series, shape, run } =
        rocking_block(Recorder::new().contact(1).motion(5));
    let runs = [("one", &time_series), ("two", &time_series)];
    for quantity in Quantity::recorded(false) {
        let svg = plot::time_series("Title", &runs, quantity).unwrap();
        shows(&svg, &["Title", "time, s", quantity.name(), "one", "two"]);
    }
    let svg = plot::time_series("Title", &runs, Quantity::SlidingSafety).unwrap();
    shows(&svg, &["1 / factor of safety against sliding", "1: sliding"]);
    // Without a friction coefficient the picture has no friction demand.
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(Bonded);
    let mut simulation = builder.build().unwrap();
    let mut bonded = Recorder::new().start(&simulation).unwrap();
    simulation.run(50, |state| bonded.record(state)).unwrap();
    let svg = plot::time_series("Title", &[("bonded", &bonded)], Quantity::SlidingSafety).unwrap();
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
    // The path, the bar of time and 40 times move. The base does not: its frames are not those of the structure.
    assert_eq!(svg.as_str().matches("<animate ").count(), 2 + 40);
    shows(&svg, &["t = 0.00 s", "t = 0.49 s", "structure: 2 m", "displacements: 100 mm", "× 20"]);
    let PlottedRun { time_series, shape, .. } = rocking_block(Recorder::new().contact(5).motion(5));
    let svg = plot::animation("Block", &shape, &time_series, 20.0, 1.0).unwrap();
    shows(&svg, &modes);
    assert_eq!(svg.as_str().matches("<animate ").count(), 42 + time_series.elements().len());
    // 41 frames of the same commands.
    let path = svg.as_str().split("attributeName=\"d\"").nth(1).unwrap();
    let values = path.split("values=\"").nth(1).unwrap().split('"').next().unwrap();
    assert_eq!(values.split(';').count(), 41);
    assert!(values.split(';').all(|path| path_commands(path) == "MLLLZ"));

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
    // Strains of some tenths of a per cent, of 1e-12, and zero.
    for factor in [1.0, 1e-9, 0.0] {
        let motion = record.scaled(factor).unwrap();
        let computed = column
            .equivalent_linear(
                &motion,
                &curves,
                &EquivalentLinearOptions::default(),
                &mut unobserved,
            )
            .unwrap();
        let svg = plot::site_response("Site", &computed, &[("El Centro", &spectrum)]).unwrap();
        shows(&svg, &["Site", "c_S, m/s", "strain, %", "y, m", "period, s"]);
        shows(&svg, &["speed at small strain", "strain-compatible speed", "effective strain"]);
        assert!(matches!(plot::site_response("S", &computed, &[]), Err(Error::Size { .. })));
    }
}

fn curve_picture(points: &[(f64, f64)]) -> Result<Svg> {
    plot::curves("T", "x", "y", &[Curve { name: "n".into(), points: points.to_vec() }])
}

pub(super) fn spectral_ordinate(period: f64, pseudo_acceleration: f64) -> SpectralOrdinate {
    SpectralOrdinate {
        period,
        displacement: 0.0,
        pseudo_velocity: 0.0,
        pseudo_acceleration,
        acceleration: 0.0,
    }
}

#[test]
fn odd_values_are_pictures_or_errors() {
    assert!(matches!(curve_picture(&[]), Err(Error::Size { .. })));
    assert!(matches!(plot::curves("T", "x", "y", &[]), Err(Error::Size { .. })));
    for points in [
        vec![(0.0, 1.0)],
        vec![(0.0, 0.0), (1.0, 0.0)],
        vec![(0.0, f64::NAN), (f64::INFINITY, 2.0), (1.0, 3.0), (2.0, f64::NEG_INFINITY)],
        vec![(0.0, 1e-300), (1.0, 2e-300)],
        vec![(0.0, 1e12), (1.0, 1e12 + 1.0)],
        vec![(f64::NAN, f64::NAN)],
    ] {
        words(&curve_picture(&points).unwrap());
    }
    // Values too large for a picture are left out.
    words(&curve_picture(&[(0.0, -f64::MAX), (1.0, f64::MAX), (2.0, 1.0)]).unwrap());

    assert!(matches!(plot::spectra("T", &[]), Err(Error::Size { .. })));
    for period in [0.0, -1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY] {
        assert!(plot::spectra("T", &[("a", &[spectral_ordinate(period, 1.0)])]).is_err());
    }
    for spectrum in [
        vec![spectral_ordinate(1.0, 1.0)],
        vec![spectral_ordinate(0.1, 0.0), spectral_ordinate(1.0, f64::NAN)],
    ] {
        words(&plot::spectra("T", &[("a", &spectrum)]).unwrap());
    }
}

/// Time series of a block with a probe, before its first step.
fn recorded_probe(probe: Probe) -> TimeSeries {
    let builder = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(friction(0.35));
    let simulation = builder.probe(probe).build().unwrap();
    Recorder::new().start(&simulation).unwrap()
}

#[test]
fn invalid_requests_are_errors() {
    let PlottedRun { time_series, shape, .. } = rocking_block(Recorder::new());
    assert!(matches!(plot::mode_map("T", &time_series), Err(Error::Scene { .. })));
    let fault = plot::deformed_shapes("T", &shape, &time_series, &[0.1], 1.0);
    assert!(matches!(fault, Err(Error::Scene { .. })));
    assert!(plot::animation("T", &shape, &time_series, 1.0, 1.0).is_err());
    let runs = [("a", &time_series)];
    let fault = plot::probe_time_series("T", &runs, "nobody");
    assert!(matches!(fault, Err(Error::Name { .. })));
    // A folder cannot be made beneath a file.
    let impossible_path = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml/picture.svg");
    let fault = plot::time_series("T", &runs, Quantity::BaseShear).unwrap().save(impossible_path);
    assert!(is_unwritable(&fault));
    let turn = Probe::displacement("turn", RigidBlock::ROTATION_DOF);
    let length = recorded_probe(turn.clone());
    let angle = recorded_probe(turn.in_unit("rad"));
    let svg = plot::probe_time_series("T", &[("a", &angle)], "turn").unwrap();
    assert!(svg.as_str().contains("turn, mrad"));
    let fault = plot::probe_time_series("T", &[("a", &angle), ("b", &length)], "turn");
    assert!(matches!(fault, Err(Error::Scene { .. })));

    let PlottedRun { time_series, shape, .. } = rocking_block(Recorder::new().motion(1));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(plot::deformed_shapes("T", &shape, &time_series, &[0.1], value).is_err());
        assert!(plot::animation("T", &shape, &time_series, value, 1.0).is_err());
        assert!(plot::animation("T", &shape, &time_series, 1.0, value).is_err());
    }
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[], 1.0).is_err());
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[f64::NAN], 1.0).is_err());
    let fault = plot::deformed_shapes("T", &shape, &time_series, &[0.4], f64::MAX);
    assert!(matches!(fault, Err(Error::Input { .. })));
    // A distant time is replaced by the nearest instant.
    assert!(plot::deformed_shapes("T", &shape, &time_series, &[1e9], 1.0).is_ok());
}

/// GOAL: with infinite friction no element is shown to slide; modes of slip are shown as touching without pressure.
#[test]
fn nothing_slides_with_infinite_friction() {
    let law = Coulomb::uplift_only();
    let mut simulation =
        scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law).build().unwrap();
    let mut time_series = Recorder::new().contact(1).start(&simulation).unwrap();
    simulation.run(400, |state| time_series.record(state)).unwrap();
    let svg = plot::mode_map("T", &time_series).unwrap();
    // Colours that occur only in the key.
    for color in ["#FFA62B", "#D62728"] {
        assert_eq!(svg.as_str().matches(color).count(), 1, "{color}");
    }
    let occurs = time_series.contact_frames().any(|frame| {
        frame.modes.iter().any(|mode| matches!(mode, Mode::SlipLeft | Mode::SlipRight))
    });
    assert_eq!(words(&svg).contains("touching without pressure"), occurs);
    assert!(occurs);
}

/// A building of one storey on elastic ground under El Centro.
fn building_on(soil: Soil) -> Result<SimulationBuilder> {
    let building = ShearBuilding::new(8.0, 20.0e3, 1.0e5, &[Storey::new(9.0, 80.0e3, 8.0e6)])?;
    Ok(Simulation::builder(0.01)
        .ground(ElasticGround::under(soil, &building, 8)?)
        .probe(Probe::displacement("drift <1>", building.drift(0)?))
        .structure(building.with_stiffness_damping(0.05)?)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940()))
}

/// A page of one run: motion, model, peaks beside the fixed base, first mode and pictures, all inside one file.
#[test]
fn a_page_has_motion_model_peaks_and_pictures() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let computed = interaction(3.0, || building_on(soil)).unwrap();
    let mut simulation = building_on(soil).unwrap().build().unwrap();
    let mut series = Recorder::new().start(&simulation).unwrap();
    simulation.run(300, |state| series.record(state)).unwrap();
    let text = format!("{}\n{}\n{computed}", SoilProfile::on_half_plane(soil), computed.on_ground);
    let runs = [("on the ground", &series)];
    let pictures = [Quantity::BaseShear, Quantity::BaseMoment]
        .map(|quantity| plot::time_series("Run 7", &runs, quantity).unwrap());
    let page = plot::page("Run 7 & its \"fixed base\"", &text, &pictures);

    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("<title>Run 7 &amp; its"), "{page}");
    let page_text = page.split_once("<pre>").unwrap().1.split_once("</pre>").unwrap().0;
    for line in text.lines().filter(|line| !line.contains(['<', '>', '&', '"', '\''])) {
        assert!(page_text.contains(line), "{line}");
    }
    // The page has the motion, the model and the fixed base.
    let peak = format!("Ground motion: peak {:.3}", computed.on_ground.ground_motion.peak);
    for words in [&peak, "Weight on the base: 980", "fixed base", "T̃/T = ", "drift &lt;1&gt;"] {
        assert!(page_text.contains(words), "{words} in {page_text}");
    }
    // The last table has each peak on the ground, on the fixed base, and their ratio.
    let table = page_text.split_once("fixed base").unwrap().1;
    for (name, quantity) in
        [("base shear", Quantity::BaseShear), ("base moment", Quantity::BaseMoment)]
    {
        let line = table.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        let cells = line.split_whitespace().rev().take(3);
        let numbers: Vec<f64> = cells.map(|cell| cell.parse().unwrap()).collect();
        let ratio = numbers[0];
        let fixed = numbers[1];
        let ground = numbers[2];
        let expected = 1e-3 * computed.on_fixed_base.whole.extremes(quantity).magnitude();
        assert!((fixed / expected - 1.0).abs() < 2e-3, "{line}");
        assert!((ground / fixed / computed.ratio(quantity) - 1.0).abs() < 4e-3, "{line}");
        assert!((ratio - computed.ratio(quantity)).abs() < 1e-3, "{line}");
    }
    // Pictures are complete in the page, and nothing is loaded from elsewhere.
    for picture in &pictures {
        assert!(page.contains(picture.as_str()));
    }
    for word in ["<img", "<script", "<link", "href=", "src=", "url("] {
        assert!(!page.contains(word), "{word}");
    }
}
