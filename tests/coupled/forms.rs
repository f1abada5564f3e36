//! GOAL: settings and records are read as they were written, with the errors of their constructors.
//! SCENE: every such type; fields that are missing, unknown or out of range.
//! REFERENCE: the value that was written.

use std::fmt::Debug;

use basemat::analyses::refine;
use basemat::bem::full_plane::CqMethod;
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::{ContactElement, Grading, Strip};
use basemat::contact::ContactSearch;
use basemat::coupled::{
    Coordinates, DissipativeMidpoint, GravityStage, HhtAlpha, Midpoint, Newmark, Probe, Theta,
};
use basemat::fem::{
    Direction, DruckerPrager, Iwan, Layer, MassKind, Material, Quad8Integration, QuadFormulation,
};
use basemat::history::HistoryMethod;
use basemat::interface::{
    Bonded, Cohesive, Coulomb, CyclicYielding, FrictionLimit, Mode, SlipSense, ThinLayer,
    UnilateralCondition, Yielding,
};
use basemat::motion::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, Baseline, ColumnFormat, CosmosFormat,
    EsmFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, PeerFormat, Record, SlistFormat, SmcFormat,
    el_centro_1940,
};
use basemat::results::{Criterion, Quantity, Recorder, Serviceability};
use basemat::site::{ControlPoint, VerticalWave};
use basemat::soil::{Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson};
use basemat::structure::{
    BaseNode, DofCombination, IsolationLevel, ModalDamping, RayleighDamping, RigidBlock, Storey,
};
use basemat::{Soil, unobserved};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Writes and reads a value, which must not change, and returns its form.
///
/// A form with one more key at any place must be an error.
#[track_caller]
pub(super) fn assert_round_trip<T: Serialize + DeserializeOwned + PartialEq + Debug>(
    value: &T,
) -> Value {
    let text = serde_json::to_string(value).unwrap();
    let value_read: T =
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(&value_read, value, "{text}");
    let form = serde_json::from_str(&text).unwrap();
    count_closed_objects::<T>(&form);
    form
}

/// Number of objects within the form, none of which may accept an unknown key, such as a misspelt one.
#[track_caller]
pub(super) fn count_closed_objects<T: DeserializeOwned>(form: &Value) -> usize {
    /// Adds an unknown key to the object of this index, in order of depth.
    fn add_unknown_key(value: &mut Value, index: &mut usize) {
        if let Value::Object(map) = value {
            if *index == 0 {
                map.insert("dampingx".to_owned(), json!(0.05));
            }
            *index = index.wrapping_sub(1);
        }
        match value {
            Value::Object(map) => map.values_mut().for_each(|value| add_unknown_key(value, index)),
            Value::Array(list) => list.iter_mut().for_each(|value| add_unknown_key(value, index)),
            _ => {}
        }
    }

    for index in 0.. {
        let mut misspelt_form = form.clone();
        add_unknown_key(&mut misspelt_form, &mut { index });
        if misspelt_form == *form {
            return index;
        }
        assert!(
            serde_json::from_value::<T>(misspelt_form.clone()).is_err(),
            "{misspelt_form} is read"
        );
    }
    unreachable!("every form ends")
}

/// Checks a value as [`assert_round_trip`] does, and that it is written as `form`.
#[track_caller]
pub(super) fn assert_form<T: Serialize + DeserializeOwned + PartialEq + Debug>(
    value: &T,
    form: impl Into<Value>,
) {
    assert_eq!(assert_round_trip(value), form.into());
}

/// Checks that reading the form returns an error that contains `reason`.
#[track_caller]
pub(super) fn assert_errors<T: DeserializeOwned + Debug>(form: Value, reason: &str) {
    let text = form.to_string();
    let error = serde_json::from_value::<T>(form).unwrap_err().to_string();
    assert!(error.contains(reason), "{text}: {error}");
}

