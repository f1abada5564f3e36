//! The scalar quantities of a result, in one table.
//!
//! States, summaries, time series, files, pages, comparisons and pictures use this table.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use crate::coupled::State;
use crate::coupled::run::base_view::{BaseView, largest_slip, open_area};
use crate::coupled::run::peak::Peak;
use crate::coupled::run::quantity_row::{QuantityRow, Scale, ShownIn};
use crate::coupled::run::{Extremes, Sliding, Uplift};
use crate::error::{Error, Result};
use crate::text::column::column;
use crate::text::readable_number::{PrintedUnit, printed_unit, whole_body_unit};
use crate::text::words::unknown_word_error;

/// Declares the quantities, their table, and the summary of a base.
///
/// The rows are in the order of columns.
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

        const QUANTITY_TABLE: &[QuantityRow] = &[$(QuantityRow {
            word: stringify!($field),
            name: $name,
            unit: $unit,
            scale: $scale,
            places: &[$(ShownIn::$place),*],
            value: $value,
        },)+];

        const QUANTITY_WORDS: &[&str] = &[$(stringify!($field)),+];

        impl Quantity {
            /// All quantities, in the order of columns.
            ///
            /// Quantities in plan only are the last: [`Quantity::recorded`] omits them in the plane.
            pub const ALL_QUANTITIES: [Self; QUANTITY_WORDS.len()] = [$(Self::$variant),+];
        }

        /// Summary of the whole base or of one foundation: extremes with their times, uplift, sliding.
        ///
        /// Quantities are named and signed as in [`State`]. Moments of a foundation are about the middle of its
        /// elements, in plan of its outline. The moments of one foundation then do not depend on other foundations.
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
        #[non_exhaustive]
        pub struct Summary {
            /// Indices of the foundation's elements among all elements.
            pub elements: Range<usize>,
            /// Left and right end of the foundation, m; in plan of its outline.
            pub ends: [f64; 2],
            /// Front and back end of the foundation along y, m, in plan; zeros in the plane.
            #[cfg_attr(feature = "serde", serde(default))]
            pub depth: [f64; 2],
            /// Normal force at the start, due to weight and loads, N/m (in plan N).
            pub static_normal_force: f64,
            $($(#[$doc])* pub $field: Extremes,)+
            /// Mean slip at the end, m.
            pub residual_slip: f64,
            /// Mean slip along y at the end, m, in plan; zero in the plane.
            #[cfg_attr(feature = "serde", serde(default))]
            pub residual_slip_across: f64,
            /// Settlement at the end, m.
            #[cfg_attr(feature = "serde", serde(default))]
            pub residual_settlement: f64,
            /// Rotation at the end, rad; in plan about the axis along y.
            #[cfg_attr(feature = "serde", serde(default))]
            pub residual_rotation: f64,
            /// Rotation about the axis along x at the end, rad, in plan; zero in the plane.
            #[cfg_attr(feature = "serde", serde(default))]
            pub residual_rotation_across: f64,
            /// Duration of uplift.
            pub uplift: Uplift,
            /// Distance and duration of sliding, and the slip events.
            ///
            /// The whole base slides while all of its foundations slide, by the mean slip of all.
            pub sliding: Sliding,
        }

        impl State {
            /// Appends a value of the base or of one foundation to each of the `series`.
            ///
            /// The values are the first quantities in the order of columns.
            pub(crate) fn append_values(&self, foundation: Option<usize>, series: &mut [Vec<f64>]) {
                let base = self.base(foundation);
                $(if let Some(values) = series.get_mut(Quantity::$variant as usize) {
                    const VALUE_OF_BASE: fn(&BaseView) -> f64 = $value;
                    values.push(VALUE_OF_BASE(&base));
                })+
            }
        }

        impl Summary {
            /// Summary at the start of a run, of the whole base or of one foundation.
            pub(crate) fn start(state: &State, foundation: Option<usize>) -> Self {
                let base = state.base(foundation);
                let [ends, depth] = base.ends();
                Self {
                    elements: base.elements(),
                    ends,
                    depth,
                    static_normal_force: (QUANTITY_TABLE[Quantity::NormalForce as usize].value)(&base),
                    $($field: first_extremes(&base, $value),)+
                    residual_slip: (QUANTITY_TABLE[Quantity::MeanSlip as usize].value)(&base),
                    residual_slip_across: (QUANTITY_TABLE[Quantity::MeanSlipAcross as usize].value)(&base),
                    residual_settlement: (QUANTITY_TABLE[Quantity::Settlement as usize].value)(&base),
                    residual_rotation: (QUANTITY_TABLE[Quantity::BaseRotation as usize].value)(&base),
                    residual_rotation_across: (QUANTITY_TABLE[Quantity::RotationAcross as usize].value)(&base),
                    uplift: Uplift::default(),
                    sliding: Sliding::with_capacity(RESERVED_SLIP_EVENT_COUNT),
                }
            }

            /// Updates the extremes of the first `quantity_count` quantities by the values of a step.
            ///
            /// The functions are called directly, because calls through the table take longer than the functions.
            fn update_values(&mut self, base: &BaseView, quantity_count: usize, time: f64) {
                $(if (Quantity::$variant as usize) < quantity_count {
                    const VALUE_OF_BASE: fn(&BaseView) -> f64 = $value;
                    self.$field.update(VALUE_OF_BASE(base), time);
                })+
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
        |base| base.whole_or(base.state.base_shear, |foundation| foundation.base_shear);
    /// Moment on the soil, counter-clockwise, static part included, N·m/m.
    ///
    /// In plan about the axis along y, by the right-hand rule.
    BaseMoment base_moment, "base moment", "N·m/m", Scale::Unit, [Page, Foundations, Comparison, ComparisonTime],
        |base| base.whole_or(base.state.base_moment, |foundation| foundation.base_moment);
    /// Total pressure on the soil, N/m.
    NormalForce normal_force, "normal force", "N/m", Scale::Unit, [Page],
        |base| base.whole_or(base.state.normal_force, |foundation| foundation.normal_force);
    /// Length of open elements over the length of the base; in plan their area over its area.
    UpliftedFraction uplifted_fraction, "uplifted fraction", "", Scale::Percent, [Foundations, Comparison],
        |base| base.whole_or(base.state.uplifted_fraction, |foundation| foundation.uplifted_fraction);
    /// Slip averaged over the base, m; tangential motion of open elements counts.
    MeanSlip mean_slip, "mean slip", "m", Scale::Unit, [Foundations, Comparison],
        |base| base.whole_or(base.state.mean_slip, |foundation| foundation.mean_slip);
    /// Largest |slip| of any element, m.
    LargestSlip largest_slip, "largest slip", "m", Scale::Unit, [],
        largest_slip;
    /// Rotation of the base, counter-clockwise, rad; of several foundations the largest.
    ///
    /// In plan about the axis along y, by the right-hand rule.
    BaseRotation base_rotation, "base rotation", "rad", Scale::Unit, [Page, Foundations, Comparison],
        |base| base.whole_or(base.state.base_rotation, |foundation| foundation.base_rotation);
    /// Settlement of the base's centre since the static state, positive downwards, m; of several foundations the
    /// largest.
    ///
    /// Relative to the free field's translation: the mean over a foundation's length, in plan over its area. It
    /// includes elastic settlement, permanent settlement and gaps; a base that rocks on hard soil rises. It does not
    /// include the settlement under weight. The last value is the residual settlement.
    Settlement settlement, "settlement", "m", Scale::Unit, [Page, Foundations, Comparison],
        |base| base.highest(|foundation| foundation.settlement);
    /// Work of the base moment on the soil since t = 0, ∫M dθ, J/m; summed over foundations.
    ///
    /// Moment and rotation belong to each foundation, about its middle, in plan about the axis along y. A closed loop
    /// adds the energy that it dissipates.
    RockingWork rocking_work, "rocking work", "J/m", Scale::Unit, [Page, Foundations, Comparison],
        |base| base.sum(|foundation, _| foundation.rocking_work);
    /// Mean horizontal displacement of the free field under the base, m.
    FreeFieldHorizontal free_field_horizontal, "free field, horizontal", "m", Scale::Unit, [],
        |base| base.state.free_field[0];
    /// Mean vertical displacement (up) of the free field under the base, m.
    FreeFieldVertical free_field_vertical, "free field, vertical", "m", Scale::Unit, [],
        |base| base.state.free_field[1];
    /// Resistance of the interface over the base shear: φN/|H|.
    ///
    /// Infinite without shear, NaN in flight and for a base with walls. NaN throughout if an element's law has no
    /// friction coefficient and [`safety_friction`](crate::coupled::SimulationBuilder::safety_friction) was not set. It
    /// is computed from the actual tractions: on a base that may slide it reaches one during sliding, and never falls
    /// below. On a bonded base it may fall below one, and shows the missing resistance. Of several foundations the
    /// smallest.
    SlidingSafety sliding_safety, "factor of safety against sliding", "", Scale::Safety("1: sliding"), [Foundations, Comparison],
        |base| base.smallest_safety(|checks| checks.sliding);
    /// Restoring over overturning moment about the edge that the pressure moves to.
    ///
    /// N times the half width, over the moment about the middle of the base. NaN in flight and for a base with walls.
    /// On a base that may open it reaches one when the base stands on its edge, and never falls below. Of several
    /// foundations the smallest.
    ///
    /// In plan over the left or the right edge: N times the distance of the edge from the middle of the outline;
    /// on a round or many-sided outline, of each edge that faces x more than y. Pressure acts at the middle of the
    /// last element at most: a base with n cells along x stands on them at (n − 0.21)/(n − 1), 1.11 for 8 and 1.05
    /// for 16 cells or graded unions.
    OverturningSafety overturning_safety, "factor of safety against overturning", "", Scale::Safety("1: on its edge"),
        [Foundations, Comparison],
        |base| base.smallest_safety(|checks| checks.overturning[0]);
    /// In plan: resultant of the horizontal forces on the soil along x and y, N.
    HorizontalForce horizontal_force, "horizontal force", "N/m", Scale::Unit, [Plan, Page, Comparison, ComparisonTime],
        |base| base.sum(|foundation, _| foundation.base_shear).hypot(base.sum(|foundation, _| foundation.shear_across));
    /// In plan: area of open elements inside the outline of the base, m².
    UpliftedArea uplifted_area, "uplifted area", "m²", Scale::Unit, [Plan, Page],
        open_area;
    /// In plan: horizontal force on the soil along y, N.
    ShearAcross shear_across, "base shear across", "N/m", Scale::Unit, [Plan, Page, Foundations, Comparison, ComparisonTime],
        |base| base.sum(|foundation, _| foundation.shear_across);
    /// In plan: moment on the soil about the axis along x, N·m.
    ///
    /// By the right-hand rule, static part included.
    MomentAcross moment_across, "base moment across", "N·m/m", Scale::Unit, [Plan, Page, Foundations, Comparison, ComparisonTime],
        |base| base.sum(|foundation, [_, y]| foundation.moment_across - foundation.normal_force * y);
    /// In plan: moment on the soil about the vertical axis, counter-clockwise from above, N·m.
    Torque torque, "torque", "N·m/m", Scale::Unit, [Plan, Page, Foundations, Comparison, ComparisonTime],
        |base| base.sum(|foundation, [x, y]| {
            foundation.torque + x * foundation.shear_across - y * foundation.base_shear
        });
    /// In plan: slip along y averaged over the base, m.
    MeanSlipAcross mean_slip_across, "mean slip across", "m", Scale::Unit, [Plan, Foundations, Comparison],
        |base| base.mean(|contact| contact.slip_across);
    /// In plan: rotation of the base about the axis along x, rad; of several foundations the largest.
    ///
    /// By the right-hand rule.
    RotationAcross rotation_across, "base rotation across", "rad", Scale::Unit, [Plan, Page, Foundations, Comparison],
        |base| base.largest(|foundation| foundation.rotation_across);
    /// In plan: work of the base moment about the axis along x on the soil, J; summed over foundations.
    RockingWorkAcross rocking_work_across, "rocking work across", "J/m", Scale::Unit, [Plan, Page, Foundations, Comparison],
        |base| base.sum(|foundation, _| foundation.rocking_work_across);
    /// In plan: rotation of the base about the vertical, rad; of several foundations the largest.
    ///
    /// Counter-clockwise from above.
    Twist twist, "base twist", "rad", Scale::Unit, [Plan, Page, Foundations, Comparison],
        |base| base.largest(|foundation| foundation.twist);
    /// In plan: mean displacement of the free field under the base along y, m.
    FreeFieldAcross free_field_across, "free field, across", "m", Scale::Unit, [Plan],
        |base| base.state.free_field_across;
    /// In plan: safety against overturning over the front or the back edge.
    OverturningSafetyAcross overturning_safety_across, "factor of safety against overturning across", "",
        Scale::Safety("1: on its edge"), [Plan, Foundations, Comparison],
        |base| base.smallest_safety(|checks| checks.overturning[1]);
}

/// First of the quantities that are not updated in the plane.
const FIRST_QUANTITY_IN_PLAN: usize = Quantity::ShearAcross as usize;

/// Number of slip events for which a run reserves memory.
const RESERVED_SLIP_EVENT_COUNT: usize = 1000;

/// Extremes at the start of a run: both are the initial value.
fn first_extremes(base: &BaseView<'_>, value: fn(&BaseView) -> f64) -> Extremes {
    Extremes::single(value(base), base.state.time)
}

impl Quantity {
    fn row(self) -> &'static QuantityRow {
        &QUANTITY_TABLE[self as usize]
    }

    /// Name of the quantity, for tables and axes.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Abbreviated name, for narrow columns.
    pub(crate) fn short_name(self) -> String {
        self.name().replace("factor of safety against", "safety,")
    }

    /// The quantities of a ground in plan, or of a ground in the plane.
    pub fn recorded(in_plan: bool) -> impl Iterator<Item = Self> + Clone {
        Self::ALL_QUANTITIES
            .into_iter()
            .filter(move |quantity| in_plan || !quantity.is_shown(ShownIn::Plan))
    }

    /// SI unit of its values; empty for a ratio.
    ///
    /// Per metre of thickness in the plane, of the whole body in plan.
    pub fn unit(self, in_plan: bool) -> &'static str {
        whole_body_unit(self.row().unit, in_plan)
    }

    /// Column of the quantity in files: its word and unit.
    ///
    /// `base_shear_n_per_m` in the plane, `base_shear_n` in plan.
    pub fn column(self, in_plan: bool) -> String {
        column(self.row().word, self.unit(in_plan))
    }

    /// Unit in which values are printed.
    pub(crate) fn printed_unit(self, in_plan: bool) -> PrintedUnit<'static> {
        let unit = match self.row().scale {
            Scale::Percent => PrintedUnit { factor: 1e2, symbol: "%" },
            Scale::Unit | Scale::Safety(_) => printed_unit(self.row().unit),
        };
        PrintedUnit { symbol: whole_body_unit(unit.symbol, in_plan), ..unit }
    }

    /// Label of the limit of one for a factor of safety.
    ///
    /// `None` for other quantities.
    pub(crate) fn limit_label(self) -> Option<&'static str> {
        match self.row().scale {
            Scale::Safety(label) => Some(label),
            Scale::Unit | Scale::Percent => None,
        }
    }

    /// The quantities that are shown at `place`.
    pub(crate) fn shown(place: ShownIn, in_plan: bool) -> impl Iterator<Item = Self> {
        Self::recorded(in_plan).filter(move |quantity| quantity.is_shown(place))
    }

    /// Whether the quantity is shown at `place`.
    pub(crate) fn is_shown(self, place: ShownIn) -> bool {
        self.row().places.contains(&place)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.row().word)
    }
}

