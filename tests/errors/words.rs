//! GOAL: choices are read as they are printed; the error for another spelling has the right one, for other words all.
//! SCENE: every choice; capitals, blanks, hyphens, numbers that do not fit. REFERENCE: the choice
//! itself.

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

/// Shown, each of `all` is read again; other spellings and other words are refused.
#[track_caller]
fn check<T>(quantity: &str, all: &[T])
where
    T: FromStr<Err = Error> + Display + Debug + PartialEq + Copy,
{
    for choice in all {
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
    check_words(quantity, all);
}

/// Shown, each of `all` is read again; other words are refused.
#[track_caller]
fn check_words<T>(quantity: &str, all: &[T])
where
    T: FromStr<Err = Error> + Display + Debug + PartialEq + Copy,
{
    for choice in all {
        let word = choice.to_string();
        assert_eq!(word.parse(), Ok(*choice));
        assert_eq!(format!("{choice:>30}").len() - word.len(), 30 - word.chars().count());
    }
    for text in ["", "nonsense", "auto(", "auto)", "reduced()", "reduced(inf)", "stick(1)", "é"] {
        let Err(Error::Name { quantity: named, name: given, known }) = text.parse::<T>() else {
            panic!("{quantity} '{text}' was read")
        };
        assert_eq!((named, &given[..]), (quantity, text));
        let message = text.parse::<T>().unwrap_err().to_string();
        assert!(message.contains(quantity) && known.iter().all(|word| message.contains(word)));
        // Every choice is named.
        let named = |choice: &T| {
            let word = choice.to_string();
            let word = word.split('(').next().unwrap_or_default();
            known.iter().any(|known| known.split('(').next() == Some(word))
        };
        assert!(all.iter().all(named), "{known:?}");
    }
}

#[test]
fn choices_are_read_as_they_are_shown() {
    use Baseline::{
        DisplacementPolynomial, NewmarkParabola, RemoveMean, RestToRest, VelocityPolynomial,
    };
    use Criterion::{Gap, Rotation, Slip, UpliftedFraction};
    use Direction::{Rotation as InPlane, RotationX, RotationY, RotationZ, X, Y, Z};
    use FrictionLimit::{Dynamic, Lagged, Static, Total};
    use GravityStage::{Frictional, Frictionless, Unloaded};
    use Mode::{Active, ActiveLeft, ActiveRight};
    use Mode::{Open, SlipLeft, SlipRight, Stick, Yield, YieldLeft, YieldRight, YieldSlip};
    use SearchMethod::{ActiveSet, GaussSeidel, Newton, Path, Proximal};
    use SlipSense::{Inelastic, LastVelocity, Velocity};

    check(
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
    check("history", &histories);
    check("grading", &[Grading::Uniform, Grading::Cosine]);
    check("gravity stage", &[Frictionless, Frictional, Unloaded]);
    check("search method", &[ActiveSet, GaussSeidel, Path, Newton, Proximal]);
    check("criterion", &[Slip, Gap, UpliftedFraction, Rotation]);
    check("friction limit", &[Total, Lagged, Static, Dynamic]);
    check("sense of slip", &[Inelastic, Velocity, LastVelocity]);
    check("kind of mass", &[MassKind::Consistent, MassKind::Lumped]);
    check("direction", &[X, Y, InPlane, Z, RotationX, RotationY, RotationZ]);
    check("quantity", &Quantity::ALL);
    let tolerances = [1e-6, 0.5, 1.0 / 3.0, 5e-324];
    let reduced = tolerances.map(|tolerance| Coordinates::Reduced { tolerance });
    check("kind of coordinates", &[Coordinates::Physical, Coordinates::Modes]);
    for choice in reduced.iter().chain(&[Coordinates::Auto]) {
        assert_eq!(choice.to_string().parse(), Ok(*choice));
    }
    let searches =
        [1, 50, 9_000_000_000_000_000].map(|n| ContactSearch::FlowChart { iterations: n });
    check("contact search", &[ContactSearch::Robust]);
    check("contact search", &searches);
    let degree = 4;
    check(
        "baseline treatment",
        &[Baseline::None, RemoveMean, NewmarkParabola, RestToRest { degree }],
    );
    check(
        "baseline treatment",
        &[VelocityPolynomial { degree }, DisplacementPolynomial { degree }],
    );
    for text in ["rest_to_rest(-1)", "rest_to_rest(1.5)", "rest_to_rest(1e300)", "remove_mean(1)"] {
        assert!(text.parse::<Baseline>().is_err(), "{text}");
    }
}

#[test]
fn units_of_acceleration() {
    use AccelerationUnit::{
        FootPerSecondSquared, Gal, InchPerSecondSquared, MetrePerSecondSquared,
        MillimetrePerSecondSquared, StandardGravity,
    };
    let metric = [MetrePerSecondSquared, MillimetrePerSecondSquared, StandardGravity, Gal];
    check_words("unit of acceleration", &metric);
    check_words("unit of acceleration", &[FootPerSecondSquared, InchPerSecondSquared]);
    for (text, unit) in [("m/s2", MetrePerSecondSquared), ("cm/s²", Gal), ("G", StandardGravity)] {
        assert_eq!(text.parse(), Ok(unit));
    }
}

#[test]
fn columns_of_quantities() {
    let columns: Vec<_> =
        Quantity::recorded(false).map(|quantity| quantity.column(false)).collect();
    let known = [
        "base_shear_n_per_m",
        "base_moment_n_m_per_m",
        "normal_force_n_per_m",
        "uplifted_fraction",
        "mean_slip_m",
        "largest_slip_m",
        "base_rotation_rad",
        "free_field_horizontal_m",
        "free_field_vertical_m",
        "sliding_safety",
        "overturning_safety",
    ];
    assert_eq!(columns, known);
}
