//! GOAL: settings, states, results and records through a text format, and none that a constructor would
//! refuse.
//! SCENE: every type with a form; numbers that are not finite; fields missing, unknown or out of range.
//! REFERENCE: the value that was written.

use std::fmt::Debug;
use std::path::{Path, PathBuf};

use basemat::analyses::refine;
use basemat::bem::full_plane::CqMethod;
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::{ContactElement, Grading, SpringGround, Strip};
use basemat::contact::ContactSearch;
use basemat::coupled::{
    Checkpoint, Coordinates, DissipativeMidpoint, EnergyBalance, GravityStage, HhtAlpha, Midpoint,
    Newmark, Probe, Theta, Warning,
};
use basemat::fem::{Direction, Layer, MassKind, Material, Quad8Integration, QuadFormulation};
use basemat::history::HistoryMethod;
use basemat::interface::{
    Bonded, Cohesive, Coulomb, FrictionLimit, Mode, SlipSense, ThinLayer, UnilateralCondition,
    Yielding,
};
use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, Baseline, ColumnFormat, CosmosFormat,
    EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, Record, SlistFormat, SmcFormat,
    el_centro_1940,
};
use basemat::results::{Criterion, Peak, Quantity, Recorder, Run, Serviceability, TimeSeries};
use basemat::site::{ControlPoint, VerticalWave};
use basemat::soil::{
    Bedrock, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation,
    SoilProfile,
};
use basemat::structure::{
    BaseNode, DofCombination, IsolationLevel, ModalDamping, RayleighDamping, RigidBlock, Storey,
};
use basemat::{Complex, Simulation, Soil, unobserved};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Written and read again, a value is the same; with one more key anywhere it is refused.
#[track_caller]
fn kept<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) -> Value {
    let text = serde_json::to_string(value).unwrap();
    let read: T = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(&read, value, "{text}");
    let form = serde_json::from_str(&text).unwrap();
    closed::<T>(&form);
    form
}

/// No object within the form takes a key that it does not know: a misspelt optional one, say.
/// Returns how many objects there are.
#[track_caller]
fn closed<T: DeserializeOwned>(form: &Value) -> usize {
    fn with_stranger(value: &mut Value, place: &mut usize) {
        if let Value::Object(map) = value {
            if *place == 0 {
                map.insert("dampingx".to_owned(), json!(0.05));
            }
            *place = place.wrapping_sub(1);
        }
        match value {
            Value::Object(map) => map.values_mut().for_each(|value| with_stranger(value, place)),
            Value::Array(list) => list.iter_mut().for_each(|value| with_stranger(value, place)),
            _ => {}
        }
    }
    for place in 0.. {
        let mut other = form.clone();
        with_stranger(&mut other, &mut { place });
        if other == *form {
            return place;
        }
        assert!(serde_json::from_value::<T>(other.clone()).is_err(), "{other} is read");
    }
    unreachable!("every form ends")
}

/// As [`kept`], and written as `form`.
#[track_caller]
fn written<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T, form: impl Into<Value>) {
    assert_eq!(kept(value), form.into());
}

/// The form is not read: the error contains `reason`.
#[track_caller]
fn refused<T: DeserializeOwned + Debug>(form: Value, reason: &str) {
    let text = form.to_string();
    let error = serde_json::from_value::<T>(form).unwrap_err().to_string();
    assert!(error.contains(reason), "{text}: {error}");
}

