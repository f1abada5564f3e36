//! Time series of each joint.

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

/// Name, SI unit and value of a quantity.
type JointQuantityRow = (&'static str, &'static str, fn(&JointState) -> f64);

/// Rows of all quantities, in the order of columns.
const JOINT_QUANTITY_ROWS: [JointQuantityRow; 7] = [
    ("normal force", "N/m", |joint| joint.normal_force),
    ("shear force", "N/m", |joint| joint.shear_force),
    ("moment", "N·m/m", |joint| joint.moment),
    ("open fraction", "", |joint| joint.open_fraction),
    ("mean slip", "m", |joint| joint.mean_slip),
    ("largest gap", "m", |joint| joint.largest_gap),
    ("contact energy", "J/m", |joint| joint.contact_energy),
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

    /// Value in the state of a joint.
    pub fn value(self, joint: &JointState) -> f64 {
        JOINT_QUANTITY_ROWS[self as usize].2(joint)
    }
}

/// Scalars of each joint at the kept steps.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct JointSeries {
    /// Lists of all quantities of the first joint, then of the next one.
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    lists: Vec<Vec<f64>>,
}

impl JointSeries {
    /// Makes empty lists for the joints of a state.
    pub(super) fn new(state: &State) -> Self {
        Self { lists: vec![Vec::new(); state.joints.len() * JOINT_QUANTITY_ROWS.len()] }
    }

    /// Number of joints.
    pub(super) fn count(&self) -> usize {
        self.lists.len() / JOINT_QUANTITY_ROWS.len()
    }

    /// Lists of all quantities of the first joint, then of the next one.
    pub(super) fn lists(&self) -> &[Vec<f64>] {
        &self.lists
    }

    /// Mutable access to the lists.
    pub(super) fn lists_mut(&mut self) -> &mut [Vec<f64>] {
        &mut self.lists
    }

    /// Appends the values of a kept step.
    pub(super) fn store(&mut self, state: &State) {
        let joint_lists = self.lists.chunks_exact_mut(JOINT_QUANTITY_ROWS.len());
        for (lists, joint) in joint_lists.zip(&state.joints) {
            for (list, (.., value)) in lists.iter_mut().zip(JOINT_QUANTITY_ROWS) {
                list.push(value(joint));
            }
        }
    }

    /// Series of a quantity of a joint.
    pub(super) fn find(&self, joint: usize, quantity: JointQuantity) -> Result<&[f64]> {
        let index = in_bounds("joint", joint, self.count())?;
        Ok(&self.lists[index * JOINT_QUANTITY_ROWS.len() + quantity as usize])
    }

    /// Names of columns, joint by joint.
    pub(super) fn columns(&self) -> impl Iterator<Item = String> {
        (0..self.count()).flat_map(|joint| {
            JOINT_QUANTITY_ROWS
                .into_iter()
                .map(move |(name, unit, _)| format!("joint_{joint}_{}", column(name, unit)))
        })
    }
}
