//! Histories, peaks, envelopes and factors of safety, against the states they were made of and
//! against statics.

#[path = "support/scenes.rs"]
mod scenes;

use basemat::bem::{HalfPlaneGround, SpringGround, Strip};
use basemat::coupled::{Placement, Probe, State};
use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, InterfaceLaw, Mode, StepStart, ThinLayer, Tolerance,
};
use basemat::motion::{AtRest, STANDARD_GRAVITY, SpectralOrdinate, el_centro_1940};
use basemat::results::{
    Comparison, EnergyShares, Histories, Quantity, Recorder, broadened, log_spaced,
};
use basemat::structure::{ContactNode, RigidBlock, Structure, StructureGroup, Triplets};
use basemat::{Error, Simulation, Soil};
use scenes::{SI, block, friction, scene, soil};

const FRICTION: f64 = 0.35;
const STEPS: usize = 400;

fn simulation() -> Simulation {
    scene(SI, 0.6)
        .structure(block(SI))
        .interface(friction(FRICTION))
        .probe(Probe::displacement("top", block(SI).horizontal_at(6.0)))
        .probe(Probe::acceleration("top acceleration", block(SI).horizontal_at(6.0)))
        .build()
        .unwrap()
}

/// The states of a run, and its histories.
fn recorded(recorder: Recorder) -> (Vec<State>, Histories, Simulation) {
    let mut simulation = simulation();
    let mut histories = recorder.start(&simulation).unwrap();
    let mut states = vec![simulation.state().clone()];
    simulation
        .run(STEPS, |state| {
            histories.record(state);
            states.push(state.clone());
        })
        .unwrap();
    (states, histories, simulation)
}