#[test]
fn soils_materials_and_their_damping() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    written(&soil, json!({"shear_modulus": 80.0e6, "poisson": 0.33, "density": 1900.0}));
    let bad = |nu: f64| json!({"shear_modulus": 1.0, "poisson": nu, "density": 1.0});
    refused::<Soil>(bad(0.5), "Poisson's ratio of the soil is 0.5");
    refused::<Soil>(
        json!({"shear_modulus": -1.0, "poisson": 0.3, "density": 1.0}),
        "shear modulus",
    );
    refused::<Soil>(json!({"shear_modulus": 1.0, "poisson": 0.3}), "missing field `density`");
    let typo = json!({"shear_modulus": 1.0, "poisson": 0.3, "density": 1.0, "damping": 0.05});
    refused::<Soil>(typo, "unknown field `damping`");
    kept(&Material::new(200e9, 0.25, 0.0).unwrap());
    let bad = json!({"young_modulus": 0.0, "poisson": 0.3, "density": 1.0});
    refused::<Material>(bad, "Young's modulus is 0");
    kept(&Elastic);
    kept(&KelvinVoigt::with_ratio(0.05, 3.0).unwrap());
    refused::<KelvinVoigt>(json!({"time": -1.0}), "relaxation time");
    kept(&Kjartansson::new(0.05, 3.0).unwrap());
    refused::<Kjartansson>(json!({"exponent": 1.5, "reference": 1.0}), "exponent");
    refused::<Kjartansson>(json!({"exponent": 0.1, "reference": 0.0}), "reference frequency");
    kept(&Hysteretic::new(0.05).unwrap());
    refused::<Hysteretic>(json!({"ratio": 1.0}), "damping ratio");
    let fitted = GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0).unwrap();
    kept(&fitted);
    let bad = json!({"long_term": 1.0, "ratios": [-0.1], "rates": [1.0]});
    refused::<GeneralizedMaxwell>(bad, "ratio of a Maxwell mechanism");
    let bad = json!({"long_term": 1.0, "ratios": [0.1], "rates": []});
    refused::<GeneralizedMaxwell>(bad, "rates of a generalised Maxwell body");
}

/// One with the first number of a law of the crate.
#[derive(Debug)]
struct Own(Option<Vec<f64>>);

impl Relaxation for Own {
    fn modulus(&self, _: Complex) -> Complex {
        Complex::real(1.0)
    }
    fn identity(&self) -> Option<Vec<f64>> {
        self.0.clone()
    }
}

#[test]
fn profiles_with_every_law_of_the_crate() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let layer = |profile: SoilProfile| profile.with_layer(soil, 3.0).unwrap();
    let base = layer(
        SoilProfile::on_half_plane(soil).with_bedrock_damping(Hysteretic::new(0.02).unwrap()),
    );
    let profile = layer(base.with_damping(KelvinVoigt::with_ratio(0.05, 3.0).unwrap()));
    let profile = layer(profile.with_damping(Kjartansson::new(0.05, 3.0).unwrap()));
    let maxwell = GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0).unwrap();
    let profile = layer(profile.with_damping(maxwell));
    for profile in
        [profile, layer(SoilProfile::on_rigid_bedrock()), SoilProfile::on_half_plane(soil)]
    {
        let text = serde_json::to_string(&profile).unwrap();
        let read: SoilProfile = serde_json::from_str(&text).unwrap();
        let laws = |profile: &SoilProfile| {
            let layers = profile.layers().iter().map(|layer| Some(&layer.damping));
            let base = match profile.bedrock() {
                Bedrock::HalfPlane { damping, .. } => Some(damping),
                Bedrock::Rigid => None,
            };
            layers
                .chain([base])
                .map(|law| law.map(|law| law.identity().unwrap()))
                .collect::<Vec<_>>()
        };
        assert_eq!(laws(&read), laws(&profile));
        assert_eq!(format!("{read:?}"), format!("{profile:?}"));
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        assert!(closed::<SoilProfile>(&serde_json::to_value(&profile).unwrap()) > 2);
    }
    let rigid = json!({"layers": [], "bedrock": "rigid"});
    refused::<SoilProfile>(rigid, "list of soil layers has length 0");
    let constants = json!({"shear_modulus": 1e8, "poisson": 0.3, "density": 2e3});
    let layer = json!({"soil": constants, "thickness": -1.0, "damping": "elastic"});
    refused::<SoilProfile>(json!({"layers": [layer], "bedrock": "rigid"}), "thickness");

    for numbers in [None, Some(vec![]), Some(vec![17.0]), Some(vec![4.0, 1.0, 3.0, 0.1, 0.2, 0.3])]
    {
        let own = SoilProfile::on_half_plane(soil).with_bedrock_damping(Own(numbers));
        let error = serde_json::to_string(&own).unwrap_err().to_string();
        assert!(error.contains("damping law 'own law'"), "{error}");
    }
}