#[test]
fn soils_materials_and_their_damping() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    assert_form(&soil, json!({"shear_modulus": 80.0e6, "poisson": 0.33, "density": 1900.0}));
    let incompressible = json!({"shear_modulus": 1.0, "poisson": 0.5, "density": 1.0});
    assert_errors::<Soil>(incompressible, "Poisson's ratio of the soil is 0.5");
    assert_errors::<Soil>(
        json!({"shear_modulus": -1.0, "poisson": 0.3, "density": 1.0}),
        "shear modulus",
    );
    assert_errors::<Soil>(json!({"shear_modulus": 1.0, "poisson": 0.3}), "missing field `density`");
    let typo = json!({"shear_modulus": 1.0, "poisson": 0.3, "density": 1.0, "damping": 0.05});
    assert_errors::<Soil>(typo, "unknown field `damping`");
    assert_round_trip(&Material::new(200e9, 0.25, 0.0).unwrap());
    let invalid_form = json!({"young_modulus": 0.0, "poisson": 0.3, "density": 1.0});
    assert_errors::<Material>(invalid_form, "Young's modulus is 0");
    let clay = Iwan::new(&[[1e-3, 2.0e4], [1e-2, 5.0e4]], 0.45, 1800.0).unwrap();
    let points = json!([[1e-3, 2.0e4], [1e-2, 5.0e4]]);
    assert_form(&clay, json!({"points": points, "poisson": 0.45, "density": 1800.0}));
    assert_errors::<Iwan>(
        json!({"points": [[1e-3, 2.0e4], [2e-3, 5.0e4]], "poisson": 0.45, "density": 1800.0}),
        "point 2 of the backbone: slope",
    );
    let elastic = Material::new(8.0e7, 0.3, 1900.0).unwrap();
    assert_round_trip(&DruckerPrager::new(elastic, 1.0e3, 0.6, 0.1).unwrap());
    let elastic = json!({"young_modulus": 8.0e7, "poisson": 0.3, "density": 1900.0});
    assert_errors::<DruckerPrager>(
        json!({"elastic": elastic, "cohesion": 0.0, "friction_angle": 0.5, "dilation_angle": 0.6}),
        "dilation angle of the soil (rad) is 0.6",
    );
    assert_round_trip(&Elastic);
    assert_round_trip(&KelvinVoigt::with_ratio(0.05, 3.0).unwrap());
    assert_errors::<KelvinVoigt>(json!({"time": -1.0}), "relaxation time");
    assert_round_trip(&Kjartansson::new(0.05, 3.0).unwrap());
    assert_errors::<Kjartansson>(json!({"exponent": 1.5, "reference": 1.0}), "exponent");
    assert_errors::<Kjartansson>(json!({"exponent": 0.1, "reference": 0.0}), "reference frequency");
    assert_round_trip(&Hysteretic::new(0.05).unwrap());
    assert_errors::<Hysteretic>(json!({"ratio": 1.0}), "damping ratio");
    let fitted_law = GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0).unwrap();
    assert_round_trip(&fitted_law);
    let invalid_form = json!({"long_term": 1.0, "ratios": [-0.1], "rates": [1.0]});
    assert_errors::<GeneralizedMaxwell>(invalid_form, "ratio of a Maxwell mechanism");
    let invalid_form = json!({"long_term": 1.0, "ratios": [0.1], "rates": []});
    assert_errors::<GeneralizedMaxwell>(invalid_form, "rates of a generalised Maxwell body");
}

