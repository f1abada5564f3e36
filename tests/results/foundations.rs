//! GOAL: a run has the same results of each foundation as a run of this foundation alone.
//! SCENE: a tower and a block on independent springs.
//! REFERENCE: each of them alone.

use basemat::prelude::*;
use basemat::results::{Extremes, Peak};

fn tower() -> RigidBlock {
    RigidBlock::new(4.0, 12.0, 1500.0).unwrap()
}

fn block() -> RigidBlock {
    RigidBlock::new(3.0, 3.0, 1800.0).unwrap()
}

/// Runs a structure on springs, where structures on different foundations do not interact.
fn march(structure: impl Structure + 'static) -> Run {
    march_on(structure, &[0.35; 2])
}

/// Runs a structure on springs with a friction coefficient for each foundation.
fn march_on(structure: impl Structure + 'static, friction: &[f64]) -> Run {
    let ground = SpringGround::under(&structure, 8, 2e7, 1e7).unwrap();
    let mut laws: Vec<Box<dyn InterfaceLaw>> = Vec::new();
    for element in 0..ground.elements().len() {
        laws.push(Box::new(Coulomb::new(friction[element / 8]).unwrap()));
    }
    let mut simulation = Simulation::builder(0.005)
        .structure(structure)
        .ground(ground.with_dashpots(2e5, 1e5).unwrap())
        .interfaces(laws)
        .motion(el_centro_1940())
        .build()
        .unwrap();
    simulation.run(1200, |_| {}).unwrap()
}

#[track_caller]
fn assert_same_peak(a: Peak, b: Peak, scale: f64) {
    assert!((a.value - b.value).abs() < 1e-9 * scale, "{a:?} {b:?}");
    assert!((a.time - b.time).abs() < 1e-9, "{a:?} {b:?}");
}

#[track_caller]
fn assert_same_extremes(a: Extremes, b: Extremes) {
    let scale = a.largest().value.abs();
    assert_same_peak(a.lowest, b.lowest, scale);
    assert_same_peak(a.highest, b.highest, scale);
}

#[test]
fn each_foundation_has_separate_results() {
    let group = StructureGroup::new().with(tower(), 0.0).unwrap().with(block(), 10.0).unwrap();
    let group_run = march(group);
    let single_runs = [march(tower()), march(block())];
    assert_eq!(group_run.foundations.len(), 2);
    assert_eq!(group_run.foundations[1].elements, 8..16);
    assert_eq!(group_run.foundations[1].ends, [8.5, 11.5]);
    for (foundation, single_runs) in group_run.foundations.iter().zip(&single_runs) {
        assert!(
            (foundation.static_normal_force / single_runs.whole.static_normal_force - 1.0).abs()
                < 1e-9
        );
        assert_same_extremes(single_runs.whole.base_shear, foundation.base_shear);
        assert_same_extremes(single_runs.whole.base_moment, foundation.base_moment);
        assert_same_extremes(single_runs.whole.normal_force, foundation.normal_force);
        assert_same_extremes(single_runs.whole.base_rotation, foundation.base_rotation);
        assert_same_peak(
            single_runs.whole.uplifted_fraction.highest,
            foundation.uplifted_fraction.highest,
            1.0,
        );
        assert_same_peak(
            single_runs.whole.mean_slip.largest(),
            foundation.mean_slip.largest(),
            1e-3,
        );
        assert!((single_runs.whole.residual_slip - foundation.residual_slip).abs() < 1e-9);
        let sliding = [single_runs.whole.sliding_safety.lowest, foundation.sliding_safety.lowest];
        assert!(sliding.iter().all(|peak| peak.value >= 1.0 - 1e-9));
        let overturning = foundation.overturning_safety.lowest.value;
        assert!((single_runs.whole.overturning_safety.lowest.value - overturning).abs() < 1e-9);
        // A single foundation has the results of the whole base, except for moments, which are about another point.
        let [only] = &single_runs.foundations[..] else { panic!("one foundation") };
        for quantity in Quantity::ALL_QUANTITIES {
            if quantity == Quantity::BaseMoment {
                continue;
            }
            assert_eq!(only.extremes(quantity), single_runs.whole.extremes(quantity), "{quantity}");
        }
        assert_eq!(
            (only.uplift, &only.sliding),
            (single_runs.whole.uplift, &single_runs.whole.sliding)
        );
    }
    // The foundations differ, so that no check above holds by chance; the tower rocks.
    let [tower, block] = &group_run.foundations[..] else { unreachable!() };
    assert!(tower.uplifted_fraction.largest().value > 0.2);
    assert!(tower.base_rotation.magnitude() > 2.0 * block.base_rotation.magnitude());

    let page = group_run.to_string();
    println!("{page}");
    assert!(page.contains("-2.00 to 2.00") && page.contains("8.50 to 11.50"), "{page}");
    assert!(!single_runs[0].to_string().contains("-2.00 to 2.00"));
    // The page has a note that not all 16 elements are printed; it has the element with the largest pressure.
    assert!(page.contains("of 16 elements"));
    let (element, peak) = group_run.largest_pressure().unwrap();
    let line = page.lines().find(|line| {
        line.trim_start().starts_with(&format!("{:.3} ", element.element.center()[0]))
    });
    assert!(line.is_some_and(|line| line.contains(&format!("{:.3}", peak.time))), "{page}");
}

fn slip_event_count(run: &Run) -> usize {
    run.foundations.iter().map(|foundation| foundation.sliding.events.len()).sum()
}

/// One foundation slides and the other does not: the base as a whole never slides.
#[test]
fn each_foundation_has_separate_slip_events() {
    let group = StructureGroup::new().with(block(), 0.0).unwrap().with(block(), 10.0).unwrap();
    let group_run = march_on(group, &[10.0, 0.15]);
    let single_run = march_on(block(), &[0.15]);
    let [sticking_foundation, sliding_foundation] = &group_run.foundations[..] else {
        panic!("two foundations")
    };
    assert!(
        single_run.whole.sliding.events.len() > 5 && single_run.whole.sliding.path > 0.02,
        "{:?}",
        single_run.whole.sliding
    );
    assert_eq!(sliding_foundation.sliding.events.len(), single_run.whole.sliding.events.len());
    assert!((sliding_foundation.sliding.path - single_run.whole.sliding.path).abs() < 1e-9);
    assert!((sliding_foundation.sliding.duration - single_run.whole.sliding.duration).abs() < 1e-9);
    for (event, single_run) in
        sliding_foundation.sliding.events.iter().zip(&single_run.whole.sliding.events)
    {
        assert!((event.slip - single_run.slip).abs() < 1e-9, "{event:?} {single_run:?}");
        assert!(
            (event.start - single_run.start).abs() < 1e-9
                && (event.end - single_run.end).abs() < 1e-9
        );
    }
    assert_eq!(single_run.foundations[0].sliding, single_run.whole.sliding);
    assert!(
        sticking_foundation.sliding.events.is_empty() && sticking_foundation.sliding.path == 0.0
    );
    assert!(group_run.whole.sliding.events.is_empty());
    assert_eq!(slip_event_count(&group_run), slip_event_count(&single_run));
    // Tables count them, too.
    let table: basemat::results::Comparison =
        [("both", group_run), ("alone", single_run)].into_iter().collect();
    let markdown = table.markdown();
    let row = markdown.lines().find(|line| line.contains("slip events")).unwrap();
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    assert!(cells[3] == cells[4] && cells[3] != "0", "{row}");
}
