//! Time series of each joint.

use std::fmt;
use std::ops::Range;

use super::item_lists::ItemLists;
use crate::bem::ContactElement;
use crate::coupled::{JointState, State};
use crate::error::{Result, in_bounds};
use crate::text::column::column;

/// A scalar result of a joint, a number of [`JointState`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum JointQuantity {
    /// [`JointState::normal_force`], N/m.
    NormalForce,
    /// [`JointState::shear_force`], N/m.
    ShearForce,
    /// [`JointState::moment`], N·m/m.
    Moment,
    /// [`JointState::open_fraction`].
    OpenFraction,
    /// [`JointState::mean_slip`], m.
    MeanSlip,
    /// [`JointState::largest_gap`], m.
    LargestGap,
    /// [`JointState::contact_energy`], J/m.
    ContactEnergy,
}

/// Word, SI unit and value of a quantity.
type JointQuantityRow = (&'static str, &'static str, fn(&JointState) -> f64);

/// Rows of all quantities, in the order of columns.
const JOINT_QUANTITY_ROWS: [JointQuantityRow; 7] = [
    ("normal_force", "N/m", |joint| joint.normal_force),
    ("shear_force", "N/m", |joint| joint.shear_force),
    ("moment", "N·m/m", |joint| joint.moment),
    ("open_fraction", "", |joint| joint.open_fraction),
    ("mean_slip", "m", |joint| joint.mean_slip),
    ("largest_gap", "m", |joint| joint.largest_gap),
    ("contact_energy", "J/m", |joint| joint.contact_energy),
];

impl JointQuantity {
    /// All quantities, in the order of columns.
    pub const ALL_QUANTITIES: [Self; JOINT_QUANTITY_ROWS.len()] = [
        Self::NormalForce,
        Self::ShearForce,
        Self::Moment,
        Self::OpenFraction,
        Self::MeanSlip,
        Self::LargestGap,
        Self::ContactEnergy,
    ];

    /// SI unit of its values; empty for a ratio.
    pub fn unit(self) -> &'static str {
        JOINT_QUANTITY_ROWS[self as usize].1
    }

    /// Value in the state of a joint.
    pub fn value(self, joint: &JointState) -> f64 {
        JOINT_QUANTITY_ROWS[self as usize].2(joint)
    }
}

impl fmt::Display for JointQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(JOINT_QUANTITY_ROWS[*self as usize].0)
    }
}

/// Elements of each joint, and its scalars at the kept steps.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct JointSeries {
    /// Contact elements of each joint.
    pub(super) elements: Vec<Vec<ContactElement>>,
    /// Lists of each joint.
    pub(super) lists: ItemLists,
}

impl JointSeries {
    /// Makes empty lists for the joints of a state.
    pub(super) fn new(state: &State) -> Self {
        let elements = state.context.joint_elements.clone();
        let lists = ItemLists::new(elements.len(), JOINT_QUANTITY_ROWS.len());
        Self { elements, lists }
    }

    /// Number of joints.
    pub(super) fn count(&self) -> usize {
        self.elements.len()
    }

    /// Number of elements of all joints.
    pub(super) fn element_count(&self) -> usize {
        self.elements.iter().map(Vec::len).sum()
    }

    /// Elements of a joint among the elements of all joints.
    pub(super) fn element_range(&self, joint: usize) -> Result<Range<usize>> {
        let index = in_bounds("joint", joint, self.count())?;
        let start: usize = self.elements[..index].iter().map(Vec::len).sum();
        Ok(start..start + self.elements[index].len())
    }

    /// Returns an error unless there are lists of all quantities of each joint.
    #[cfg(feature = "serde")]
    pub(super) fn check(&self) -> Result<()> {
        let needed_lists = self.count().saturating_mul(JOINT_QUANTITY_ROWS.len());
        let quantity = "list of scalars of the joints";
        crate::error::same_length(quantity, self.lists.all_lists().len(), needed_lists)?;
        Ok(())
    }

    /// Appends the values of a kept step.
    pub(super) fn store(&mut self, state: &State) {
        for (lists, joint) in self.lists.items_mut(self.elements.len()).zip(&state.joints) {
            for (list, (.., value)) in lists.iter_mut().zip(JOINT_QUANTITY_ROWS) {
                list.push(value(joint));
            }
        }
    }

    /// Series of a quantity of a joint.
    pub(super) fn find(&self, joint: usize, quantity: JointQuantity) -> Result<&[f64]> {
        let index = in_bounds("joint", joint, self.count())?;
        let lists = self.lists.of_item(index, self.count());
        Ok(lists.get(quantity as usize).map_or(&[], Vec::as_slice))
    }

    /// Names of columns, joint by joint.
    pub(super) fn columns(&self) -> impl Iterator<Item = String> {
        (0..self.count()).flat_map(|joint| {
            JOINT_QUANTITY_ROWS
                .into_iter()
                .map(move |(word, unit, _)| format!("joint_{joint}_{}", column(word, unit)))
        })
    }
}