/// Parses the word of `Display`: `base_shear`.
impl FromStr for Quantity {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let quantity =
            Self::ALL_QUANTITIES.into_iter().find(|quantity| quantity.row().word == text);
        quantity.ok_or_else(|| unknown_word_error("quantity", text, QUANTITY_WORDS))
    }
}

impl State {
    /// Value of `quantity` for the whole base, in its SI unit.
    pub fn value(&self, quantity: Quantity) -> f64 {
        (quantity.row().value)(&self.base(None))
    }

    fn base(&self, foundation: Option<usize>) -> BaseView<'_> {
        BaseView { state: self, foundation: foundation.filter(|k| *k < self.foundations.len()) }
    }
}

impl Summary {
    /// Records the step from `step_start` (s) to `state`; `foundation` as for [`Summary::start`].
    pub(crate) fn update(&mut self, state: &State, step_start: f64, foundation: Option<usize>) {
        let base = state.base(foundation);
        let time = state.time;
        let quantity_count = if state.context.elements.is_plan() {
            QUANTITY_WORDS.len()
        } else {
            FIRST_QUANTITY_IN_PLAN
        };
        self.update_values(&base, quantity_count, time);
        let slip = (Quantity::MeanSlip.row().value)(&base);
        let slip_across = (Quantity::MeanSlipAcross.row().value)(&base);
        let uplifted_fraction = (Quantity::UpliftedFraction.row().value)(&base);
        self.uplift.update(uplifted_fraction, base.modes(), time - step_start);
        let slip_increment = [slip - self.residual_slip, slip_across - self.residual_slip_across];
        self.sliding.update(base.modes(), slip_increment, [step_start, time]);
        self.residual_slip = slip;
        self.residual_slip_across = slip_across;
        self.residual_settlement = (Quantity::Settlement.row().value)(&base);
        self.residual_rotation = (Quantity::BaseRotation.row().value)(&base);
        self.residual_rotation_across = (Quantity::RotationAcross.row().value)(&base);
    }

    /// The governing extreme of `quantity`: the smallest factor of safety, or the value furthest from zero.
    pub fn peak(&self, quantity: Quantity) -> Peak {
        let extremes = self.extremes(quantity);
        if quantity.limit_label().is_some() { extremes.lowest } else { extremes.largest() }
    }
}

former_constants! {
    Quantity { ALL: [Self; QUANTITY_WORDS.len()] = ALL_QUANTITIES, "use `ALL_QUANTITIES`"; }
}