/// Everything once more, from the states and by other means.
#[test]
fn histories_and_peaks_are_those_of_the_states() {
    let (states, histories, simulation) = recorded(Recorder::new().contact(1));
    let elements = simulation.elements();
    let times: Vec<f64> = states.iter().map(|s| s.time).collect();
    assert_eq!(histories.times(), times);
    let shear: Vec<f64> = states.iter().map(|s| s.base_shear).collect();
    assert_eq!(histories.series(Quantity::BaseShear), shear);
    let rotation: Vec<f64> = states.iter().map(|s| s.base_rotation).collect();
    assert_eq!(histories.series(Quantity::BaseRotation), rotation);
    let top: Vec<f64> = states.iter().map(|s| s.probes[0]).collect();
    assert_eq!(histories.probe("top").unwrap(), top);
    assert_eq!(histories.ledgers()[STEPS], states[STEPS].ledger);

    let summary = histories.summary();
    let peak = (0..=STEPS).max_by(|&a, &b| shear[a].total_cmp(&shear[b])).unwrap();
    let found = summary.base_shear.highest;
    assert_eq!((found.value, found.time), (shear[peak], times[peak]));
    let lowest = shear.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(summary.base_shear.lowest.value, lowest);
    assert!(lowest < 0.0);
    let top_peak = top.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert_eq!(summary.probe("top").unwrap().largest().magnitude(), top_peak);

    for (e, envelope) in histories.envelope().iter().enumerate() {
        let pressures = || states.iter().map(|s| s.contact[e].pressure);
        assert_eq!(envelope.pressure.highest.value, pressures().fold(0.0, f64::max));
        assert_eq!(envelope.pressure.lowest.value, pressures().fold(1e99, f64::min));
        assert_eq!(envelope.static_pressure, states[0].contact[e].pressure);
        let gap = states.iter().map(|s| s.contact[e].gap).fold(-1e99, f64::max);
        assert_eq!(envelope.gap.value, gap);
        let open = states[1..].iter().filter(|s| !s.modes[e].is_closed()).count();
        assert!((envelope.open - open as f64 * simulation.time_step()).abs() < 1e-9);
        assert_eq!(envelope.element, elements[e]);
    }

    // Stretches of uplift as runs in a string.
    let letters: String =
        states[1..].iter().map(|s| if s.uplifted_fraction > 0.0 { 'u' } else { ' ' }).collect();
    let stretches: Vec<usize> = letters.split_whitespace().map(str::len).collect();
    let uplift = summary.uplift;
    let dt = simulation.time_step();
    assert!(stretches.len() > 2, "{letters}");
    assert_eq!(uplift.count, stretches.len());
    assert!((uplift.duration - dt * stretches.iter().sum::<usize>() as f64).abs() < 1e-9);
    assert!((uplift.longest - dt * *stretches.iter().max().unwrap() as f64).abs() < 1e-9);

    // Slip events as runs of letters for the direction.
    let letters: Vec<char> = states
        .windows(2)
        .map(|pair| {
            let closed: Vec<_> = pair[1].modes.iter().filter(|mode| mode.is_closed()).collect();
            let slides = !closed.is_empty() && closed.iter().all(|mode| mode.is_slip());
            match (slides, pair[1].mean_slip > pair[0].mean_slip) {
                (false, _) => ' ',
                (true, true) => 'r',
                (true, false) => 'l',
            }
        })
        .collect();
    let sliding = &summary.sliding;
    let events = letters.chunk_by(|a, b| a == b).filter(|run| run[0] != ' ').count();
    assert!(events > 2, "{letters:?}");
    assert_eq!(sliding.events.len(), events);
    let slid = letters.iter().filter(|&&letter| letter != ' ').count();
    assert!((sliding.duration - dt * slid as f64).abs() < 1e-9);
    assert_eq!(sliding.residual, states[STEPS].mean_slip);
    let way: f64 = sliding.events.iter().map(|event| event.slip.abs()).sum();
    assert!((way / sliding.path - 1.0).abs() < 1e-12);
    let peak = states.iter().fold(0.0_f64, |m, s| m.max(s.mean_slip.abs()));
    assert_eq!(sliding.peak.value.abs(), peak);

    // Safety from the resultants that the state has of its own.
    let half = 2.0;
    for (k, state) in states.iter().enumerate() {
        let sliding = FRICTION * state.normal_force / state.base_shear.abs();
        let overturning = state.normal_force * half / state.base_moment.abs();
        for (quantity, known) in
            [(Quantity::SlidingSafety, sliding), (Quantity::OverturningSafety, overturning)]
        {
            let found = histories.series(quantity)[k];
            if state.normal_force == 0.0 {
                assert!(found.is_nan());
                continue;
            }
            assert!(known > 1e6 || (found / known - 1.0).abs() < 1e-8, "{found} {known}");
            assert!(found > 1.0 - 1e-9);
        }
    }
    let least = summary.least_sliding_safety.unwrap();
    assert!((least.value - 1.0).abs() < 1e-9);

    // Energy: shares of the last ledger, which close.
    let shares = summary.energy.unwrap();
    let ledger = states[STEPS].ledger;
    assert_eq!(shares, EnergyShares::of(&ledger).unwrap());
    assert!((shares.sum() - 1.0).abs() < 1e-9);
    assert!((shares.contact * ledger.input / ledger.contact - 1.0).abs() < 1e-12);
    assert!(shares.soil > 0.05 && shares.contact > 0.05);

    // Frames are the states.
    let frames: Vec<_> = histories.contact_frames().collect();
    assert_eq!(frames.len(), STEPS + 1);
    assert!(frames.iter().zip(&states).all(|(f, s)| f.states == s.contact && f.modes == s.modes));
}

