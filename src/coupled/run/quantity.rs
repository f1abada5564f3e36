//! The scalar quantities of a result: the one table from which states, summaries, time series, files, pages,
//! comparisons and pictures read.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use super::peak::{Footing, against_overturning, against_sliding};
use super::{Extremes, Sliding, Uplift};
use crate::coupled::{Foundation, Peak, State};
use crate::error::{Error, Result};
use crate::interface::{ContactState, Mode};
use crate::text::column::{column, printed};
use crate::text::words::{plain, unknown};

/// One row: how a quantity is called, and where it is shown beside its time series.
struct Row {
    word: &'static str,
    name: &'static str,
    unit: &'static str,
    scale: Scale,
    places: &'static [Place],
    value: fn(&Base) -> f64,
}

/// How a quantity is drawn and printed.
#[derive(Clone, Copy, PartialEq)]
enum Scale {
    /// In the unit of engineers.
    Unit,
    /// A ratio, in percent.
    Percent,
    /// A factor of safety, drawn as its inverse beside the limit of one, which has this label.
    Safety(&'static str),
}

/// Where the summary of a quantity is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Extremes on the page of a run.
    Page,
    /// Largest value, in the page's table of foundations.
    Foundations,
    /// Largest (or least) value in a comparison of runs.
    Comparison,
    /// Its time beside it.
    ComparisonTime,
}

/// The base as a whole, or one foundation of it, after a step.
#[derive(Clone, Copy)]
struct Base<'a> {
    state: &'a State,
    foundation: Option<&'a Foundation>,
}

