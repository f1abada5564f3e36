//! GOAL: pages and tables have the values of a run in the right units.
//! SCENE: probes with and without units; cases that cannot be compared.
//! REFERENCE: the values themselves; files stay in SI units.

use basemat::Error;
use basemat::coupled::Probe;
use basemat::interface::Bonded;
use basemat::results::{Comparison, Quantity, Recorder, Run};
use basemat::structure::RigidBlock;

use super::{FRICTION_COEFFICIENT, Recorded, STEP_COUNT, recorded};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

/// Values stay in SI units in files and are converted to the engineers' units where they are printed; an
/// unknown label stays.
#[test]
fn probes_have_their_unit() {
    let mut simulation = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT))
        .probes([
            Probe::displacement("slide", RigidBlock::HORIZONTAL_DOF),
            Probe::displacement("turn", RigidBlock::ROTATION_DOF).in_unit("rad"),
            Probe::velocity("rate", (RigidBlock::HORIZONTAL_DOF, 100.0)).in_unit("cm/s"),
            Probe::acceleration("shake", RigidBlock::HORIZONTAL_DOF),
            Probe::displacement("bare", RigidBlock::VERTICAL_DOF).in_unit(""),
        ])
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    let run = simulation.run(STEP_COUNT, |state| time_series.record(state)).unwrap();
    let page = run.to_string();
    let mut table = Comparison::default();
    table.extend([("a", run.clone())]);
    let table_page = table.to_string();
    let labels = [
        ("slide", "mm", 1e3),
        ("turn", "mrad", 1e3),
        ("rate", "cm/s", 1.0),
        ("shake", "m/s²", 1.0),
    ];
    for (name, unit, factor) in labels {
        let peak = run.probe(name).unwrap().largest();
        let series = time_series.probe(name).unwrap().iter();
        let max_magnitude = series.fold(0.0, |max: f64, value| max.max(value.abs()));
        assert_eq!(peak.value.abs(), max_magnitude);
        assert!(peak.value != 0.0);
        let expected = factor * peak.value;
        for text in [&page, &table_page] {
            let line = text.lines().find(|line| line.trim().starts_with(name)).unwrap();
            let words: Vec<&str> = line.split_whitespace().collect();
            assert!(words.contains(&unit), "{line}");
            let is_shown = words.iter().any(|word| {
                let value: f64 = word.parse().unwrap_or(f64::NAN);
                (value - expected).abs() < 1e-3 * factor * peak.value.abs()
            });
            assert!(is_shown, "{line}, not {expected}");
        }
    }
    let text = time_series.csv();
    let expected = ",slide_m,turn_rad,rate_cm_per_s,shake_m_per_s2,bare,input_energy_j_per_m";
    assert!(text.lines().next().unwrap().ends_with(expected));
    let csv = table.csv();
    let expected = ",slide_m,turn_rad,rate_cm_per_s,shake_m_per_s2,bare";
    assert!(csv.lines().next().unwrap().ends_with(expected));
    let last_row: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    let turn = run.probe("turn").unwrap().largest().value;
    assert_eq!(last_row[last_row.len() - 4].parse(), Ok(turn));

    let known_names = ["slide", "turn", "rate", "shake", "bare"].map(str::to_owned).into();
    let expected_error =
        Error::Name { quantity: "probe", name: "nobody".to_owned(), known: known_names };
    assert_eq!(run.probe("nobody"), Err(expected_error));
}

fn run_with(probe: Probe) -> Run {
    let builder = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT));
    builder.probe(probe).build().unwrap().begin_run()
}

fn tilt_probe() -> Probe {
    Probe::displacement("tilt", RigidBlock::ROTATION_DOF)
}

#[test]
fn cases_with_other_probes_or_units_have_no_common_rows() {
    let comparison_in_one_unit: Comparison =
        ["a", "b"].map(|name| (name, run_with(tilt_probe()))).into_iter().collect();
    assert_eq!(
        (comparison_in_one_unit.cases.len(), comparison_in_one_unit.csv().lines().count()),
        (2, 3)
    );
    assert!(comparison_in_one_unit.to_string().contains("tilt"));
    let mixed_comparison =
        [("a", run_with(tilt_probe())), ("b", run_with(tilt_probe().in_unit("rad")))];
    let mixed_comparison: Comparison = mixed_comparison.into_iter().collect();
    assert!(
        !mixed_comparison.to_string().contains("tilt") && !mixed_comparison.csv().contains("tilt")
    );
}

#[test]
fn pages_and_tables_have_all_values() {
    let Recorded { time_series, run, .. } = recorded(Recorder::new());
    let page = run.to_string();
    println!("{page}");
    for words in [
        "Run of 400 steps",
        "linear solves per step",
        "Least factor of safety against sliding: 1.000",
        "slip events",
        "friction and impact",
        "Pressure under the base",
    ] {
        assert!(page.contains(words), "{words}\n{page}");
    }
    // No line too wide for a page.
    assert!(page.lines().all(|line| line.chars().count() <= 100), "{page}");

    let mut comparison = Comparison::default();
    comparison.add("first, \"a\"", run.clone());
    comparison.add("second", run.clone());
    println!("{comparison}");
    let csv = comparison.csv();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 3);
    let columns = lines[0].split(',').count();
    let values: Vec<&str> = lines[2].split(',').collect();
    assert_eq!(values.len(), columns);
    let column = lines[0].split(',').position(|name| name == "base_shear_n_per_m").unwrap();
    assert_eq!(values[column].parse(), Ok(run.whole.base_shear.largest().value));
    assert!(lines[1].starts_with("\"first, \"\"a\"\"\","));
    let text = comparison.to_string();
    assert!(text.lines().nth(2).unwrap().starts_with("base shear"));
    let markdown = comparison.markdown();
    assert!(markdown.lines().all(|line| line.matches('|').count() == 5), "{markdown}");
    // Nothing to compare is a table, too.
    assert!(Comparison::default().to_string().contains("base shear"));
    assert_eq!(Comparison::default().csv().lines().count(), 1);

    let text = time_series.csv();
    assert_eq!(text.lines().count(), STEP_COUNT + 2);
    let columns = text.lines().next().unwrap().split(',').count();
    assert!(text.lines().all(|line| line.split(',').count() == columns));
    let last_row: Vec<&str> = text.lines().last().unwrap().split(',').collect();
    assert_eq!(last_row[1].parse(), Ok(time_series.series(Quantity::BaseShear)[STEP_COUNT]));
}

#[test]
fn a_page_warns_if_most_of_the_base_opens() {
    let mut opened_elements = Vec::new();
    let bonded = scene(SI_UNITS, 2.5).structure(block(SI_UNITS)).interface(Bonded);
    let rubbing = scene(SI_UNITS, 2.5).structure(block(SI_UNITS)).interface(friction(0.8));
    for builder in [bonded, rubbing] {
        let run = builder.build().unwrap().run(STEP_COUNT, |_| {}).unwrap();
        let is_open = run.whole.uplifted_fraction.highest.value > 0.5;
        assert_eq!(run.to_string().contains("most of the base opens"), is_open, "{run}");
        opened_elements.push(is_open);
    }
    assert_eq!(opened_elements, [false, true]);
}