#[test]
fn interface_laws() {
    assert_round_trip(&Bonded);
    let law = Coulomb::new(0.4).unwrap();
    let form = json!({"friction": 0.4, "tensile_strength": 0.0, "condition": "position"});
    assert_form(&law, form);
    let rate = UnilateralCondition::Velocity { closed_below: 1e-3 };
    assert_round_trip(
        &law.with_unilateral_condition(rate).unwrap().with_tensile_strength(1e3).unwrap(),
    );
    assert_eq!(assert_round_trip(&Coulomb::uplift_only())["friction"], "inf");
    assert_eq!(serde_json::from_value::<Coulomb>(json!({"friction": 1})).unwrap().friction(), 1.0);
    assert_errors::<Coulomb>(json!({"friction": -0.1}), "friction coefficient is -0.1");
    assert_errors::<Coulomb>(json!({"friction": null}), "friction coefficient is NaN");
    assert_errors::<Coulomb>(json!({"friction": "much"}), "expected a number, null");
    assert_errors::<Coulomb>(
        json!({"friction": 0.1, "tensile_strength": -1.0}),
        "tensile strength",
    );
    let invalid_form = json!({"friction": 0.1, "condition": {"velocity": {"closed_below": -1.0}}});
    assert_errors::<Coulomb>(invalid_form, "gap below which");
    let form = json!({"tension": 1e5, "cohesion": 8e4, "friction": 0.6});
    assert_form(&Cohesive::new(1e5, 8e4, 0.6).unwrap(), form);
    assert_errors::<Cohesive>(
        json!({"tension": -1.0, "cohesion": 0.0, "friction": 0.6}),
        "tensile strength",
    );
    let form = json!({"bearing_pressure": 3e5, "friction": "inf"});
    assert_form(&Yielding::new(3e5, f64::INFINITY).unwrap(), form);
    assert_errors::<Yielding>(
        json!({"bearing_pressure": 0.0, "friction": 0.6}),
        "bearing pressure",
    );
    let law = CyclicYielding::new(3e5, 5e-3, f64::INFINITY).unwrap();
    let mut form = json!({
        "bearing_pressure": 3e5, "reference_settlement": 5e-3, "elastic_range": 1.0,
        "depth_gradient": 0.0, "friction": "inf",
    });
    assert_form(&law, form.clone());
    form["elastic_range"] = json!(0.0);
    assert_errors::<CyclicYielding>(form.clone(), "elastic range");
    form["elastic_range"] = json!(0.1);
    form["depth_gradient"] = json!(-1.0);
    assert_errors::<CyclicYielding>(form.clone(), "growth of the bearing pressure");
    form["depth_gradient"] = json!(1e6);
    form["reference_settlement"] = json!(-1.0);
    assert_errors::<CyclicYielding>(form, "reference settlement");
    let layer = ThinLayer::from_stiffness(1e9, 3e8, 0.4).unwrap();
    assert_round_trip(&layer);
    let layer = layer.with_thickness_ratio(0.1).unwrap().with_debonded_ratio(0.0).unwrap();
    let layer = layer.with_slip_stiffness_ratio(0.5).unwrap().with_slip_sense(SlipSense::Velocity);
    let mut form = assert_round_trip(&layer.with_friction_limit(FrictionLimit::Lagged));
    form["thickness_ratio"] = json!(0.0);
    assert_errors::<ThinLayer>(form.clone(), "thickness ratio");
    form["thickness_ratio"] = json!(0.1);
    form["debonded_ratio"] = json!(2.0);
    assert_errors::<ThinLayer>(form, "left in debonding");
}

