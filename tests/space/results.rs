//! Results in plan: quantities of three directions by sums over the cells, in files, on pages, in comparisons.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround, SpringGround};
use basemat::coupled::State;
use basemat::interface::{Coulomb, InterfaceLaw, Mode};
use basemat::io::paraview;
use basemat::motion::{FreeField, el_centro_1940};
use basemat::results::{
    Comparison, Criterion, Quantity, Recorder, Run, Serviceability, TimeSeries,
};
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Error, Simulation, Soil, plot};

use basemat_problems::scenes::recorded;

use super::cells::Waves;

const SIDES: [f64; 3] = [8.0, 6.0, 10.0];

/// Stronger than [`Waves`].
struct Strong;

impl FreeField for Strong {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }
    fn displacement_at(&self, place: [f64; 2], time: f64) -> [f64; 3] {
        Waves { quarters: 0 }.displacement_at(place, time).map(|u| 12.0 * u)
    }
}

/// A cuboid that lifts and slides, its frames and its run.
fn rocked(law: impl InterfaceLaw + 'static) -> (Simulation, TimeSeries, Run, Vec<State>) {
    let plan = Plan::rectangle(-4.0..4.0, -3.0..3.0, 4).unwrap();
    let mut simulation = Simulation::builder(5e-3)
        .structure(RigidBody::cuboid(SIDES, 2000.0).unwrap())
        .ground(
            SpringGround::in_plan(plan, [4e7, 3e7, 3e7]).unwrap().with_dashpots(8e5, 4e5).unwrap(),
        )
        .interface(law)
        .motion(Strong)
        .serviceability(Serviceability {
            slip: Some(1e-3),
            gap: Some(1e-4),
            rotation: Some(1.0),
            uplifted_fraction: Some(0.9),
        })
        .build()
        .unwrap();
    let (time_series, run, states) = recorded(&mut simulation, Recorder::new().contact(10), 400);
    (simulation, time_series, run, states)
}

fn rocking() -> (Simulation, TimeSeries, Run, Vec<State>) {
    rocked(Coulomb::new(0.35).unwrap())
}

fn extreme(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |far: f64, value| if value.abs() > far.abs() { value } else { far })
}