/// From rows in the order of columns: the enum, its table, and the summary of a run or a foundation.
macro_rules! quantities {
    ($($(#[$doc:meta])* $variant:ident $field:ident, $name:literal, $unit:literal, $scale:expr, [$($place:ident),*],
        $value:expr;)+) => {
        /// A scalar result: a number of [`State`], or one derived from it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
        #[non_exhaustive]
        pub enum Quantity {
            $($(#[$doc])* $variant,)+
        }

        const TABLE: &[Row] = &[$(Row {
            word: stringify!($field),
            name: $name,
            unit: $unit,
            scale: $scale,
            places: &[$(Place::$place),*],
            value: $value,
        },)+];

        const WORDS: &[&str] = &[$(stringify!($field)),+];

        impl Quantity {
            /// All quantities, in the order of columns.
            pub const ALL: [Self; WORDS.len()] = [$(Self::$variant),+];
        }

        /// Summary of the whole base or of one foundation: extremes with their times, uplift, sliding.
        ///
        /// Quantities are named and signed as in [`State`]. Moments of a foundation are about the middle of its
        /// own elements, so that of several structures each has its own.
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
        #[non_exhaustive]
        pub struct Summary {
            /// Its elements, as indices of all.
            pub elements: Range<usize>,
            /// Its left and right end, m.
            pub ends: [f64; 2],
            /// Normal force at the start, of weight and loads, N/m.
            pub static_normal_force: f64,
            $($(#[$doc])* pub $field: Extremes,)+
            /// Mean slip at the end, m.
            pub residual_slip: f64,
            /// Duration of uplift.
            pub uplift: Uplift,
            /// Distance and duration of sliding, and the slip events. The base as a whole slides while all
            /// of its foundations do, by the mean slip of all.
            pub sliding: Sliding,
        }

        impl Summary {
            /// At the start of a run, of the whole base or of its foundation number `foundation`.
            pub(crate) fn start(state: &State, foundation: Option<usize>) -> Self {
                let base = state.base(foundation);
                let extremes = |value: fn(&Base) -> f64| Extremes::of(value(&base), state.time);
                let own = base.elements();
                let elements = &state.context.elements[own.clone()];
                Self {
                    elements: own,
                    ends: [elements.first().map_or(0.0, |e| e.left), elements.last().map_or(0.0, |e| e.right)],
                    static_normal_force: (TABLE[Quantity::NormalForce as usize].value)(&base),
                    $($field: extremes($value),)+
                    residual_slip: (TABLE[Quantity::MeanSlip as usize].value)(&base),
                    uplift: Uplift::default(),
                    sliding: Sliding::with_capacity(EVENTS),
                }
            }

            fn each(&mut self) -> [&mut Extremes; WORDS.len()] {
                [$(&mut self.$field),+]
            }

            /// Extremes of a quantity.
            pub fn extremes(&self, quantity: Quantity) -> Extremes {
                match quantity {
                    $(Quantity::$variant => self.$field,)+
                }
            }
        }
    };
}

quantities! {
    /// Horizontal force on the soil, positive to the right, N/m.
    BaseShear base_shear, "base shear", "N/m", Scale::Unit, [Page, Foundations, Comparison, ComparisonTime],
        |base| base.pick(base.state.base_shear, |own| own.base_shear);
    /// Moment on the soil, counter-clockwise, static part included, N·m/m.
    BaseMoment base_moment, "base moment", "N·m/m", Scale::Unit, [Page, Foundations, Comparison, ComparisonTime],
        |base| base.pick(base.state.base_moment, |own| own.base_moment);
    /// Pressure on the soil, summed, N/m.
    NormalForce normal_force, "normal force", "N/m", Scale::Unit, [Page],
        |base| base.pick(base.state.normal_force, |own| own.normal_force);
    /// Length of open elements over the length of the base.
    UpliftedFraction uplifted_fraction, "uplifted fraction", "", Scale::Percent, [Foundations, Comparison],
        |base| base.pick(base.state.uplifted_fraction, |own| own.uplifted_fraction);
    /// Slip averaged over the base, m; tangential motion of open elements counts.
    MeanSlip mean_slip, "mean slip", "m", Scale::Unit, [Foundations, Comparison],
        |base| base.pick(base.state.mean_slip, |own| own.mean_slip);
    /// Largest |slip| of any element, m.
    LargestSlip largest_slip, "largest slip", "m", Scale::Unit, [],
        |base| base.contact().iter().fold(0.0, |largest, own| own.slip.abs().max(largest));
    /// Rotation of the base, counter-clockwise, rad; of several foundations the largest.
    BaseRotation base_rotation, "base rotation", "rad", Scale::Unit, [Page, Foundations, Comparison],
        |base| base.pick(base.state.base_rotation, |own| own.base_rotation);
    /// Mean horizontal displacement of the free field under the base, m.
    FreeFieldHorizontal free_field_horizontal, "free field, horizontal", "m", Scale::Unit, [],
        |base| base.state.free_field[0];
    /// Mean vertical displacement (up) of the free field under the base, m.
    FreeFieldVertical free_field_vertical, "free field, vertical", "m", Scale::Unit, [],
        |base| base.state.free_field[1];
    /// Resistance of the interface over the base shear: φN/|H|. Infinite without shear, NaN in
    /// flight, and throughout if an element's law has no friction coefficient and the builder was
    /// told none ([`safety_friction`](crate::coupled::SimulationBuilder::safety_friction)).
    ///
    /// It is made of tractions that did act: on a base that may slide it reaches one when it does,
    /// and never falls below. On a bonded base it may, and says what the interface would have lacked.
    /// Of several foundations the least.
    SlidingSafety sliding_safety, "factor of safety against sliding", "", Scale::Safety("1: sliding"), [Foundations, Comparison],
        |base| base.least(against_sliding);
    /// Restoring over overturning moment about the edge that the pressure moves to: N times the
    /// half width, over the moment about the middle of the base. NaN in flight. On a base that may
    /// open it reaches one when the base stands on its edge (on its last element), and never falls
    /// below. Of several foundations the least.
    OverturningSafety overturning_safety, "factor of safety against overturning", "", Scale::Safety("1: on its edge"),
        [Foundations, Comparison],
        |base| base.least(|_, footing| against_overturning(footing));
}

/// Most slip events of a base that memory is reserved for.
const EVENTS: usize = 1000;

impl Quantity {
    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }

    /// Its name, for tables and axes.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The name where there is little room.
    pub(crate) fn short_name(self) -> String {
        self.name().replace("factor of safety against", "safety,")
    }

    /// SI unit of its values; empty for a ratio.
    pub fn unit(self) -> &'static str {
        self.row().unit
    }

    /// Its column in files: the word and the unit, `base_shear_n_per_m`.
    pub fn column(self) -> String {
        column(self.row().word, self.unit())
    }

    /// Factor and unit in which it is printed.
    pub(crate) fn printed(self) -> (f64, &'static str) {
        match self.row().scale {
            Scale::Percent => (1e2, "%"),
            Scale::Unit | Scale::Safety(_) => printed(self.unit()),
        }
    }

    /// The label of the limit one, for a factor of safety.
    pub(crate) fn limit(self) -> Option<&'static str> {
        match self.row().scale {
            Scale::Safety(label) => Some(label),
            Scale::Unit | Scale::Percent => None,
        }
    }

    /// The quantities that are shown at `place`.
    pub(crate) fn shown(place: Place) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |own| own.is_shown(place))
    }

    /// Whether it is shown at `place`.
    pub(crate) fn is_shown(self, place: Place) -> bool {
        self.row().places.contains(&place)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.row().word)
    }
}