#[test]
fn thinned_histories_keep_the_peaks_of_all_steps() {
    let (states, histories, _) = recorded(Recorder::new().every(7).contact(20).motion(50));
    let (_, all, _) = recorded(Recorder::new());
    assert_eq!(histories.times().len(), 1 + STEPS / 7);
    for (k, &shear) in histories.series(Quantity::BaseShear).iter().enumerate() {
        assert_eq!(shear, states[7 * k].base_shear);
    }
    for quantity in Quantity::ALL {
        assert_eq!(histories.extremes(quantity), all.extremes(quantity));
    }
    assert_eq!(histories.envelope(), all.envelope());
    assert_eq!(histories.summary().sliding, all.summary().sliding);
    // Time, 11 scalars, 2 probes, 11 terms of the ledger.
    assert_eq!(all.bytes(), 8 * (1 + 11 + 2 + 11) * (STEPS + 1));
    assert!(histories.bytes() < all.bytes());
    assert_eq!(histories.contact_frames().count(), 21);
    let frames: Vec<_> = histories.motion_frames().collect();
    assert_eq!(frames.len(), 9);
    for (k, frame) in frames.iter().enumerate() {
        assert_eq!(frame.displacement, states[50 * k].displacement());
        assert_eq!(frame.velocity, states[50 * k].velocity());
    }
    assert!(matches!(histories.acceleration_record("top acceleration"), Err(Error::Scene { .. })));
}

/// A block with a steady horizontal force at its centre of gravity.
struct Pushed(RigidBlock, f64, f64);

impl Structure for Pushed {
    fn unknowns(&self) -> usize {
        self.0.unknowns()
    }
    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.0.contact_nodes()
    }
    fn mass(&self, matrix: &mut Triplets) {
        self.0.mass(matrix);
    }
    fn stiffness(&self, matrix: &mut Triplets) {
        self.0.stiffness(matrix);
    }
    fn load(&self, _time: f64, load: &mut [f64]) {
        for (unknown, weight) in self.0.horizontal_at(self.2) {
            load[unknown] += weight * self.1;
        }
    }
}

/// Pushed with H at height h, a block of weight W and width 2b stands with μW/H and Wb/(Hh).
#[test]
fn statics_of_a_pushed_block() {
    let block = RigidBlock::new(4.0, 3.0, 2000.0).unwrap();
    let weight = STANDARD_GRAVITY * block.total_mass();
    // The second one uplifts: eccentricity h/4 = 1.25 > b/3. The third must be held by tension.
    for (share, height, bonded) in [(0.2, 1.5, false), (0.25, 5.0, false), (0.5, 6.0, true)] {
        let builder = Simulation::builder(1e-3)
            .structure(Pushed(block.clone(), share * weight, height))
            .ground(SpringGround::new(-2.0..2.0, 40, 4e7, 2e7).unwrap())
            .motion(AtRest)
            .gravity(STANDARD_GRAVITY)
            .placement(Placement::WithInterfaceLaw);
        let builder = if bonded {
            builder.interface(Bonded)
        } else {
            builder.interface(Coulomb::new(0.6).unwrap())
        };
        let simulation = builder.build().unwrap();
        let histories = Recorder::new().friction(0.6).start(&simulation).unwrap();
        let value = |quantity| histories.series(quantity)[0];
        assert!((value(Quantity::SlidingSafety) * share / 0.6 - 1.0).abs() < 1e-6);
        assert!((value(Quantity::OverturningSafety) * share * height / 2.0 - 1.0).abs() < 1e-6);
        assert_eq!(value(Quantity::OverturningSafety) < 1.0, bonded);
        assert_eq!(value(Quantity::UpliftedFraction) > 0.0, height == 5.0);
    }
}