#[test]
fn quantities_are_sums_over_the_cells() {
    let (_, time_series, run, states) = rocking();
    let elements = time_series.elements();
    let areas: Vec<f64> = elements.iter().map(ContactElement::area).collect();
    let whole: f64 = areas.iter().sum();
    assert!((whole - SIDES[0] * SIDES[1]).abs() < 1e-9);
    // By hand, of a state: along, across, both, moments, torque, open area, slip, sliding element.
    let by_hand = |state: &State| {
        let mut sums = [0.0; 8];
        for (e, own) in state.contact.iter().enumerate() {
            let [x, y, _] = elements[e].center();
            let [fx, fy, p] = [own.shear, own.shear_across, own.pressure].map(|t| areas[e] * t);
            let is_open = if state.modes[e] == Mode::Open { areas[e] } else { 0.0 };
            // The soil is pressed down: (x, y, 0) × (fx, fy, −p).
            let moment = [-y * p, x * p, x * fy - y * fx];
            let more = [fx, fy, moment[0], moment[1], moment[2], is_open];
            let slips = [own.slip, own.slip_across].map(|slip| slip * areas[e] / whole);
            for (sum, value) in sums.iter_mut().zip(more.into_iter().chain(slips)) {
                *sum += value;
            }
        }
        sums
    };
    let table = [
        Quantity::BaseShear,
        Quantity::ShearAcross,
        Quantity::MomentAcross,
        Quantity::BaseMoment,
        Quantity::Torque,
        Quantity::UpliftedArea,
        Quantity::MeanSlip,
        Quantity::MeanSlipAcross,
    ];
    let sums: Vec<[f64; 8]> = states.iter().map(by_hand).collect();
    for (k, quantity) in table.into_iter().enumerate() {
        let far = extreme(sums.iter().map(|own| own[k]));
        assert!(far.abs() > 1e-6, "{quantity} {far}");
        let series = time_series.series(quantity);
        assert_eq!(series.len(), states.len());
        for (own, found) in sums.iter().zip(series) {
            assert!((own[k] - found).abs() < 1e-9 * far.abs(), "{quantity}: {} {found}", own[k]);
        }
        assert!((run.whole.peak(quantity).value / far - 1.0).abs() < 1e-9, "{quantity}");
        assert_eq!(states[7].value(quantity), series[7]);
    }
    // Rotations of a rigid body's base are its degrees of freedom.
    for (quantity, dof, sign) in [
        (Quantity::BaseRotation, 4, 1.0),
        (Quantity::RotationAcross, 3, 1.0),
        (Quantity::Twist, 5, 1.0),
    ] {
        for (state, found) in states.iter().zip(time_series.series(quantity)) {
            assert!((sign * state.displacement()[dof] - found).abs() < 1e-14, "{quantity}");
        }
        assert!(run.whole.peak(quantity).value.abs() > 1e-7, "{quantity}");
    }
    for (state, found) in states.iter().zip(time_series.series(Quantity::FreeFieldAcross)) {
        assert_eq!(state.free_field_across, *found);
    }
    let weight = 9.80665 * 2000.0 * SIDES.iter().product::<f64>();
    let force = sums.iter().fold(0.0_f64, |most, own| most.max(own[0].hypot(own[1])));
    assert!((run.shear_coefficient().unwrap() * weight / force - 1.0).abs() < 1e-9);
    let slip = |state: &State| {
        state.contact.iter().fold(0.0_f64, |most, own| most.max(own.slip.hypot(own.slip_across)))
    };
    let largest = states.iter().map(slip).fold(0.0, f64::max);
    assert!((run.whole.largest_slip.highest.value / largest - 1.0).abs() < 1e-12);

    // Service: slip in any direction, tilt in any direction.
    let mean = sums.iter().fold(0.0_f64, |most, own| most.max(own[6].hypot(own[7])));
    let tilt = |state: &State| state.displacement()[3].hypot(state.displacement()[4]);
    let tilt = states.iter().map(tilt).fold(0.0, f64::max);
    for check in &run.serviceability {
        let exact = match check.criterion {
            Criterion::Slip => mean,
            Criterion::Rotation => tilt,
            _ => continue,
        };
        assert!((check.largest.value / exact - 1.0).abs() < 1e-9, "{check} {exact}");
    }
    assert_eq!(run.is_serviceable(), Some(false));
    assert!(run.whole.sliding.path > 0.0 && run.whole.uplift.duration > 0.0, "{run}");
}

fn rows(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let heading = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    (heading, lines.map(|line| line.split(',').map(number).collect()).collect())
}

#[test]
fn files_have_columns_of_the_whole_body() {
    let (_, time_series, run, states) = rocking();
    let (heading, values) = rows(&time_series.csv());
    assert!(heading.iter().all(|name| !name.ends_with("per_m")), "{heading:?}");
    let place = |name: &str| heading.iter().position(|own| own == name).expect(name);
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
        let found: Vec<f64> = values.iter().map(|row| row[place(name)]).collect();
        assert_eq!(found, time_series.series(quantity), "{name}");
        assert_eq!(quantity.column(true), name);
    }
    assert_eq!(values.last().unwrap()[place("input_energy_j")], run.energy_balance.input);

    let (heading, values) = rows(&time_series.contact_csv());
    let names = "time_s,element,left_m,right_m,front_m,back_m,mode,gap_m,slip_m,pressure_pa,shear_pa,\
                 slip_across_m,shear_across_pa";
    assert_eq!(heading.join(","), names);
    let count = time_series.elements().len();
    let row = &values[3 * count + 5];
    let state = &states[30].contact[5];
    assert_eq!(row[..2], [states[30].time, 5.0]);
    assert_eq!(row[4..6], time_series.elements()[5].depth());
    assert_eq!(row[7..11], [state.gap, state.slip, state.pressure, state.shear]);
    assert_eq!(row[11..], [state.slip_across, state.shear_across]);

    let (heading, values) = rows(&run.envelope_csv());
    assert_eq!(heading[..5], ["element", "left_m", "right_m", "front_m", "back_m"]);
    let across = heading.iter().position(|own| own == "shear_across_pa").unwrap();
    let far = extreme(states.iter().map(|state| state.contact[5].shear_across));
    assert_eq!(values[5][across], far);
    assert_eq!(heading.len(), 21);
}