#[test]
fn interface_laws() {
    kept(&Bonded);
    let law = Coulomb::new(0.4).unwrap();
    let form = json!({"friction": 0.4, "tensile_strength": 0.0, "condition": "position"});
    written(&law, form);
    let rate = UnilateralCondition::Velocity { closed_below: 1e-3 };
    kept(&law.with_unilateral_condition(rate).unwrap().with_tensile_strength(1e3).unwrap());
    assert_eq!(kept(&Coulomb::uplift_only())["friction"], "inf");
    assert_eq!(serde_json::from_value::<Coulomb>(json!({"friction": 1})).unwrap().friction(), 1.0);
    refused::<Coulomb>(json!({"friction": -0.1}), "friction coefficient is -0.1");
    refused::<Coulomb>(json!({"friction": null}), "friction coefficient is NaN");
    refused::<Coulomb>(json!({"friction": "much"}), "expected a number, null");
    refused::<Coulomb>(json!({"friction": 0.1, "tensile_strength": -1.0}), "tensile strength");
    let bad = json!({"friction": 0.1, "condition": {"velocity": {"closed_below": -1.0}}});
    refused::<Coulomb>(bad, "gap below which");
    let form = json!({"tension": 1e5, "cohesion": 8e4, "friction": 0.6});
    written(&Cohesive::new(1e5, 8e4, 0.6).unwrap(), form);
    refused::<Cohesive>(
        json!({"tension": -1.0, "cohesion": 0.0, "friction": 0.6}),
        "tensile strength",
    );
    let form = json!({"bearing_pressure": 3e5, "friction": "inf"});
    written(&Yielding::new(3e5, f64::INFINITY).unwrap(), form);
    refused::<Yielding>(json!({"bearing_pressure": 0.0, "friction": 0.6}), "bearing pressure");
    let layer = ThinLayer::from_stiffness(1e9, 3e8, 0.4).unwrap();
    kept(&layer);
    let layer = layer.with_thickness_ratio(0.1).unwrap().with_debonded_ratio(0.0).unwrap();
    let layer = layer.with_slip_stiffness_ratio(0.5).unwrap().with_slip_sense(SlipSense::Velocity);
    let mut form = kept(&layer.with_friction_limit(FrictionLimit::Lagged));
    form["thickness_ratio"] = json!(0.0);
    refused::<ThinLayer>(form.clone(), "thickness ratio");
    (form["thickness_ratio"], form["debonded_ratio"]) = (json!(0.1), json!(2.0));
    refused::<ThinLayer>(form, "left in debonding");
}

#[test]
fn schemes_dampings_strips_and_limits() {
    kept(&Midpoint);
    kept(&Theta::new(0.6).unwrap());
    refused::<Theta>(json!({"theta": 0.4}), "theta is 0.4");
    kept(&Newmark::new(0.6, 0.4).unwrap());
    refused::<Newmark>(json!({"gamma": 0.5, "beta": 0.1}), "beta is 0.1");
    kept(&DissipativeMidpoint::new(0.7).unwrap());
    refused::<DissipativeMidpoint>(json!({"gamma": 0.4}), "gamma is 0.4");
    kept(&HhtAlpha::new(-0.1).unwrap());
    refused::<HhtAlpha>(json!({"alpha": 0.1}), "alpha is 0.1");
    kept(&RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2]).unwrap());
    refused::<RayleighDamping>(json!({"mass": -1.0, "stiffness": 0.0}), "mass-proportional");
    kept(&ModalDamping::new(&[0.05, 0.02]).unwrap());
    refused::<ModalDamping>(json!({"ratios": []}), "list of damping ratios");
    kept(&Strip::graded(-5.0..5.0, 7).unwrap());
    refused::<Strip>(json!({"nodes": [0.0, 1.0, 1.0]}), "length of a contact element");
    let limits =
        Serviceability { slip: Some(5e-3), rotation: Some(0.05), ..Serviceability::default() };
    kept(&limits);
    assert_eq!(
        serde_json::from_value::<Serviceability>(json!({})).unwrap(),
        Serviceability::default()
    );
    for name in ["slip", "gap", "uplifted_fraction", "rotation"] {
        refused::<Serviceability>(json!({ name: -1.0 }), "allowable");
        kept(&serde_json::from_value::<Serviceability>(json!({ name: 0.5 })).unwrap());
    }
    refused::<Serviceability>(json!({"slipp": 1.0}), "unknown field `slipp`");
    kept(&Recorder::new().every(2).contact(10));
    let recorder: Recorder = serde_json::from_value(json!({"motion": 5})).unwrap();
    assert_eq!(recorder, Recorder::new().motion(5));
    kept(&refine(4, 0.1, |elements, step| Ok(vec![elements as f64, step])).unwrap());
}

