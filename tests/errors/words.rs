//! GOAL: choices are read as they are printed; an error names the right spelling, or all choices for another word.
//! SCENE: every choice; capitals, blanks, hyphens, numbers that do not fit.
//! REFERENCE: the choice itself.

use std::fmt::{Debug, Display};
use std::str::FromStr;

use basemat::Error;
use basemat::bem::Grading;
use basemat::contact::{ContactSearch, SearchMethod};
use basemat::coupled::{Coordinates, GravityStage};
use basemat::fem::{Direction, MassKind};
use basemat::history::HistoryMethod;
use basemat::interface::{FrictionLimit, Mode, SlipSense};
use basemat::motion::{AccelerationUnit, Baseline};
use basemat::results::{Criterion, Quantity};

/// Checks that each choice is read as it is printed, and that other spellings and words are errors.
#[track_caller]
fn assert_spelling<T>(quantity: &str, choices: &[T])
where
    T: FromStr<Err = Error> + Display + Debug + PartialEq + Copy,
{
    for choice in choices {
        let word = choice.to_string();
        let spaced = format!("  {} ", word.replace('_', " "));
        for text in [word.to_uppercase(), word.replace('_', "-"), spaced] {
            let Err(Error::Name { known, .. }) = text.parse::<T>() else {
                assert_eq!(text, word);
                continue;
            };
            assert!(known == [&word[..]] || word.contains('('), "{text}: {known:?}");
        }
    }
    assert_words(quantity, choices);
}

/// Whether a list of words contains this choice, up to its parameters.
fn names_choice(words: &[String], choice: &impl Display) -> bool {
    let printed_choice = choice.to_string();
    let name = printed_choice.split('(').next();
    words.iter().any(|word| word.split('(').next() == name)
}

/// Checks that each choice is read as it is printed, and that other words are errors.
#[track_caller]
fn assert_words<T>(quantity: &str, choices: &[T])
where
    T: FromStr<Err = Error> + Display + Debug + PartialEq + Copy,
{
    for choice in choices {
        let word = choice.to_string();
        assert_eq!(word.parse(), Ok(*choice));
        assert_eq!(format!("{choice:>30}").len() - word.len(), 30 - word.chars().count());
    }
    for text in ["", "nonsense", "auto(", "auto)", "reduced()", "reduced(inf)", "stick(1)", "é"] {
        let Err(Error::Name { quantity: named_quantity, name, known }) = text.parse::<T>() else {
            panic!("{quantity} '{text}' was read")
        };
        assert_eq!((named_quantity, &name[..]), (quantity, text));
        let message = text.parse::<T>().unwrap_err().to_string();
        assert!(message.contains(quantity) && known.iter().all(|word| message.contains(word)));
        assert!(choices.iter().all(|choice| names_choice(&known, choice)), "{known:?}");
    }
}

#[test]
fn choices_are_read_as_they_are_printed() {
    use Baseline::{
        DisplacementPolynomial, NewmarkParabola, RemoveMean, RestToRest, VelocityPolynomial,
    };
    use Criterion::{Gap, Rotation, Settlement, Slip, UpliftedFraction};
    use Direction::{Rotation as InPlane, RotationX, RotationY, RotationZ, X, Y, Z};
    use FrictionLimit::{Dynamic, Lagged, Static, Total};
    use GravityStage::{Frictional, Frictionless, Unloaded};
    use Mode::{Active, ActiveLeft, ActiveRight};
    use Mode::{Open, SlipLeft, SlipRight, Stick, Yield, YieldLeft, YieldRight, YieldSlip};
    use SearchMethod::{ActiveSet, GaussSeidel, Newton, Path, Proximal};
    use SlipSense::{Inelastic, LastVelocity, Velocity};

    assert_spelling(
        "contact mode",
        &[
            Stick,
            SlipLeft,
            SlipRight,
            Open,
            Yield,
            YieldLeft,
            YieldRight,
            Mode::Slip,
            YieldSlip,
            Active,
            ActiveLeft,
            ActiveRight,
        ],
    );
    let histories = [
        HistoryMethod::Direct,
        HistoryMethod::RelaxedFft,
        HistoryMethod::Exponentials,
        HistoryMethod::default(),
    ];
    assert_spelling("history", &histories);
    assert_spelling("grading", &[Grading::Uniform, Grading::Cosine]);
    assert_spelling("gravity stage", &[Frictionless, Frictional, Unloaded]);
    assert_spelling("search method", &[ActiveSet, GaussSeidel, Path, Newton, Proximal]);
    assert_spelling("criterion", &[Slip, Gap, UpliftedFraction, Rotation, Settlement]);
    assert_spelling("friction limit", &[Total, Lagged, Static, Dynamic]);
    assert_spelling("sense of slip", &[Inelastic, Velocity, LastVelocity]);
    assert_spelling("kind of mass", &[MassKind::Consistent, MassKind::Lumped]);
    assert_spelling("direction", &[X, Y, InPlane, Z, RotationX, RotationY, RotationZ]);
    assert_spelling("quantity", &Quantity::ALL_QUANTITIES);
    let tolerances = [1e-6, 0.5, 1.0 / 3.0, 5e-324];
    let reduced_coordinates = tolerances.map(|tolerance| Coordinates::Reduced { tolerance });
    assert_spelling("kind of coordinates", &[Coordinates::Physical, Coordinates::Modes]);
    for choice in reduced_coordinates.iter().chain(&[Coordinates::Auto]) {
        assert_eq!(choice.to_string().parse(), Ok(*choice));
    }
    let searches =
        [1, 50, 9_000_000_000_000_000].map(|n| ContactSearch::FlowChart { iterations: n });
    assert_spelling("contact search", &[ContactSearch::Robust]);
    assert_spelling("contact search", &searches);
    let degree = 4;
    assert_spelling(
        "baseline treatment",
        &[Baseline::None, RemoveMean, NewmarkParabola, RestToRest { degree }],
    );
    assert_spelling(
        "baseline treatment",
        &[VelocityPolynomial { degree }, DisplacementPolynomial { degree }],
    );
    for text in ["rest_to_rest(-1)", "rest_to_rest(1.5)", "rest_to_rest(1e300)", "remove_mean(1)"] {
        assert!(text.parse::<Baseline>().is_err(), "{text}");
    }
}

#[test]
fn units_of_acceleration_are_read_as_they_are_printed() {
    use AccelerationUnit::{
        FootPerSecondSquared, Gal, InchPerSecondSquared, MetrePerSecondSquared,
        MillimetrePerSecondSquared, StandardGravity,
    };
    let metric = [MetrePerSecondSquared, MillimetrePerSecondSquared, StandardGravity, Gal];
    assert_words("unit of acceleration", &metric);
    assert_words("unit of acceleration", &[FootPerSecondSquared, InchPerSecondSquared]);
    for (text, unit) in [("m/s2", MetrePerSecondSquared), ("cm/s²", Gal), ("G", StandardGravity)] {
        assert_eq!(text.parse(), Ok(unit));
    }
}

#[test]
fn columns_of_quantities_have_units() {
    let columns: Vec<_> =
        Quantity::recorded(false).map(|quantity| quantity.column(false)).collect();
    let expected = [
        "base_shear_n_per_m",
        "base_moment_n_m_per_m",
        "normal_force_n_per_m",
        "uplifted_fraction",
        "mean_slip_m",
        "largest_slip_m",
        "base_rotation_rad",
        "settlement_m",
        "rocking_work_j_per_m",
        "free_field_horizontal_m",
        "free_field_vertical_m",
        "sliding_safety",
        "overturning_safety",
    ];
    assert_eq!(columns, expected);
}