#[test]
fn schemes_dampings_strips_and_limits() {
    assert_round_trip(&Midpoint);
    assert_round_trip(&Theta::new(0.6).unwrap());
    assert_errors::<Theta>(json!({"theta": 0.4}), "theta is 0.4");
    assert_round_trip(&Newmark::new(0.6, 0.4).unwrap());
    assert_errors::<Newmark>(json!({"gamma": 0.5, "beta": 0.1}), "beta is 0.1");
    assert_round_trip(&DissipativeMidpoint::new(0.7).unwrap());
    assert_errors::<DissipativeMidpoint>(json!({"gamma": 0.4}), "gamma is 0.4");
    assert_round_trip(&HhtAlpha::new(-0.1).unwrap());
    assert_errors::<HhtAlpha>(json!({"alpha": 0.1}), "alpha is 0.1");
    assert_round_trip(&RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2]).unwrap());
    assert_errors::<RayleighDamping>(json!({"mass": -1.0, "stiffness": 0.0}), "mass-proportional");
    assert_round_trip(&ModalDamping::new(&[0.05, 0.02]).unwrap());
    assert_errors::<ModalDamping>(json!({"ratios": []}), "list of damping ratios");
    assert_round_trip(&Strip::graded(-5.0..5.0, 7).unwrap());
    assert_errors::<Strip>(json!({"nodes": [0.0, 1.0, 1.0]}), "length of a contact element");
    let limits =
        Serviceability { slip: Some(5e-3), rotation: Some(0.05), ..Serviceability::default() };
    assert_round_trip(&limits);
    assert_eq!(
        serde_json::from_value::<Serviceability>(json!({})).unwrap(),
        Serviceability::default()
    );
    for name in ["slip", "gap", "uplifted_fraction", "rotation"] {
        assert_errors::<Serviceability>(json!({ name: -1.0 }), "allowable");
        assert_round_trip(&serde_json::from_value::<Serviceability>(json!({ name: 0.5 })).unwrap());
    }
    assert_errors::<Serviceability>(json!({"slipp": 1.0}), "unknown field `slipp`");
    assert_round_trip(&Recorder::new().every(2).contact(10));
    let recorder: Recorder = serde_json::from_value(json!({"motion": 5})).unwrap();
    assert_eq!(recorder, Recorder::new().motion(5));
    assert_round_trip(&refine(4, 0.1, |elements, step| Ok(vec![elements as f64, step])).unwrap());
}

#[test]
fn choices_are_written_as_their_words() {
    use Mode::{
        Active, ActiveLeft, ActiveRight, Open, Slip, SlipLeft, SlipRight, Stick, Yield, YieldLeft,
        YieldRight, YieldSlip,
    };

    fn assert_words<T: Serialize + DeserializeOwned + PartialEq + Debug + ToString>(choices: &[T]) {
        for choice in choices {
            assert_form(choice, json!(choice.to_string()));
        }
    }
    assert_words(&[
        Stick, SlipLeft, SlipRight, Open, Yield, YieldLeft, YieldRight, Slip, YieldSlip,
    ]);
    assert_words(&[Active, ActiveLeft, ActiveRight]);
    assert_words(&[
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
        HistoryMethod::Auto,
    ]);
    assert_words(&[Grading::Uniform, Grading::Cosine]);
    assert_words(&[GravityStage::Frictionless, GravityStage::Frictional, GravityStage::Unloaded]);
    assert_words(&[
        Criterion::Slip,
        Criterion::Gap,
        Criterion::UpliftedFraction,
        Criterion::Rotation,
    ]);
    assert_words(&[FrictionLimit::Total, FrictionLimit::Lagged, FrictionLimit::Static]);
    assert_words(&[SlipSense::Inelastic, SlipSense::Velocity, SlipSense::LastVelocity]);
    assert_words(&[MassKind::Consistent, MassKind::Lumped]);
    assert_words(&[Direction::X, Direction::Y, Direction::Rotation]);
    assert_words(&Quantity::ALL_QUANTITIES);
    assert_words(&[
        AccelerationUnit::MetrePerSecondSquared,
        AccelerationUnit::MillimetrePerSecondSquared,
        AccelerationUnit::StandardGravity,
    ]);
    assert_words(&[
        AccelerationUnit::Gal,
        AccelerationUnit::FootPerSecondSquared,
        AccelerationUnit::InchPerSecondSquared,
    ]);
    assert_words(&[Coordinates::Auto, Coordinates::Physical, Coordinates::Modes]);
    assert_words(&[Baseline::None, Baseline::RemoveMean, Baseline::NewmarkParabola]);
    assert_form(&Coordinates::Reduced { tolerance: 1e-6 }, json!({"reduced": {"tolerance": 1e-6}}));
    assert_form(
        &ContactSearch::FlowChart { iterations: 9 },
        json!({"flow_chart": {"iterations": 9}}),
    );
    assert_form(&Baseline::RestToRest { degree: 4 }, json!({"rest_to_rest": {"degree": 4}}));
    assert_round_trip(&[QuadFormulation::Full, QuadFormulation::default()]);
    assert_round_trip(&[Quad8Integration::Full, Quad8Integration::Reduced]);
    assert_round_trip(&(CqMethod::Bdf1, Stages::Three, StripContact::Relaxed));
    assert_round_trip(&(VerticalWave::Pressure, ControlPoint::Within));
}