#[test]
fn choices_are_their_words() {
    use Mode::{
        Active, ActiveLeft, ActiveRight, Open, Slip, SlipLeft, SlipRight, Stick, Yield, YieldLeft,
        YieldRight, YieldSlip,
    };

    fn words<T: Serialize + DeserializeOwned + PartialEq + Debug + ToString>(all: &[T]) {
        for choice in all {
            written(choice, json!(choice.to_string()));
        }
    }
    words(&[Stick, SlipLeft, SlipRight, Open, Yield, YieldLeft, YieldRight, Slip, YieldSlip]);
    words(&[Active, ActiveLeft, ActiveRight]);
    words(&[
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
        HistoryMethod::Auto,
    ]);
    words(&[Grading::Uniform, Grading::Cosine]);
    words(&[GravityStage::Frictionless, GravityStage::Frictional, GravityStage::Unloaded]);
    words(&[Criterion::Slip, Criterion::Gap, Criterion::UpliftedFraction, Criterion::Rotation]);
    words(&[FrictionLimit::Total, FrictionLimit::Lagged, FrictionLimit::Static]);
    words(&[SlipSense::Inelastic, SlipSense::Velocity, SlipSense::LastVelocity]);
    words(&[MassKind::Consistent, MassKind::Lumped]);
    words(&[Direction::X, Direction::Y, Direction::Rotation]);
    words(&Quantity::ALL);
    words(&[
        AccelerationUnit::MetrePerSecondSquared,
        AccelerationUnit::MillimetrePerSecondSquared,
        AccelerationUnit::StandardGravity,
    ]);
    words(&[
        AccelerationUnit::Gal,
        AccelerationUnit::FootPerSecondSquared,
        AccelerationUnit::InchPerSecondSquared,
    ]);
    words(&[Coordinates::Auto, Coordinates::Physical, Coordinates::Modes]);
    words(&[Baseline::None, Baseline::RemoveMean, Baseline::NewmarkParabola]);
    written(&Coordinates::Reduced { tolerance: 1e-6 }, json!({"reduced": {"tolerance": 1e-6}}));
    written(&ContactSearch::FlowChart { iterations: 9 }, json!({"flow_chart": {"iterations": 9}}));
    written(&Baseline::RestToRest { degree: 4 }, json!({"rest_to_rest": {"degree": 4}}));
    kept(&[QuadFormulation::Full, QuadFormulation::default()]);
    kept(&[Quad8Integration::Full, Quad8Integration::Reduced]);
    kept(&(CqMethod::Bdf1, Stages::Three, StripContact::Relaxed));
    kept(&(VerticalWave::Pressure, ControlPoint::Within));
}

#[test]
fn probes_storeys_layers_and_formats_of_files() {
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    kept(&Probe::absolute_displacement("top", block.horizontal_at(6.0)).in_unit("mm"));
    let form = json!({"name": "roof", "unit": "m/s²", "acceleration": [[7, 1.0]]});
    let probe: Probe = serde_json::from_value(form).unwrap();
    assert_eq!(probe, Probe::acceleration("roof", 7));
    refused::<Probe>(json!({"nam": "roof"}), "unknown field `nam`");
    written(&DofCombination::from([(3, 1.0), (0, -0.5)]), json!([[3, 1.0], [0, -0.5]]));
    let storey = json!({"height": 3.0, "mass": 2e4, "stiffness": 4e7});
    assert_eq!(serde_json::from_value::<Storey>(storey).unwrap(), Storey::new(3.0, 2e4, 4e7));
    kept(&Storey::new(3.0, 2e4, 4e7));
    kept(&IsolationLevel { height: 0.5, slab_mass: 1e4, slab_inertia: 0.0, damping: 9e4 });
    let (material, formulation) =
        (Material::new(3e10, 0.2, 2400.0).unwrap(), QuadFormulation::Full);
    kept(&Layer { height: 1.0, rows: 2, material, formulation });
    kept(&BaseNode::rigid_base(-1.0, 1.0, [0, 1, 2]));
    kept(&ContactElement::new(-1.0, 1.0));
    kept(&ColumnFormat {
        time_column: 2,
        acceleration_column: Some(3),
        samples: Some(7),
        header_lines: 5,
        ..ColumnFormat::new(AccelerationUnit::Gal)
    });
    kept(&ColumnFormat::equally_spaced(AccelerationUnit::StandardGravity, 0.02));
    let along = AlongLinesFormat::new(AccelerationUnit::Gal, 0.02);
    kept(&AlongLinesFormat { layout: "1P8E10.3".parse().ok(), samples: Some(7), ..along });
    kept(&SlistFormat { component: 2, unit: None });
    kept(&CosmosFormat { channel: 2, unit: Some(AccelerationUnit::Gal) });
    kept(&(PeerFormat, KNetFormat, EsmFormat, SmcFormat));
    kept(&(AfadFormat { component: 2 }, KNetCsvFormat { component: 3 }, GeoNetFormat::default()));
}