/// The word of `Display`, the name, or the column, in upper or lower case.
impl FromStr for Quantity {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let word = plain(text);
        let is = |own: &Self| {
            own.row().word == word || own.column() == word || plain(own.name()) == word
        };
        Self::ALL.into_iter().find(is).ok_or_else(|| unknown("quantity", text, WORDS))
    }
}

impl State {
    /// Value of `quantity` for the whole base, in its SI unit.
    pub fn value(&self, quantity: Quantity) -> f64 {
        (quantity.row().value)(&self.base(None))
    }

    /// Values of all quantities for the whole base.
    pub(crate) fn values(&self) -> [f64; WORDS.len()] {
        let base = self.base(None);
        std::array::from_fn(|k| (TABLE[k].value)(&base))
    }

    fn base(&self, foundation: Option<usize>) -> Base<'_> {
        Base { state: self, foundation: foundation.and_then(|k| self.foundations.get(k)) }
    }
}

impl<'a> Base<'a> {
    /// The whole base's number, or that of the foundation.
    fn pick(&self, whole: f64, own: fn(&Foundation) -> f64) -> f64 {
        self.foundation.map_or(whole, own)
    }

    fn elements(&self) -> Range<usize> {
        self.foundation.map_or(0..self.state.contact.len(), |own| own.elements.clone())
    }

    /// Contact of its elements. The lists of a state are public: they may have been cut.
    fn contact(&self) -> &'a [ContactState] {
        self.state.contact.get(self.elements()).unwrap_or_default()
    }

    fn modes(&self) -> &'a [Mode] {
        self.state.modes.get(self.elements()).unwrap_or_default()
    }

    /// The least factor of safety of its foundations, by friction coefficients and contact; NaN where
    /// none is known.
    fn least(&self, factor: fn(&[f64], Footing<'_>) -> f64) -> f64 {
        let of = |foundation: &Foundation| {
            let (own, context) = (foundation.elements.clone(), &self.state.context);
            let friction = match context.friction.len() {
                0 | 1 => &context.friction[..],
                _ => context.friction.get(own.clone()).unwrap_or_default(),
            };
            let footing = Footing {
                elements: context.elements.get(own.clone()).unwrap_or_default(),
                depths: context.elements.depths().get(own.clone()).unwrap_or_default(),
                areas: context.elements.areas().get(own.clone()).unwrap_or_default(),
                contact: self.state.contact.get(own).unwrap_or_default(),
                is_plan: context.elements.is_plan(),
            };
            factor(friction, footing)
        };
        match self.foundation {
            Some(foundation) => of(foundation),
            None => self.state.foundations.iter().map(of).fold(f64::NAN, f64::min),
        }
    }
}

impl Summary {
    /// Takes in the state of a step that began at `begin`; `foundation` as at the start.
    pub(crate) fn see(&mut self, state: &State, begin: f64, foundation: Option<usize>) {
        let (base, time) = (state.base(foundation), state.time);
        for (extremes, row) in self.each().into_iter().zip(TABLE) {
            extremes.see((row.value)(&base), time);
        }
        let slip = (Quantity::MeanSlip.row().value)(&base);
        let uplifted = (Quantity::UpliftedFraction.row().value)(&base);
        self.uplift.see(uplifted, base.modes(), time - begin);
        self.sliding.see(base.modes(), slip - self.residual_slip, [begin, time]);
        self.residual_slip = slip;
    }

    /// The extreme of `quantity` that matters: the least factor of safety, the furthest value of all else.
    pub fn peak(&self, quantity: Quantity) -> Peak {
        let extremes = self.extremes(quantity);
        if quantity.limit().is_some() { extremes.lowest } else { extremes.largest() }
    }
}