/// A light block, bonded to stiff ground, moves as the ground does: so do its floors' spectra.
#[test]
fn floors_of_a_light_rigid_block_ride_on_the_ground() {
    let ground = HalfPlaneGround::strip(Soil::new(2e9, 0.3, 2000.0).unwrap(), -2.0..2.0, 4);
    let block = RigidBlock::new(4.0, 1.0, 10.0).unwrap();
    let top = block.horizontal_at(1.0);
    let mut simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(ground.unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .probe(Probe::acceleration("top", top))
        .build()
        .unwrap();
    let mut histories = Recorder::new().start(&simulation).unwrap();
    let run = histories.run(&mut simulation, 1500).unwrap();
    assert_eq!(run.steps, 1500);
    let periods = log_spaced(0.2, 3.0, 12).unwrap();
    let floor = histories.floor_spectrum("top", &periods, 0.05).unwrap();
    let ground = el_centro_1940().response_spectrum(&periods, 0.05).unwrap();
    for (floor, ground) in floor.iter().zip(&ground) {
        let ratio = floor.pseudo_acceleration / ground.pseudo_acceleration;
        assert!((ratio - 1.0).abs() < 0.02, "T = {}: {ratio}", floor.period);
    }
    let record = histories.acceleration_record("top").unwrap();
    assert_eq!(record.accelerations(), histories.probe("top").unwrap());
}

/// As the guide words it: the peak at f_j is as wide as 0.85 f_j to 1.15 f_j, and its slopes go on
/// from there, every point of them moved as the peak is.
#[test]
fn broadened_peaks_are_plateaus() {
    let ordinate = |period: f64, value: f64| SpectralOrdinate {
        period,
        displacement: value,
        pseudo_velocity: 2.0 * value,
        pseudo_acceleration: 3.0 * value,
        acceleration: 4.0 * value,
    };
    // A triangle of height three over ln T, its top at f_j = 1 Hz.
    let shape = |period: f64| 3.0 - period.ln().abs();
    let periods = log_spaced(0.1, 10.0, 401).unwrap();
    let spectrum: Vec<_> = periods.iter().map(|&t| ordinate(t, shape(t))).collect();
    for (wide, &period) in broadened(&spectrum, 0.15).unwrap().iter().zip(&periods) {
        let frequency = 1.0 / period;
        let known = if (0.85..=1.15).contains(&frequency) {
            3.0
        } else if frequency < 0.85 {
            // What stood at the frequency f stands at 0.85 f now.
            shape(0.85 / frequency)
        } else {
            shape(1.15 / frequency)
        };
        assert!((wide.displacement - known).abs() < 1e-12, "{frequency}");
        assert_eq!(wide.acceleration, 4.0 * wide.displacement);
    }
    // A peak of one period: where it is seen.
    let mut lonely: Vec<_> = periods.iter().map(|&t| ordinate(t, 0.0)).collect();
    let spike = 200;
    lonely[spike] = ordinate(periods[spike], 1.0);
    for (wide, &period) in broadened(&lonely, 0.15).unwrap().iter().zip(&periods) {
        let share = periods[spike] / period;
        if (0.851..1.149).contains(&share) {
            assert_eq!(wide.displacement, 1.0, "{share}");
        } else if !(0.83..1.17).contains(&share) {
            assert_eq!(wide.displacement, 0.0, "{share}");
        }
    }
    assert_eq!(broadened(&spectrum, 0.0).unwrap(), spectrum);
    assert!(broadened(&[], 0.15).unwrap().is_empty());
    for share in [-0.1, 1.0, f64::NAN, f64::INFINITY] {
        assert!(broadened(&spectrum, share).is_err());
    }
    assert!(broadened(&[spectrum[1], spectrum[0]], 0.1).is_err());
    assert!(broadened(&[ordinate(f64::NAN, 1.0)], 0.1).is_err());
}

/// Values stay SI in files and turn into what engineers read where they are printed, a label that
/// nobody knows stays.
#[test]
fn probes_come_with_their_unit() {
    let build = || {
        scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION)).probes([
            Probe::displacement("slide", RigidBlock::HORIZONTAL),
            Probe::displacement("turn", RigidBlock::ROTATION).in_unit("rad"),
            Probe::velocity("rate", (RigidBlock::HORIZONTAL, 100.0)).in_unit("cm/s"),
            Probe::acceleration("shake", RigidBlock::HORIZONTAL),
            Probe::displacement("bare", RigidBlock::VERTICAL).in_unit(""),
        ])
    };
    let mut simulation = build().build().unwrap();
    let mut histories = Recorder::new().start(&simulation).unwrap();
    let run = histories.run(&mut simulation, STEPS).unwrap();
    let summary = histories.summary();
    let (page, mut table) = (summary.to_string(), Comparison::new());
    table.extend([("a", summary.clone())]);
    let (run_page, table_page) = (run.to_string(), table.to_string());
    let labels = [
        ("slide", "mm", 1e3),
        ("turn", "mrad", 1e3),
        ("rate", "cm/s", 1.0),
        ("shake", "m/s²", 1.0),
    ];
    for (name, unit, factor) in labels {
        let peak = run.probe(name).unwrap();
        assert_eq!(peak, summary.probe(name).unwrap().largest(), "{name}");
        assert!(peak.value != 0.0);
        for text in [&page, &run_page, &table_page] {
            let line = text.lines().find(|line| line.trim().starts_with(name)).unwrap();
            let words: Vec<&str> = line.split_whitespace().collect();
            assert!(words.contains(&unit), "{line}");
            let shown = |word: &&str| {
                let value: f64 = word.parse().unwrap_or(f64::NAN);
                (value - factor * peak.value).abs() < 1e-3 * factor * peak.magnitude()
            };
            assert!(words.iter().any(shown), "{line}, not {}", factor * peak.value);
        }
    }
    let mut file = Vec::new();
    histories.write_csv(&mut file).unwrap();
    let text = String::from_utf8(file).unwrap();
    let wanted = ",slide [m],turn [rad],rate [cm/s],shake [m/s²],bare,";
    assert!(text.lines().next().unwrap().contains(wanted));
    let csv = table.csv();
    assert!(csv.lines().next().unwrap().ends_with(wanted.trim_end_matches(',')));
    let last: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    let turn = run.probe("turn").unwrap().value;
    assert_eq!(last[last.len() - 4].parse(), Ok(turn));

    let nobody = Error::Name { quantity: "probe", name: "nobody".to_owned() };
    assert_eq!(run.probe("nobody"), Err(nobody.clone()));
    assert_eq!(summary.probe("nobody"), Err(nobody));
}