#[test]
fn pages_say_both_directions() {
    let (_, _, run, _) = rocking();
    let page = run.to_string();
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

/// Beside a run in the plane, what is per metre has a row of its own.
#[test]
fn comparisons_keep_both_dimensions_apart() {
    let (_, _, run, _) = rocking();
    let mut plane = Simulation::builder(5e-3)
        .structure(RigidBlock::new(8.0, 10.0, 2000.0).unwrap())
        .ground(SpringGround::new(-4.0..4.0, 8, 4e7, 3e7).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let strip = plane.run(400, |_| {}).unwrap();
    let values = [run.whole.base_shear.largest().value, strip.whole.base_shear.largest().value];
    let both = Comparison::from_iter([("body", run.clone()), ("strip", strip.clone())]);
    let (heading, rows_of) = rows(&both.csv());
    let column = |name: &str| {
        let place = heading.iter().position(|own| own == name).expect(name);
        [rows_of[0][place], rows_of[1][place]]
    };
    let [body, other] = column("base_shear_n");
    assert!(body == values[0] && other.is_nan());
    let [other, own] = column("base_shear_n_per_m");
    assert!(own == values[1] && other.is_nan());
    let [body, other] = column("torque_n_m");
    assert!(body == run.whole.torque.largest().value && other.is_nan());
    assert!(column("torque_time_s")[1].is_nan());
    assert!(column("base_shear_time_s").iter().all(|time| *time > 0.0));
    assert_eq!(column("input_energy_j")[0], run.energy_balance.input);
    assert!(column("mean_slip_m").iter().all(|slip| !slip.is_nan()));
    let text = both.to_string();
    assert!(text.contains("kN/m") && text.contains("kN "), "{text}");
    let one = Comparison::from_iter([("strip", strip)]);
    assert!(one.csv().lines().next().unwrap().starts_with("case,base_shear_n_per_m,"));
    assert!(!one.csv().contains("across"));
    let one = Comparison::from_iter([("body", run)]);
    assert!(!one.csv().contains("per_m"), "{}", one.csv());
}

/// Static pressures of an elastic ground, whose outer cells overhang: areas inside the outline carry the weight.
#[test]
fn the_area_of_a_body_is_that_of_its_outline() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let body = RigidBody::cuboid(SIDES, 2000.0).unwrap();
    let ground = ElasticGround::under(soil, &body, 6).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .build()
        .unwrap();
    let state = simulation.state();
    assert_eq!(state.value(Quantity::UpliftedArea), 0.0);
    let weight = 9.80665 * 2000.0 * SIDES.iter().product::<f64>();
    assert!((state.value(Quantity::NormalForce) / weight - 1.0).abs() < 1e-9);
}

/// One rectangle for each open element, and one line for each arrow, in addition to the lines of the key.
#[test]
fn pictures_show_open_and_sliding_cells() {
    let (_, time_series, run, states) = rocking();
    let count = |text: &str, what: &str| text.matches(what).count();
    let time = run.whole.uplifted_area.highest.time;
    let shown = states
        .iter()
        .step_by(10)
        .min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()));
    let shown = shown.unwrap();
    let open = shown.modes.iter().filter(|mode| !mode.is_closed()).count();
    let slides = shown.modes.iter().filter(|mode| mode.is_slip()).count();
    assert!(open > 2 && slides > 2, "{open} {slides}");
    let picture = plot::contact_plan("Contact", &time_series, time).unwrap();
    let bare = plot::contact_plan("Contact", &time_series, 0.0).unwrap();
    assert_eq!(count(picture.as_str(), "fill=\"#164878\""), open + 1);
    assert_eq!(count(bare.as_str(), "fill=\"#164878\""), 0);
    // Axes are lines too: the axes of both pictures, and the sample of the key.
    let lines = |svg: &plot::Svg| count(svg.as_str(), "<polyline");
    let ticks = lines(&bare);
    assert!(lines(&picture) > slides && lines(&picture) <= slides + 2 + ticks);
    let largest = plot::pressure_envelope("Pressure", &run).unwrap();
    assert!(count(largest.as_str(), "stroke=\"#FFFFFF\"") == time_series.elements().len());
    let torque = plot::time_series("T", &[("body", &time_series)], Quantity::Torque).unwrap();
    assert!(torque.as_str().contains("torque, kN·m"));
    let energy = plot::energy("E", &time_series).unwrap();
    assert!(energy.as_str().contains("energy, kJ") && !energy.as_str().contains("kJ/m"));
    for error in [
        plot::mode_map("Modes", &time_series).err(),
        plot::contact_plan("T", &time_series, f64::NAN).err(),
    ] {
        assert!(matches!(error, Some(Error::Scene { .. } | Error::Input { .. })), "{error:?}");
    }
    let mut plane = Simulation::builder(5e-3)
        .structure(RigidBlock::new(8.0, 10.0, 2000.0).unwrap())
        .ground(SpringGround::new(-4.0..4.0, 8, 4e7, 3e7).unwrap())
        .interface(Coulomb::new(0.35).unwrap())
        .build()
        .unwrap();
    let mut strip = Recorder::new().contact(1).start(&plane).unwrap();
    plane.run(3, |state| strip.record(state)).unwrap();
    assert!(matches!(plot::contact_plan("T", &strip, 0.0), Err(Error::Scene { .. })));
    let mixed = [("body", &time_series), ("strip", &strip)];
    assert!(matches!(
        plot::time_series("T", &mixed, Quantity::BaseShear),
        Err(Error::Scene { .. })
    ));
    assert!(plot::time_series("T", &mixed, Quantity::MeanSlip).is_ok());
    // Series of three directions alone are empty in the plane.
    assert!(strip.series(Quantity::Torque).is_empty() && !strip.in_plan());
}