#[test]
fn probes_storeys_layers_and_formats_of_files() {
    let block = RigidBlock::new(4.0, 6.0, 2000.0).unwrap();
    assert_round_trip(&Probe::absolute_displacement("top", block.horizontal_at(6.0)).in_unit("mm"));
    let form = json!({"name": "roof", "unit": "m/s²", "acceleration": [[7, 1.0]]});
    let probe: Probe = serde_json::from_value(form).unwrap();
    assert_eq!(probe, Probe::acceleration("roof", 7));
    assert_errors::<Probe>(json!({"nam": "roof"}), "unknown field `nam`");
    assert_form(&DofCombination::from([(3, 1.0), (0, -0.5)]), json!([[3, 1.0], [0, -0.5]]));
    let storey = json!({"height": 3.0, "mass": 2e4, "stiffness": 4e7});
    assert_eq!(serde_json::from_value::<Storey>(storey).unwrap(), Storey::new(3.0, 2e4, 4e7));
    assert_round_trip(&Storey::new(3.0, 2e4, 4e7));
    assert_round_trip(&IsolationLevel {
        height: 0.5,
        slab_mass: 1e4,
        slab_inertia: 0.0,
        damping: 9e4,
    });
    let material = Material::new(3e10, 0.2, 2400.0).unwrap();
    let formulation = QuadFormulation::Full;
    assert_round_trip(&Layer { height: 1.0, rows: 2, material, formulation });
    assert_round_trip(&BaseNode::rigid_base(-1.0, 1.0, [0, 1, 2]));
    assert_round_trip(&ContactElement::new(-1.0, 1.0));
    assert_round_trip(&ColumnFormat {
        time_column: 2,
        acceleration_column: Some(3),
        samples: Some(7),
        header_lines: 5,
        ..ColumnFormat::new(AccelerationUnit::Gal)
    });
    assert_round_trip(&ColumnFormat::equally_spaced(AccelerationUnit::StandardGravity, 0.02));
    assert_round_trip(&AlongLinesFormat {
        layout: "1P8E10.3".parse().ok(),
        samples: Some(7),
        ..AlongLinesFormat::new(AccelerationUnit::Gal, 0.02)
    });
    assert_round_trip(&SlistFormat { component: 2, unit: None });
    assert_round_trip(&CosmosFormat { channel: 2, unit: Some(AccelerationUnit::Gal) });
    assert_round_trip(&(PeerFormat, KNetFormat, EsmFormat, SmcFormat));
    assert_round_trip(&(
        AfadFormat { component: 2 },
        KNetCsvFormat { component: 3 },
        GeoNetFormat::default(),
    ));
}

#[test]
fn records_are_written_as_their_samples() {
    let record = el_centro_1940();
    let form = assert_round_trip(&record);
    assert_eq!(form.as_object().unwrap().keys().collect::<Vec<_>>(), ["acceleration", "time_step"]);
    assert_round_trip(&record.response_spectrum(&[0.2, 1.0], 0.05, &mut unobserved).unwrap());
    for (form, reason) in [
        (json!({"time_step": 0.0, "acceleration": [0.0, 1.0]}), "time step of the record is 0"),
        (json!({"time_step": 0.1, "acceleration": [0.0]}), "has length 1, but must have 2"),
        (json!({"time_step": 0.1, "acceleration": [0.0, null]}), "invalid type: null"),
        (json!({"time_step": 1e200, "acceleration": [0.0, 1e200]}), "of the record is inf"),
    ] {
        assert_errors::<Record>(form, reason);
    }
}