#[test]
fn cases_with_other_probes_or_units_have_no_common_rows() {
    let summary = |probe: Probe| {
        let builder = scene(SI, 0.6).structure(block(SI)).interface(friction(FRICTION));
        let simulation = builder.probe(probe).build().unwrap();
        Recorder::new().start(&simulation).unwrap().summary()
    };
    let tilt = || Probe::displacement("tilt", RigidBlock::ROTATION);
    let same: Comparison = ["a", "b"].map(|name| (name, summary(tilt()))).into_iter().collect();
    assert_eq!(same.cases().len(), 2);
    assert!(same.to_string().contains("tilt"));
    let mixed = [("a", summary(tilt())), ("b", summary(tilt().in_unit("rad")))];
    let mixed: Comparison = mixed.into_iter().collect();
    assert!(!mixed.to_string().contains("tilt") && !mixed.csv().contains("tilt"));
}

#[test]
fn pages_and_tables() {
    let (_, histories, _) = recorded(Recorder::new());
    let summary = histories.summary();
    let page = summary.to_string();
    println!("{page}");
    for words in [
        "Run of 400 steps",
        "Least factor of safety against sliding: 1.000",
        "slip events",
        "friction and impact",
        "Pressure under the base",
    ] {
        assert!(page.contains(words), "{words}\n{page}");
    }
    // No line too wide for a page.
    assert!(page.lines().all(|line| line.chars().count() <= 100), "{page}");

    let mut comparison = Comparison::new();
    comparison.add("first, \"a\"", summary.clone());
    comparison.add("second", summary.clone());
    println!("{comparison}");
    let csv = comparison.csv();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 3);
    let columns = lines[0].split(',').count();
    let values: Vec<&str> = lines[2].split(',').collect();
    assert_eq!(values.len(), columns);
    let column = lines[0].split(',').position(|name| name == "base_shear_n_per_m").unwrap();
    assert_eq!(values[column].parse(), Ok(summary.base_shear.largest().value));
    assert!(lines[1].starts_with("\"first, \"\"a\"\"\","));
    let text = comparison.to_string();
    assert!(text.lines().nth(2).unwrap().starts_with("base shear"));
    let markdown = comparison.markdown();
    assert!(markdown.lines().all(|line| line.matches('|').count() == 5), "{markdown}");
    // Nothing to compare is a table, too.
    assert!(Comparison::new().to_string().contains("base shear"));
    assert_eq!(Comparison::new().csv().lines().count(), 1);

    let mut file = Vec::new();
    histories.write_csv(&mut file).unwrap();
    let text = String::from_utf8(file).unwrap();
    assert_eq!(text.lines().count(), STEPS + 2);
    let columns = text.lines().next().unwrap().split(',').count();
    assert!(text.lines().all(|line| line.split(',').count() == columns));
    let last: Vec<&str> = text.lines().last().unwrap().split(',').collect();
    assert_eq!(last[1].parse(), Ok(histories.series(Quantity::BaseShear)[STEPS]));
}

