//! GOAL: files of time series, contact, envelopes and spectra have the recorded values.
//! SCENE: the block of `results`; probes whose names collide or are no names of columns.
//! REFERENCE: the numbers themselves, through the reader of CSV files of another crate.

use basemat::coupled::Probe;
use basemat::interface::{Coulomb, Mode};
use basemat::motion::AtRest;
use basemat::results::{Quantity, Recorder, spectrum_csv};
use basemat::structure::RigidBlock;

use super::{Recorded, STEP_COUNT, recorded};
use basemat_problems::scenes::{SI_UNITS, block, scene};

struct CsvTable {
    heading: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl CsvTable {
    /// Place of the column with this heading.
    fn column(&self, name: &str) -> usize {
        self.heading.iter().position(|column| column == name).unwrap()
    }
}

fn cells(record: &basemat_problems::csv::StringRecord) -> Vec<String> {
    record.iter().map(str::to_owned).collect()
}

fn table(text: &str) -> CsvTable {
    let mut reader = basemat_problems::csv::Reader::from_reader(text.as_bytes());
    let heading = cells(reader.headers().unwrap());
    CsvTable { heading, rows: reader.records().map(|record| cells(&record.unwrap())).collect() }
}

/// A cell as pandas reads it.
fn number(cell: &str) -> f64 {
    if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() }
}

#[track_caller]
fn assert_same_bits(cell: &str, value: f64) {
    let computed = number(cell);
    assert!(
        computed.to_bits() == value.to_bits() || (computed.is_nan() && value.is_nan()),
        "{cell}"
    );
}

#[test]
fn time_series_have_a_column_for_every_quantity() {
    let Recorded { time_series, .. } = recorded(Recorder::new().every(3));
    let CsvTable { heading, rows } = table(&time_series.csv());
    let mut expected = vec!["time_s".to_owned()];
    expected.extend(Quantity::recorded(false).map(|quantity| quantity.column(false)));
    expected
        .extend(["top_m", "top_acceleration_m_per_s2", "input_energy_j_per_m"].map(str::to_owned));
    assert_eq!(heading, expected);
    assert_eq!(rows.len(), time_series.times().len());
    for (k, row) in rows.iter().enumerate() {
        assert_same_bits(&row[0], time_series.times()[k]);
        for (cell, quantity) in row[1..].iter().zip(Quantity::recorded(false)) {
            assert_same_bits(cell, time_series.series(quantity)[k]);
        }
        assert_same_bits(&row[14], time_series.probe("top").unwrap()[k]);
        assert_same_bits(&row[16], time_series.energy_balances()[k].input);
    }
    // At the start there is no base shear: the factor of safety is infinite.
    assert_eq!(rows[0][12], "inf");
}

#[test]
fn missing_values_are_empty_cells() {
    let mut simulation = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(Coulomb::uplift_only())
        .motion(AtRest)
        .without_energy_balance()
        .build()
        .unwrap();
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    simulation.run(2, |state| time_series.record(state)).unwrap();
    let rows = table(&time_series.csv()).rows;
    assert!(rows.iter().all(|row| row.last().unwrap().is_empty()));
}

#[test]
fn columns_of_probes_differ() {
    let probes = [
        Probe::displacement("Roof (left)", RigidBlock::HORIZONTAL_DOF),
        Probe::displacement("roof, left", RigidBlock::HORIZONTAL_DOF),
        Probe::displacement("roof_left_m", RigidBlock::HORIZONTAL_DOF).in_unit(""),
        Probe::displacement("time", RigidBlock::HORIZONTAL_DOF).in_unit("s"),
        Probe::displacement("input energy", RigidBlock::HORIZONTAL_DOF).in_unit("J/m"),
        Probe::displacement("!", RigidBlock::HORIZONTAL_DOF).in_unit(""),
    ];
    let simulation = scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(Coulomb::uplift_only())
        .probes(probes)
        .build()
        .unwrap();
    let time_series = Recorder::new().start(&simulation).unwrap();
    let heading = table(&time_series.csv()).heading;
    let expected = [
        "roof_left_m",
        "roof_left_m_2",
        "roof_left_m_3",
        "time_s_2",
        "input_energy_j_per_m_2",
        "unnamed",
        "input_energy_j_per_m",
    ];
    assert_eq!(heading[14..], expected);
}

#[test]
fn contact_has_a_row_for_every_frame_and_element() {
    let Recorded { time_series, states, .. } = recorded(Recorder::new().contact(10));
    let CsvTable { heading, rows } = table(&time_series.contact_csv());
    assert_eq!(heading.len(), 9);
    let count = time_series.elements().len();
    assert_eq!(rows.len(), (STEP_COUNT / 10 + 1) * count);
    let mut modes = std::collections::BTreeSet::new();
    for (k, row) in rows.iter().enumerate() {
        let state = &states[k / count * 10];
        let e = k % count;
        let element = time_series.elements()[e];
        let contact = state.contact[e];
        assert_same_bits(&row[0], state.time);
        assert_eq!(row[1], e.to_string());
        assert_same_bits(&row[2], element.left());
        assert_same_bits(&row[3], element.right());
        assert_eq!(row[4].parse::<Mode>(), Ok(state.modes[e]));
        let values = [contact.gap, contact.slip, contact.pressure, contact.shear];
        row[5..].iter().zip(values).for_each(|(cell, value)| assert_same_bits(cell, value));
        modes.insert(row[4].clone());
    }
    assert!(modes.len() > 2, "{modes:?}");
    // Without frames there is only the heading.
    let table_without_frames = table(&recorded(Recorder::new()).time_series.contact_csv());
    assert!(table_without_frames.rows.is_empty());
}

#[test]
fn envelopes_and_spectra_have_their_values() {
    let Recorded { time_series, run, .. } = recorded(Recorder::new());
    let envelopes = table(&run.envelope_csv());
    assert_eq!((envelopes.heading.len(), envelopes.rows.len()), (15, run.envelope.len()));
    for (row, envelope) in envelopes.rows.iter().zip(&run.envelope) {
        for (name, value) in [
            ("left_m", envelope.element.left()),
            ("static_pressure_pa", envelope.static_pressure),
            ("lowest_pressure_pa", envelope.pressure.lowest.value),
            ("highest_pressure_time_s", envelope.pressure.highest.time),
            ("shear_pa", envelope.shear.value),
            ("gap_m", envelope.gap.value),
            ("slip_time_s", envelope.slip.time),
            ("open_s", envelope.open),
        ] {
            assert_same_bits(&row[envelopes.column(name)], value);
        }
    }
    let spectrum = time_series.floor_spectrum("top acceleration", &[0.2, 0.5], 0.05).unwrap();
    let CsvTable { heading, rows } = table(&spectrum_csv(&spectrum));
    assert_eq!(heading[3], "pseudo_acceleration_m_per_s2");
    assert_same_bits(&rows[1][3], spectrum[1].pseudo_acceleration);
    assert_same_bits(&rows[0][4], spectrum[0].acceleration);

    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("files");
    run.envelope_csv().save(folder.join("envelope.csv")).unwrap();
    time_series.contact_csv().save(folder.join("contact.csv")).unwrap();
    spectrum_csv(&spectrum).save(folder.join("spectrum.csv")).unwrap();
    let below = folder.join("envelope.csv/below_a_file.csv");
    assert!(
        run.envelope_csv().save(&below).is_err() && time_series.contact_csv().save(&below).is_err()
    );
    assert!(spectrum_csv(&spectrum).save(&below).is_err());
}
