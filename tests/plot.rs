//! Pictures: well-formed, with what they must show, and typed errors for what cannot be shown.
#![cfg(feature = "plot")]

#[path = "support/scenes.rs"]
mod scenes;

use basemat::coupled::Probe;
use basemat::motion::{SpectralOrdinate, el_centro_1940};
use basemat::plot::{self, Curve, Svg};
use basemat::results::{Histories, Quantity, Recorder, Wireframe};
use basemat::structure::RigidBlock;
use basemat::{Error, Simulation};
use scenes::{SI, block, friction, scene};

fn simulation() -> (Simulation, Wireframe) {
    let shape = Wireframe::of_block(&block(SI), 6.0).unwrap();
    (scene(SI, 0.6).structure(block(SI)).interface(friction(0.35)).build().unwrap(), shape)
}

fn recorded(recorder: Recorder) -> (Histories, Wireframe) {
    let (mut simulation, shape) = simulation();
    let mut histories = recorder.start(&simulation).unwrap();
    histories.run(&mut simulation, 200).unwrap();
    (histories, shape)
}

/// Words of the picture; its tags must be nested and its numbers finite.
fn words(svg: &Svg) -> String {
    let text = svg.as_str();
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
    let (histories, shape) = recorded(Recorder::new().contact(1).motion(5));
    let runs = [("one", &histories), ("two", &histories)];
    for quantity in Quantity::ALL {
        let svg = plot::history("Title", &runs, quantity).unwrap();
        shows(&svg, &["Title", "time, s", quantity.name(), "one", "two"]);
    }
    let svg = plot::history("a < b & c", &runs, Quantity::BaseMoment).unwrap();
    shows(&svg, &["a &lt; b &amp; c"]);
    shows(&svg, &["base moment, kN·m/m"]);
    let modes = ["stick", "slip to the left", "slip to the right", "open"];
    let svg = plot::mode_map("Modes", &histories).unwrap();
    shows(&svg, &modes);
    shows(&svg, &["x along the base, m", "time, s"]);
    // Each of the modes has its stretches (and its key).
    for color in ["#D6DEE4", "#FFA62B", "#D62728", "#164878"] {
        assert!(svg.as_str().matches(color).count() > 2, "{color}");
    }
    let svg = plot::pressure_envelope("Pressure", &histories).unwrap();
    shows(&svg, &["pressure, kPa", "largest", "static", "least"]);
    let svg = plot::energy("Energy", &histories).unwrap();
    shows(&svg, &["energy, kJ/m", "input", "friction and impact", "soil"]);
    // A rigid block has no dampers.
    assert!(!words(&svg).contains("damping"));
    let svg = plot::deformed_shapes("Shape", &shape, &histories, &[0.1, 0.4], 20.0).unwrap();
    shows(&svg, &["Shape, displacements × 20", "at rest", "t = 0.10 s", "t = 0.40 s", "y, m"]);
    let svg = plot::animation("A < B & C", &shape, &histories, 20.0, 1.0).unwrap();
    shows(&svg, &["A &lt; B &amp; C"]);
    // One path and one bar of time; no base, for its frames are others than the structure's.
    assert_eq!(svg.as_str().matches("<animate ").count(), 2);
    let (histories, shape) = recorded(Recorder::new().contact(5).motion(5));
    let svg = plot::animation("Block", &shape, &histories, 20.0, 1.0).unwrap();
    shows(&svg, &modes);
    assert_eq!(svg.as_str().matches("<animate ").count(), 2 + histories.elements().len());
    // 41 frames of the same commands.
    let values = svg.as_str().split("values=\"").nth(1).unwrap().split('"').next().unwrap();
    let commands = |path: &str| path.chars().filter(char::is_ascii_alphabetic).collect::<String>();
    assert_eq!(values.split(';').count(), 41);
    assert!(values.split(';').all(|path| commands(path) == "MLLLZ"));

    let spectrum = el_centro_1940().response_spectrum(&[0.1, 0.5, 2.0], 0.05).unwrap();
    let svg = plot::spectra("Spectra", &[("El Centro", &spectrum)]).unwrap();
    shows(&svg, &["period, s", "pseudo-acceleration, m/s²", "El Centro"]);
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
    let (histories, shape) = recorded(Recorder::new());
    assert!(matches!(plot::mode_map("T", &histories), Err(Error::Scene { .. })));
    let shapes = |histories, times: &[f64], scale| {
        plot::deformed_shapes("T", &shape, histories, times, scale)
    };
    assert!(matches!(shapes(&histories, &[0.1], 1.0), Err(Error::Scene { .. })));
    assert!(plot::animation("T", &shape, &histories, 1.0, 1.0).is_err());
    let runs = [("a", &histories)];
    let fault = plot::probe_history("T", &runs, "nobody");
    assert!(matches!(fault, Err(Error::Name { .. })));
    // A folder cannot be made beneath a file.
    let nowhere = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml/picture.svg");
    let fault = plot::history("T", &runs, Quantity::BaseShear).unwrap().save(nowhere);
    assert!(matches!(fault, Err(Error::Write { .. })));
    let with = |probe| {
        let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(0.35));
        let simulation = builder.probe(probe).build().unwrap();
        Recorder::new().start(&simulation).unwrap()
    };
    let turn = || Probe::displacement("turn", RigidBlock::ROTATION);
    let [length, angle] = [with(turn()), with(turn().in_unit("rad"))];
    let svg = plot::probe_history("T", &[("a", &angle)], "turn").unwrap();
    assert!(svg.as_str().contains("turn, mrad"));
    let fault = plot::probe_history("T", &[("a", &angle), ("b", &length)], "turn");
    assert!(matches!(fault, Err(Error::Scene { .. })));

    let (histories, shape) = recorded(Recorder::new().motion(1));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(plot::deformed_shapes("T", &shape, &histories, &[0.1], value).is_err());
        assert!(plot::animation("T", &shape, &histories, value, 1.0).is_err());
        assert!(plot::animation("T", &shape, &histories, 1.0, value).is_err());
    }
    assert!(plot::deformed_shapes("T", &shape, &histories, &[], 1.0).is_err());
    assert!(plot::deformed_shapes("T", &shape, &histories, &[f64::NAN], 1.0).is_err());
    let fault = plot::deformed_shapes("T", &shape, &histories, &[0.4], f64::MAX);
    assert!(matches!(fault, Err(Error::Input { .. })));
    // Far away is the nearest instant.
    assert!(plot::deformed_shapes("T", &shape, &histories, &[1e9], 1.0).is_ok());
}