/// GOAL: of two blocks the page tells of the one that is closer to falling over.
#[test]
fn factors_of_safety_are_those_of_the_worst_foundation() {
    let group = StructureGroup::new()
        .with(RigidBlock::new(2.0, 8.0, 2000.0).unwrap(), -2.0)
        .unwrap()
        .with(RigidBlock::new(2.0, 2.0, 2000.0).unwrap(), 2.0)
        .unwrap();
    let strips = [Strip::uniform(-3.0..-1.0, 6).unwrap(), Strip::uniform(1.0..3.0, 6).unwrap()];
    let soil = Soil::new(80.0e6, 0.3, 1900.0).unwrap();
    let mut simulation = Simulation::builder(0.005)
        .structure(group)
        .ground(HalfPlaneGround::new(soil, &strips).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
        .build()
        .unwrap();
    let mut histories = Recorder::new().start(&simulation).unwrap();
    let mut least = [f64::INFINITY; 2];
    let run = simulation.run(500, |state| {
        histories.record(state);
        for foundation in &state.foundations {
            // N b over the moment about the middle of its own base, and friction N over the shear.
            let safety = foundation.normal_force / foundation.moment.abs();
            least[0] = least[0].min(safety);
            least[1] = least[1].min(0.5 * foundation.normal_force / foundation.shear.abs());
        }
    });
    run.unwrap();
    let summary = histories.summary();
    let close = |found: f64, known: f64| (found / known - 1.0).abs() < 1e-9;
    assert!(close(summary.least_overturning_safety.value, least[0]));
    assert!(close(summary.least_sliding_safety.unwrap().value, least[1]));
    assert!(least[0] < 1.3);
}

/// A law of one's own whose coefficient is nonsense.
struct Nonsense(Coulomb);

impl InterfaceLaw for Nonsense {
    fn modes(&self) -> &[Mode] {
        self.0.modes()
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &StepStart,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.0.next_mode(mode, start, trial, tolerance)
    }

    fn friction(&self) -> Option<f64> {
        Some(f64::NAN)
    }
}

type Laws = Vec<Box<dyn InterfaceLaw>>;

/// GOAL: the factor of safety is made of the laws' own coefficients, element by element, unless the
/// recorder is told others; a base with an element that has none has no factor.
#[test]
fn friction_is_that_of_the_laws() {
    let coulomb = |friction| Coulomb::new(friction).unwrap();
    let layer = |friction| ThinLayer::new(soil(SI), 0.5, friction).unwrap();
    let start = |laws: Laws, recorder: Recorder| {
        let builder = scene(SI, 0.6).structure(block(SI)).interfaces(laws);
        let mut simulation = builder.build().unwrap();
        let mut histories = recorder.start(&simulation)?;
        histories.run(&mut simulation, 20).unwrap();
        Ok::<_, Error>(histories)
    };
    let count = simulation().elements().len();
    let each = |friction: &dyn Fn(usize) -> f64| -> Laws {
        (0..count).map(|e| Box::new(coulomb(friction(e))) as Box<dyn InterfaceLaw>).collect()
    };
    let graded = |e: usize| 0.3 + 0.01 * e as f64;
    // Without the static state, which has no shear.
    let factor = |histories: Result<Histories, Error>| {
        histories.unwrap().series(Quantity::SlidingSafety)[1..].to_vec()
    };
    let told = |laws: Laws| {
        let recorder = Recorder::new().frictions((0..count).map(graded).collect());
        factor(start(laws, recorder))
    };
    let read = |laws: Laws| factor(start(laws, Recorder::new()));
    let own = read(each(&graded));
    assert!(own.iter().all(|factor| factor.is_finite()));
    assert_eq!(own, told(each(&graded)));
    assert!(own.iter().zip(read(each(&|_| 0.3))).all(|(a, b)| *a > b));
    // One law for all; a layer; infinite friction.
    for law in [Box::new(coulomb(0.3)) as Box<dyn InterfaceLaw>, Box::new(layer(0.3))] {
        let factor = read(vec![law]);
        assert!(factor.iter().all(|factor| *factor >= 1.0 - 1e-9 && factor.is_finite()));
    }
    let unlimited = read(vec![Box::new(Coulomb::uplift_only())]);
    assert!(unlimited.iter().all(|factor| *factor == f64::INFINITY));
    // One bonded element: none, unless told.
    let mixed = || {
        let mut laws = each(&graded);
        laws[2] = Box::new(Bonded);
        laws
    };
    assert!(read(mixed()).iter().all(|factor| factor.is_nan()));
    assert!(start(mixed(), Recorder::new()).unwrap().summary().least_sliding_safety.is_none());
    assert!(told(mixed()).iter().all(|factor| factor.is_finite()));
    let fault = start(vec![Box::new(Nonsense(coulomb(0.3)))], Recorder::new());
    assert!(matches!(fault, Err(Error::Input { .. })));
}

#[test]
fn bad_requests_are_errors() {
    // A loop of one's own that forgets steps has no spectrum.
    let mut forgetful = simulation();
    let mut histories = Recorder::new().start(&forgetful).unwrap();
    histories.reserve(usize::MAX);
    for step in 0..200 {
        let state = forgetful.step().unwrap();
        if step % 2 == 1 {
            histories.record(state);
        }
    }
    let spectrum = histories.floor_spectrum("top acceleration", &[0.1, 0.2], 0.05);
    assert!(matches!(spectrum, Err(Error::Scene { .. })));

    let mut simulation = simulation();
    let start = |recorder: Recorder| recorder.start(&simulation);
    for coefficient in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        let fault = start(Recorder::new().friction(coefficient));
        assert!(matches!(fault, Err(Error::Input { .. })));
    }
    assert!(start(Recorder::new().friction(f64::INFINITY)).is_ok());
    let fault = start(Recorder::new().frictions(vec![0.4; 3]));
    assert!(matches!(fault, Err(Error::Size { found: 3, .. })));
    for recorder in
        [Recorder::new().every(0), Recorder::new().contact(0), Recorder::new().motion(0)]
    {
        assert!(matches!(start(recorder), Err(Error::Input { .. })));
    }
    let mut histories = start(Recorder::new()).unwrap();
    assert_eq!(
        histories.probe("nobody"),
        Err(Error::Name { quantity: "probe", name: "nobody".to_owned() })
    );
    assert!(histories.floor_spectrum("nobody", &[1.0], 0.05).is_err());
    assert!(histories.floor_spectrum("top", &[1.0], 0.05).is_err());
    // Nothing recorded yet: one sample is no record.
    assert!(histories.floor_spectrum("top acceleration", &[1.0], 0.05).is_err());
    for bad in [[0.0, 1.0], [1.0, f64::NAN], [f64::INFINITY, 1.0]] {
        assert!(log_spaced(bad[0], bad[1], 5).is_err());
    }
    assert!(log_spaced(1.0, 2.0, 1).is_err() && log_spaced(1.0, 2.0, usize::MAX).is_err());
    // The same state twice, and one of another scene.
    let state = simulation.step().unwrap().clone();
    histories.record(&state);
    histories.record(&state);
    let mut other = state.clone();
    other.time += 1.0;
    other.contact.pop();
    histories.record(&other);
    assert_eq!(histories.times().len(), 2);
    assert_eq!(histories.summary().steps, 1);
}
