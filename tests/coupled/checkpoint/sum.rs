//! The check sum of a checkpoint's form, worked out from the form itself (feature `serde`).
//!
//! Words field by field; lists and texts begin with their length, and texts are words byte by byte.

use basemat::coupled::Checkpoint;
use serde_json::Value;

use basemat_problems::check_sum::{check_sum, text_words};

const FIELDS: [&str; 9] =
    ["format", "identity", "steps", "modes", "laws", "state", "ground", "structure", "set_loads"];
const IDENTITY: [&str; 11] = [
    "label",
    "dofs",
    "energy_balance",
    "probes",
    "laws",
    "steps",
    "elements",
    "structure",
    "ground",
    "static_contact",
    "start",
];

fn words(value: &Value, all: &mut Vec<u64>) {
    match value {
        Value::Bool(flag) => all.push(u64::from(*flag)),
        Value::Number(number) => all.push(number.as_u64().unwrap()),
        Value::String(text) => all.extend(text_words(text)),
        Value::Array(list) => {
            all.push(list.len() as u64);
            for entry in list {
                words(entry, all);
            }
        }
        Value::Object(identity) => {
            assert_eq!(identity.len(), IDENTITY.len());
            for name in IDENTITY {
                words(&identity[name], all);
            }
        }
        Value::Null => panic!("null"),
    }
}

/// The sum that belongs to this form.
pub(super) fn sum(form: &Value) -> u64 {
    assert_eq!(form.as_object().unwrap().len(), FIELDS.len() + 1);
    let mut all = Vec::new();
    for name in FIELDS {
        if name == "modes" {
            let modes = form[name].as_array().unwrap();
            all.push(modes.len() as u64);
            // A pair has no length of its own.
            let pairs = modes.iter().flat_map(|pair| pair.as_array().unwrap());
            for entry in pairs {
                words(entry, &mut all);
            }
        } else {
            words(&form[name], &mut all);
        }
    }
    check_sum(&all)
}

/// The checkpoint of this form with the sum that belongs to it: as one who means to mislead.
pub(super) fn sealed(mut form: Value) -> serde_json::Result<Checkpoint> {
    form["sum"] = Value::from(sum(&form));
    serde_json::from_value(form)
}