#[test]
fn records_are_their_samples() {
    let record = el_centro_1940();
    let form = kept(&record);
    assert_eq!(form.as_object().unwrap().keys().collect::<Vec<_>>(), ["acceleration", "time_step"]);
    kept(&record.response_spectrum(&[0.2, 1.0], 0.05, &mut unobserved).unwrap());
    for (bad, reason) in [
        (json!({"time_step": 0.0, "acceleration": [0.0, 1.0]}), "time step of the record is 0"),
        (json!({"time_step": 0.1, "acceleration": [0.0]}), "has length 1, but must have 2"),
        (json!({"time_step": 0.1, "acceleration": [0.0, null]}), "invalid type: null"),
        (json!({"time_step": 1e200, "acceleration": [0.0, 1e200]}), "of the record is inf"),
    ] {
        refused::<Record>(bad, reason);
    }
}

/// GOAL: the rule of [`closed`] for every type, those among them that only long computations give.
/// REFERENCE: the attributes in the sources.
#[test]
fn every_type_that_is_read_is_closed() {
    fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                sources(&path, all);
            } else {
                all.push(path);
            }
        }
    }
    let mut files = Vec::new();
    for folder in ["../src", "../crates"] {
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    }
    files.retain(|file| file.extension().is_some_and(|kind| kind == "rs"));
    let mut types = 0;
    for file in files {
        // Types within macros are indented.
        let text = std::fs::read_to_string(&file).unwrap();
        let text: String = text.lines().flat_map(|line| [line.trim_start(), "\n"]).collect();
        for derived in
            text.split("Deserialize))]\n").skip(1).chain(text.split("Deserialize)]\n").skip(1))
        {
            types += 1;
            let (attributes, body) = derived.split_once(" {").unwrap_or((derived, ""));
            let body = body.split("\n}").next().unwrap_or_default();
            let rules = ["deny_unknown_fields", "try_from", "transparent"];
            let is_enum = attributes.contains("enum ");
            let has_fields = !is_enum || body.lines().any(|line| line.ends_with(" {"));
            let is_unit = attributes.lines().any(|line| line.ends_with(';'));
            let closed = rules.iter().any(|rule| attributes.contains(rule));
            assert!(closed || is_unit || !has_fields, "{}: {attributes}", file.display());
        }
    }
    assert!(types > 80, "{types}");
}

/// A run with uplift, sliding, probes, limits, warnings and factors of safety that are not finite.
fn run() -> (Simulation, Run) {
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let mut simulation = Simulation::builder(0.08)
        .probe(Probe::displacement("top", block.horizontal_at(6.0)))
        .probe(Probe::acceleration("roof", block.horizontal_at(6.0)))
        .structure(block)
        .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7).unwrap())
        .interface(Coulomb::new(0.3).unwrap())
        .serviceability(Serviceability { slip: Some(1e-3), ..Serviceability::default() })
        .motion(el_centro_1940())
        .build()
        .unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    (simulation, run)
}

#[test]
fn runs_with_all_that_is_in_them() {
    let (simulation, run) = run();
    let text = serde_json::to_string(&run).unwrap();
    let mut read: Run = serde_json::from_str(&text).unwrap();
    assert!(closed::<Run>(&serde_json::from_str(&text).unwrap()) > 20);
    closed::<Checkpoint>(&serde_json::to_value(simulation.checkpoint().unwrap()).unwrap());
    assert_eq!(serde_json::to_string(&read).unwrap(), text);
    assert_eq!(read.to_string(), run.to_string());
    assert_eq!((read.wall, read.energy_balance), (run.wall, run.energy_balance));
    assert!(
        !run.foundations[0].sliding.events.is_empty()
            && !run.warnings.is_empty()
            && run.whole.uplift.count > 0
    );
    for foundation in &run.foundations {
        kept(foundation);
    }
    kept(&(run.whole.base_shear, run.whole.uplift, run.whole.sliding.clone(), run.fallbacks));
    kept(&(run.envelope.clone(), run.probes.clone(), run.serviceability.clone()));
    kept(&run.warnings);
    kept(&simulation.conditioning());

    // It is closed: no state counts, and nothing is lost when it is ended again.
    read.record(simulation.state());
    assert_eq!(read.steps, run.steps);
    let ended = simulation.end_run(read);
    assert_eq!(serde_json::to_string(&ended).unwrap(), text);
}