#[test]
fn paraview_gets_the_base_as_rectangles() {
    let (_, time_series, _, states) = rocking();
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("base_in_plan");
    assert_eq!(paraview::write_base(&folder, "mat", &time_series), Ok(41));
    let text = std::fs::read_to_string(folder.join("mat_base_0030.vtu")).unwrap();
    let count = time_series.elements().len();
    assert!(text.contains(&format!("NumberOfPoints=\"{}\" NumberOfCells=\"{count}\"", 4 * count)));
    let numbers = |name: &str| -> Vec<f64> {
        let rest = text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
        let inner = rest.split_once(">\n").unwrap().1.split("</DataArray>").next().unwrap();
        inner.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
    };
    let of = |value: fn(&basemat::interface::ContactState) -> f64| -> Vec<f64> {
        states[300].contact.iter().map(value).collect()
    };
    assert_eq!(numbers("shear_across"), of(|own| own.shear_across));
    assert_eq!(numbers("slip_across"), of(|own| own.slip_across));
    assert_eq!(numbers("pressure"), of(|own| own.pressure));
    let element = &time_series.elements()[5];
    let ([left, right], [front, back]) = ([element.left(), element.right()], element.depth());
    let corners = [left, front, 0.0, right, front, 0.0, right, back, 0.0, left, back, 0.0];
    assert_eq!(numbers("points")[60..72], corners);
    assert!(numbers("types").iter().all(|kind| *kind == 9.0));
    let (simulation, ..) = rocking();
    let none = Recorder::new().start(&simulation).unwrap();
    assert!(matches!(paraview::write_base(&folder, "mat", &none), Err(Error::Scene { .. })));
}

/// Written and read again in serde's form, and as an archive.
#[test]
fn results_in_plan_are_read_again() {
    let (_, time_series, run, _) = rocking();
    let text = serde_json::to_string(&time_series).unwrap();
    let again: TimeSeries = serde_json::from_str(&text).unwrap();
    assert_eq!(again.csv(), time_series.csv());
    assert_eq!(again.contact_csv(), time_series.contact_csv());
    let cut = text.replace("\"in_plan\":true", "\"in_plan\":false");
    assert!(serde_json::from_str::<TimeSeries>(&cut).is_err());
    let again: Run = serde_json::from_str(&serde_json::to_string(&run).unwrap()).unwrap();
    assert_eq!(again.to_string(), run.to_string());
    #[cfg(feature = "npz")]
    {
        let mut archive = Vec::new();
        time_series.write_npz(&mut archive).unwrap();
        let has = |name: &str| {
            let name = format!("{name}.npy");
            archive.windows(name.len()).any(|own| own == name.as_bytes())
        };
        for name in [
            "base_shear_n",
            "torque_n_m",
            "soil_energy_j",
            "element_back_m",
            "contact_shear_across_pa",
        ] {
            assert!(has(name), "{name}");
        }
        assert!(!has("base_shear_n_per_m"));
    }
}
