//! GOAL: pictures of rocking have units and a key, show measured points beside the paths, and return errors for mixed
//! units.
//! SCENE: a block on springs that yield under a slow moment; a body in space; measured points, some of them not finite.
//! REFERENCE: the tags and texts of the SVG, laid out here.

use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::Load;
use basemat::interface::{Bonded, Yielding};
use basemat::plot::{self, Curve, Svg};
use basemat::results::{Recorder, TimeSeries};
use basemat::structure::{DofCombination, RigidBlock, RigidBody};
use basemat::{Error, Simulation};

use super::plot::{shows, words};

/// Colour of the first measured points.
const MEASURED_COLOR: &str = "#5A5A5A";

fn settling_block() -> TimeSeries {
    let moment = |time: f64| 4.4e5 * (std::f64::consts::TAU * time / 4.0).sin();
    let mut simulation = Simulation::builder(0.01)
        .structure(RigidBlock::new(4.0, 5.0, 2000.0).unwrap())
        .ground(SpringGround::new(-2.0..2.0, 20, 4e7, 4e7).unwrap())
        .interface(Yielding::new(2.5e5, 0.6).unwrap())
        .load(Load::new(DofCombination::from(2), moment))
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    simulation.run(1000, |state| time_series.record(state)).unwrap();
    time_series
}

fn body_in_space() -> TimeSeries {
    let plan = Plan::rectangle(-2.0..2.0, -1.0..1.0, 2).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(RigidBody::cuboid([4.0, 2.0, 3.0], 2000.0).unwrap())
        .ground(SpringGround::in_plan(plan, [4e7; 3]).unwrap())
        .interface(Bonded)
        .load(Load::new(DofCombination::from(3), |time| 1e5 * time))
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    simulation.run(20, |state| time_series.record(state)).unwrap();
    time_series
}

fn measured(name: &str, points: &[(f64, f64)]) -> Curve {
    Curve { name: name.to_owned(), points: points.to_vec() }
}

fn occurrences(svg: &Svg, text: &str) -> usize {
    svg.as_str().matches(text).count()
}

#[test]
fn paths_and_measured_points_are_drawn_with_their_units() {
    let time_series = settling_block();
    let rocking = time_series.rocking(0).unwrap();
    let runs = [("model", rocking), ("its last cycle", rocking.between(5.0..9.0).unwrap())];
    let points = [(2e-3, 3e5), (4e-3, 3.5e5), (f64::NAN, 1e5), (-3e-3, -3.2e5)];
    let points = [measured("centrifuge, packet a", &points), measured("b", &points[..1])];
    let moments = plot::moment_rotation("Footing < 3 m", &runs, &points).unwrap();
    let key = ["model", "its last cycle", "centrifuge, packet a", "b"];
    shows(&moments, &["Footing &lt; 3 m", "base rotation, mrad", "base moment, kN·m/m"]);
    shows(&moments, &key);
    // Three points that are finite, and one in the key.
    assert_eq!(occurrences(&moments, MEASURED_COLOR), 3 + 1);
    let picture_of_one_run = plot::moment_rotation("T", &runs[..1], &[]).unwrap();
    assert_eq!(occurrences(&picture_of_one_run, MEASURED_COLOR), 0);

    let points = [measured("centrifuge", &[(1e-3, 0.02), (2e-3, 0.05)])];
    let settlements = plot::settlement_rotation("T", &runs, &points).unwrap();
    shows(&settlements, &["base rotation, mrad", "settlement, mm", "centrifuge"]);
    assert_eq!(occurrences(&settlements, MEASURED_COLOR), 2 + 1);
    // Settlement increases downwards: the mark of 50 mm stands below that of zero.
    let heights = ["0", "50"].map(|mark| mark_height(&settlements, mark));
    assert!(heights[1] > heights[0] + 100.0, "{heights:?}");
}

/// y of the last text `mark` that stands at the left of the picture, pixels.
fn mark_height(svg: &Svg, mark: &str) -> f64 {
    let number = |tag: &str, name: &str| -> f64 {
        let rest = tag.split(&format!(" {name}=\"")).nth(1).unwrap();
        rest.split('"').next().unwrap().parse().unwrap()
    };
    let texts = svg.as_str().split("<text").skip(1).filter_map(|text| {
        let (tag, rest) = text.split_once('>')?;
        let words = rest.split('<').next()?.trim();
        (words == mark && number(tag, "x") < 104.0).then(|| number(tag, "y"))
    });
    texts.last().unwrap()
}

#[test]
fn moments_in_space_are_those_of_the_whole_body() {
    let time_series = body_in_space();
    let across = time_series.rocking_across(0).unwrap();
    let picture = plot::moment_rotation("Mat", &[("about x", across)], &[]).unwrap();
    let texts = words(&picture);
    assert!(texts.contains("base moment, kN·m") && !texts.contains("kN·m/m"), "{texts}");
    assert!(across.rotation[20] > 0.0 && across.moment[20] > 0.0);
}

#[test]
fn pictures_of_rocking_return_errors_for_mixed_units_and_empty_lists() {
    let plane_series = settling_block();
    let space_series = body_in_space();
    let plane = plane_series.rocking(0).unwrap();
    let space = space_series.rocking(0).unwrap();
    for picture in [plot::moment_rotation, plot::settlement_rotation] {
        let mixed_picture = picture("T", &[("plane", plane), ("space", space)], &[]);
        assert!(matches!(mixed_picture, Err(Error::Scene { quantity: "unit of a moment", .. })));
        let empty_picture = picture("T", &[], &[measured("points", &[(0.0, 1.0)])]);
        assert!(matches!(empty_picture, Err(Error::Size { found: 0, needed: 1, .. })));
    }
    // Points that no chart can show are left out.
    let distant_points = measured("far", &[(1e300, f64::INFINITY), (f64::NAN, f64::NAN)]);
    let picture = plot::moment_rotation("T", &[("plane", plane)], &[distant_points]).unwrap();
    shows(&picture, &["far"]);
}