#[test]
fn time_series_with_all_that_is_in_them() {
    let (mut simulation, _) = run();
    let mut series = Recorder::new().contact(2).motion(5).start(&simulation).unwrap();
    simulation.run(40, |state| series.record(state)).unwrap();
    let form = serde_json::to_value(&series).unwrap();
    assert!(closed::<TimeSeries>(&form) > 20);
    let mut read: TimeSeries = serde_json::from_value(form.clone()).unwrap();
    assert_eq!(serde_json::to_value(&read).unwrap(), form);
    assert_eq!(read.times(), series.times());
    let safety = Quantity::OverturningSafety;
    assert_eq!(read.series(safety), series.series(safety));
    assert_eq!(read.contact_frames().count(), 21);
    assert!(read.contact_frames().eq(series.contact_frames()));
    assert!(read.motion_frames().eq(series.motion_frames()));
    // Its end is known: an acceleration still has a record if every step is there.
    let record = |own: &TimeSeries| own.acceleration_record("roof").map(|own| own.len());
    assert_eq!(record(&read), Ok(41));
    let mut later = form.clone();
    later["end"] = json!(series.times()[40] + 1.0);
    assert!(record(&serde_json::from_value(later).unwrap()).is_err());
    // It takes no more steps, and lists of other lengths are refused.
    simulation.step().unwrap();
    read.record(simulation.state()).unwrap();
    assert_eq!(read.times().len(), 41);
    for (list, reason) in [
        ("times", "list of energy balances has length 41, but must have 40"),
        ("scalars", "list of scalars has length 10, but must have 11"),
        ("probe_values", "list of probes has length 1, but must have 2"),
        ("energy_balances", "list of energy balances has length 40, but must have 41"),
        ("elements", "whole frames"),
    ] {
        let mut short = form.clone();
        short[list].as_array_mut().unwrap().pop().unwrap();
        let error = serde_json::from_value::<TimeSeries>(short).unwrap_err().to_string();
        assert!(error.contains(reason), "{list}: {error}");
    }
    let mut short = form;
    short["probe_values"][0].as_array_mut().unwrap().pop().unwrap();
    assert!(serde_json::from_value::<TimeSeries>(short).is_err());
}

#[test]
fn states_are_written() {
    let (simulation, _) = run();
    let state = simulation.state();
    let form = serde_json::to_value(state).unwrap();
    assert_eq!(form["time"], json!(state.time));
    assert_eq!(form["probes"], json!(state.probes));
    assert_eq!(form["contact"][3]["pressure"], json!(state.contact[3].pressure));
    assert_eq!(form["modes"][0], json!(state.modes[0].to_string()));
    assert_eq!(form["foundations"][0]["elements"], json!({"start": 0, "end": 8}));
    for hidden in ["origin", "probe_names", "motion", "start"] {
        assert!(form.get(hidden).is_none(), "{hidden}");
    }
    kept(&state.foundations);
    kept(&state.contact);
}

#[test]
fn numbers_that_are_not_finite() {
    for (value, form) in [
        (f64::INFINITY, json!("inf")),
        (f64::NEG_INFINITY, json!("-inf")),
        (-0.0, json!(-0.0)),
        (1.0 / 3.0, json!(1.0 / 3.0)),
    ] {
        written(&Peak { value, time: 0.0 }, json!({"value": form, "time": 0.0}));
    }
    let peak: Peak = serde_json::from_value(json!({"value": null, "time": 3})).unwrap();
    assert!(peak.value.is_nan() && peak.time == 3.0);
    assert_eq!(serde_json::to_value(peak).unwrap(), json!({"value": null, "time": 3.0}));
    let warning: Vec<Warning> =
        serde_json::from_value(json!([{"energy_balance": {"residual": "inf"}}])).unwrap();
    assert_eq!(warning, [Warning::EnergyBalance { residual: f64::INFINITY }]);

    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(block)
        .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .without_energy_balance()
        .build()
        .unwrap();
    let energy_balance = simulation.state().energy_balance;
    assert!(energy_balance.input.is_nan());
    assert_eq!(kept(&energy_balance)["input"], Value::Null);
    let (mut form, given) = (kept(&EnergyBalance::default()), json!("inf"));
    form["soil"] = given;
    assert_eq!(serde_json::from_value::<EnergyBalance>(form).unwrap().soil, f64::INFINITY);
}
