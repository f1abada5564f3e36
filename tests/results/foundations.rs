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
    let both = march(group);
    let alone = [march(tower()), march(block())];
    assert_eq!(both.foundations.len(), 2);
    assert_eq!(both.foundations[1].elements, 8..16);
    assert_eq!(both.foundations[1].ends, [8.5, 11.5]);
    for (foundation, alone) in both.foundations.iter().zip(&alone) {
        assert!(
            (foundation.static_normal_force / alone.whole.static_normal_force - 1.0).abs() < 1e-9
        );
        assert_same_extremes(alone.whole.base_shear, foundation.base_shear);
        assert_same_extremes(alone.whole.base_moment, foundation.base_moment);
        assert_same_extremes(alone.whole.normal_force, foundation.normal_force);
        assert_same_extremes(alone.whole.base_rotation, foundation.base_rotation);
        assert_same_peak(
            alone.whole.uplifted_fraction.highest,
            foundation.uplifted_fraction.highest,
            1.0,
        );
        assert_same_peak(alone.whole.mean_slip.largest(), foundation.mean_slip.largest(), 1e-3);
        assert!((alone.whole.residual_slip - foundation.residual_slip).abs() < 1e-9);
        let sliding = [alone.whole.sliding_safety.lowest, foundation.sliding_safety.lowest];
        assert!(sliding.iter().all(|peak| peak.value >= 1.0 - 1e-9));
        let overturning = foundation.overturning_safety.lowest.value;
        assert!((alone.whole.overturning_safety.lowest.value - overturning).abs() < 1e-9);
        // A single foundation has the results of the whole base, except for moments, which are about another point.
        let [only] = &alone.foundations[..] else { panic!("one foundation") };
        for quantity in Quantity::ALL_QUANTITIES {
            if quantity == Quantity::BaseMoment {
                continue;
            }
            assert_eq!(only.extremes(quantity), alone.whole.extremes(quantity), "{quantity}");
        }
        assert_eq!((only.uplift, &only.sliding), (alone.whole.uplift, &alone.whole.sliding));
    }
    // The foundations differ, so that no check above holds by chance; the tower rocks.
    let [tower, block] = &both.foundations[..] else { unreachable!() };
    assert!(tower.uplifted_fraction.largest().value > 0.2);
    assert!(tower.base_rotation.magnitude() > 2.0 * block.base_rotation.magnitude());

    let page = both.to_string();
    println!("{page}");
    assert!(page.contains("-2.00 to 2.00") && page.contains("8.50 to 11.50"), "{page}");
    assert!(!alone[0].to_string().contains("-2.00 to 2.00"));
    // The page says that not all 16 elements are printed; the element with the largest pressure is.
    assert!(page.contains("of 16 elements"));
    let (element, peak) = both.largest_pressure().unwrap();
    let line = page.lines().find(|line| {
        line.trim_start().starts_with(&format!("{:.3} ", element.element.center()[0]))
    });
    assert!(line.is_some_and(|line| line.contains(&format!("{:.3}", peak.time))), "{page}");
}

fn slip_event_count(run: &Run) -> usize {
    run.foundations.iter().map(|foundation| foundation.sliding.events.len()).sum()
}

/// One slides and the other does not: the base as a whole never slides.
#[test]
fn each_foundation_has_separate_slip_events() {
    let group = StructureGroup::new().with(block(), 0.0).unwrap().with(block(), 10.0).unwrap();
    let both = march_on(group, &[10.0, 0.15]);
    let alone = march_on(block(), &[0.15]);
    let [sticking, slid] = &both.foundations[..] else { panic!("two foundations") };
    assert!(
        alone.whole.sliding.events.len() > 5 && alone.whole.sliding.path > 0.02,
        "{:?}",
        alone.whole.sliding
    );
    assert_eq!(slid.sliding.events.len(), alone.whole.sliding.events.len());
    assert!((slid.sliding.path - alone.whole.sliding.path).abs() < 1e-9);
    assert!((slid.sliding.duration - alone.whole.sliding.duration).abs() < 1e-9);
    for (event, alone) in slid.sliding.events.iter().zip(&alone.whole.sliding.events) {
        assert!((event.slip - alone.slip).abs() < 1e-9, "{event:?} {alone:?}");
        assert!((event.start - alone.start).abs() < 1e-9 && (event.end - alone.end).abs() < 1e-9);
    }
    assert_eq!(alone.foundations[0].sliding, alone.whole.sliding);
    assert!(sticking.sliding.events.is_empty() && sticking.sliding.path == 0.0);
    assert!(both.whole.sliding.events.is_empty());
    assert_eq!(slip_event_count(&both), slip_event_count(&alone));
    // Tables count them, too.
    let table: basemat::results::Comparison =
        [("both", both), ("alone", alone)].into_iter().collect();
    let markdown = table.markdown();
    let row = markdown.lines().find(|line| line.contains("slip events")).unwrap();
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    assert!(cells[3] == cells[4] && cells[3] != "0", "{row}");
}
