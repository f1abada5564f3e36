//! Results in space: quantities in three directions against sums over the cells; files, pages, comparisons.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround, SpringGround};
use basemat::coupled::State;
use basemat::interface::{Coulomb, Mode};
use basemat::motion::{FreeField, el_centro_1940};
use basemat::results::{
    Comparison, Criterion, Quantity, Recorder, Run, Serviceability, TimeSeries,
};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Simulation, Soil};

use basemat_problems::scenes::{RecordedRun, record_run};

use super::cells::CrossingPulses;

const BODY_SIDES: [f64; 3] = [8.0, 6.0, 10.0];
const BODY_WEIGHT: f64 = 9.80665 * 2000.0 * (8.0 * 6.0 * 10.0);

/// [`CrossingPulses`] with twelve times the amplitude.
struct StrongPulses;

impl FreeField for StrongPulses {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        CrossingPulses { quarter_turns: 0 }.displacement_at(place, time).map(|u| 12.0 * u)
    }
}

/// A cuboid on springs, shaken so that it lifts and slides.
pub(super) fn rocking_simulation() -> Simulation {
    let plan = Plan::rectangle(-4.0..4.0, -3.0..3.0, 4).unwrap();
    let springs = SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap();
    Simulation::builder(5e-3)
        .structure(RigidBody::cuboid(BODY_SIDES, 2000.0).unwrap())
        .ground(springs.with_dashpots(8e5, 4e5).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .motion(StrongPulses)
        .serviceability(Serviceability {
            slip: Some(1e-3),
            gap: Some(1e-4),
            rotation: Some(1.0),
            uplifted_fraction: Some(0.9),
            ..Serviceability::default()
        })
        .build()
        .unwrap()
}

/// The run of that cuboid, with the contact of every tenth step.
pub(super) struct RockingBody {
    pub(super) time_series: TimeSeries,
    pub(super) run: Run,
    pub(super) states: Vec<State>,
}

impl RockingBody {
    pub(super) fn new() -> Self {
        let recorder = Recorder::new().contact(10);
        let RecordedRun { time_series, run, states } =
            record_run(&mut rocking_simulation(), recorder, 400);
        Self { time_series, run, states }
    }
}

/// The value farthest from zero.
fn extreme(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(
        0.0,
        |farthest: f64, value| {
            if value.abs() > farthest.abs() { value } else { farthest }
        },
    )
}

/// Quantities that are sums over the elements, in the order of [`sums_over_elements`].
const SUMMED_QUANTITIES: [Quantity; 8] = [
    Quantity::BaseShear,
    Quantity::ShearAcross,
    Quantity::MomentAcross,
    Quantity::BaseMoment,
    Quantity::Torque,
    Quantity::UpliftedArea,
    Quantity::MeanSlip,
    Quantity::MeanSlipAcross,
];

/// Sums over the elements of a state: forces along x and y, moments about x and y, torque, open area, mean slips.
fn sums_over_elements(elements: &[ContactElement], areas: &[f64], state: &State) -> [f64; 8] {
    let whole_area: f64 = areas.iter().sum();
    let mut sums = [0.0; 8];
    for (e, contact) in state.contact.iter().enumerate() {
        let center = elements[e].center();
        let x = center[0];
        let y = center[1];
        let fx = areas[e] * contact.shear;
        let fy = areas[e] * contact.shear_across;
        let p = areas[e] * contact.pressure;
        let open_area = if state.modes[e] == Mode::Open { areas[e] } else { 0.0 };
        let terms = [
            fx,
            fy,
            // The soil is pressed down: (x, y, 0) × (fx, fy, −p).
            -y * p,
            x * p,
            x * fy - y * fx,
            open_area,
            contact.slip * areas[e] / whole_area,
            contact.slip_across * areas[e] / whole_area,
        ];
        for (sum, value) in sums.iter_mut().zip(terms) {
            *sum += value;
        }
    }
    sums
}

#[test]
fn quantities_are_sums_over_the_cells() {
    let RockingBody { time_series, run, states } = RockingBody::new();
    let elements = time_series.elements();
    let areas: Vec<f64> = elements.iter().map(ContactElement::area).collect();
    let whole_area: f64 = areas.iter().sum();
    assert!((whole_area - BODY_SIDES[0] * BODY_SIDES[1]).abs() < 1e-9);
    let sums: Vec<[f64; 8]> =
        states.iter().map(|state| sums_over_elements(elements, &areas, state)).collect();
    for (k, quantity) in SUMMED_QUANTITIES.into_iter().enumerate() {
        let farthest = extreme(sums.iter().map(|sums| sums[k]));
        assert!(farthest.abs() > 1e-6, "{quantity} {farthest}");
        let series = time_series.series(quantity);
        assert_eq!(series.len(), states.len());
        for (sums, value) in sums.iter().zip(series) {
            assert!(
                (sums[k] - value).abs() < 1e-9 * farthest.abs(),
                "{quantity}: {} {value}",
                sums[k]
            );
        }
        assert!((run.whole.peak(quantity).value / farthest - 1.0).abs() < 1e-9, "{quantity}");
        assert_eq!(states[7].value(quantity), series[7]);
    }
    // Rotations of a rigid body's base are its degrees of freedom.
    for (quantity, dof) in
        [(Quantity::BaseRotation, 4), (Quantity::RotationAcross, 3), (Quantity::Twist, 5)]
    {
        for (state, value) in states.iter().zip(time_series.series(quantity)) {
            assert!((state.displacement()[dof] - value).abs() < 1e-14, "{quantity}");
        }
        assert!(run.whole.peak(quantity).value.abs() > 1e-7, "{quantity}");
    }
    for (state, value) in states.iter().zip(time_series.series(Quantity::FreeFieldAcross)) {
        assert_eq!(state.free_field_across, *value);
    }
    let max_force = sums.iter().fold(0.0_f64, |max, sums| max.max(sums[0].hypot(sums[1])));
    let weight_ratio = run.shear_coefficient().unwrap() * BODY_WEIGHT / max_force;
    assert!((weight_ratio - 1.0).abs() < 1e-9);
    let slips = states.iter().flat_map(|state| &state.contact);
    let max_slip =
        slips.fold(0.0_f64, |max, contact| max.max(contact.slip.hypot(contact.slip_across)));
    assert!((run.whole.largest_slip.highest.value / max_slip - 1.0).abs() < 1e-12);
    assert_serviceability(&run, &states, &sums);
}

/// Limits of service apply to slip and tilt in any direction.
fn assert_serviceability(run: &Run, states: &[State], sums: &[[f64; 8]]) {
    let max_mean_slip = sums.iter().fold(0.0_f64, |max, sums| max.max(sums[6].hypot(sums[7])));
    let max_tilt = states
        .iter()
        .map(|state| state.displacement()[3].hypot(state.displacement()[4]))
        .fold(0.0, f64::max);
    for check in &run.serviceability {
        let expected = match check.criterion {
            Criterion::Slip => max_mean_slip,
            Criterion::Rotation => max_tilt,
            _ => continue,
        };
        assert!((check.largest.value / expected - 1.0).abs() < 1e-9, "{check} {expected}");
    }
    assert_eq!(run.is_serviceable(), Some(false));
    assert!(run.whole.sliding.path > 0.0 && run.whole.uplift.duration > 0.0, "{run}");
}

/// A table read from comma-separated text; text that is not a number is NaN.
struct CsvTable {
    heading: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl CsvTable {
    fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let heading = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows = lines
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
            .collect();
        Self { heading, rows }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let index = self.heading.iter().position(|column| column == name).expect(name);
        self.rows.iter().map(|row| row[index]).collect()
    }
}

#[test]
fn files_have_columns_of_the_whole_body() {
    let RockingBody { time_series, run, states } = RockingBody::new();
    let table = CsvTable::parse(&time_series.csv());
    assert!(table.heading.iter().all(|name| !name.ends_with("per_m")), "{:?}", table.heading);
    for (name, quantity) in [
        ("base_shear_n", Quantity::BaseShear),
        ("shear_across_n", Quantity::ShearAcross),
        ("base_moment_n_m", Quantity::BaseMoment),
        ("moment_across_n_m", Quantity::MomentAcross),
        ("torque_n_m", Quantity::Torque),
        ("uplifted_area_m2", Quantity::UpliftedArea),
        ("base_rotation_rad", Quantity::BaseRotation),
        ("twist_rad", Quantity::Twist),
    ] {
        assert_eq!(table.column(name), time_series.series(quantity), "{name}");
        assert_eq!(quantity.column(true), name);
    }
    let input_energy = table.column("input_energy_j");
    assert_eq!(*input_energy.last().unwrap(), run.energy_balance.input);

    let table = CsvTable::parse(&time_series.contact_csv());
    let names = "time_s,element,left_m,right_m,front_m,back_m,mode,gap_m,slip_m,pressure_pa,shear_pa,\
                 slip_across_m,shear_across_pa";
    assert_eq!(table.heading.join(","), names);
    let count = time_series.elements().len();
    let row = &table.rows[3 * count + 5];
    let contact = &states[30].contact[5];
    assert_eq!(row[..2], [states[30].time, 5.0]);
    assert_eq!(row[4..6], time_series.elements()[5].depth());
    assert_eq!(row[7..11], [contact.gap, contact.slip, contact.pressure, contact.shear]);
    assert_eq!(row[11..], [contact.slip_across, contact.shear_across]);

    let table = CsvTable::parse(&run.envelope_csv());
    assert_eq!(table.heading[..5], ["element", "left_m", "right_m", "front_m", "back_m"]);
    let farthest = extreme(states.iter().map(|state| state.contact[5].shear_across));
    assert_eq!(table.column("shear_across_pa")[5], farthest);
    assert_eq!(table.heading.len(), 21);
}

#[test]
fn pages_have_both_directions() {
    let page = RockingBody::new().run.to_string();
    for text in [
        "base shear across",
        "base moment across",
        "torque",
        "uplifted area",
        "base twist",
        "Largest horizontal force: ",
        "mean slip across up to",
        "y, m",
        "kN·m ",
    ] {
        assert!(page.contains(text), "{text}\n{page}");
    }
    assert!(!page.contains("/m "), "{page}");
}

/// The block of the plane, one metre deep, on springs.
pub(super) fn strip_simulation(is_shaken: bool) -> Simulation {
    let builder = Simulation::builder(5e-3)
        .structure(RigidBlock::new(8.0, 10.0, 2000.0).unwrap())
        .ground(SpringGround::new(-4.0..4.0, 8, 4e7, 3e7).unwrap())
        .interface(Coulomb::new(0.35).unwrap());
    let builder = if is_shaken { builder.motion(el_centro_1940()) } else { builder };
    builder.build().unwrap()
}

/// Beside a run in the plane, quantities per metre have separate rows.
#[test]
fn comparisons_keep_both_dimensions_apart() {
    let body = RockingBody::new().run;
    let strip = strip_simulation(true).run(400, |_| {}).unwrap();
    let comparison = Comparison::from_iter([("body", body.clone()), ("strip", strip.clone())]);
    let table = CsvTable::parse(&comparison.csv());
    let shear = table.column("base_shear_n");
    assert!(shear[0] == body.whole.base_shear.largest().value && shear[1].is_nan());
    let shear_per_metre = table.column("base_shear_n_per_m");
    assert!(shear_per_metre[1] == strip.whole.base_shear.largest().value);
    assert!(shear_per_metre[0].is_nan());
    let torque = table.column("torque_n_m");
    assert!(torque[0] == body.whole.torque.largest().value && torque[1].is_nan());
    assert!(table.column("torque_time_s")[1].is_nan());
    assert!(table.column("base_shear_time_s").iter().all(|time| *time > 0.0));
    assert_eq!(table.column("input_energy_j")[0], body.energy_balance.input);
    assert!(table.column("mean_slip_m").iter().all(|slip| !slip.is_nan()));
    let text = comparison.to_string();
    assert!(text.contains("kN/m") && text.contains("kN "), "{text}");
    let of_strip = Comparison::from_iter([("strip", strip)]).csv();
    assert!(of_strip.lines().next().unwrap().starts_with("case,base_shear_n_per_m,"));
    assert!(!of_strip.contains("across"));
    let of_body = Comparison::from_iter([("body", body)]).csv();
    assert!(!of_body.contains("per_m"), "{of_body}");
}

/// Static pressures of an elastic ground, whose outer cells overhang: areas inside the outline carry the weight.
#[test]
fn the_area_of_a_body_is_that_of_its_outline() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let body = RigidBody::cuboid(BODY_SIDES, 2000.0).unwrap();
    let ground = ElasticGround::under(soil, &body, 6).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .build()
        .unwrap();
    let state = simulation.state();
    assert_eq!(state.value(Quantity::UpliftedArea), 0.0);
    assert!((state.value(Quantity::NormalForce) / BODY_WEIGHT - 1.0).abs() < 1e-9);
}

/// Results are written and read back in serde's form and as an archive.
#[test]
fn results_in_space_are_read_back() {
    let RockingBody { time_series, run, .. } = RockingBody::new();
    let text = serde_json::to_string(&time_series).unwrap();
    let read_back: TimeSeries = serde_json::from_str(&text).unwrap();
    assert_eq!(read_back.csv(), time_series.csv());
    assert_eq!(read_back.contact_csv(), time_series.contact_csv());
    let contradictory = text.replace("\"in_plan\":true", "\"in_plan\":false");
    assert!(serde_json::from_str::<TimeSeries>(&contradictory).is_err());
    let read_back: Run = serde_json::from_str(&serde_json::to_string(&run).unwrap()).unwrap();
    assert_eq!(read_back.to_string(), run.to_string());
    #[cfg(feature = "npz")]
    {
        let mut archive = Vec::new();
        time_series.write_npz(&mut archive).unwrap();
        for name in [
            "base_shear_n",
            "torque_n_m",
            "soil_energy_j",
            "element_back_m",
            "contact_shear_across_pa",
        ] {
            assert!(has_array(&archive, name), "{name}");
        }
        assert!(!has_array(&archive, "base_shear_n_per_m"));
    }
}

/// Whether an archive has an array of this name.
#[cfg(feature = "npz")]
fn has_array(archive: &[u8], name: &str) -> bool {
    let file = format!("{name}.npy");
    archive.windows(file.len()).any(|window| window == file.as_bytes())
}
