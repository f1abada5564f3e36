//! The check sum of a checkpoint's form, computed from the form itself (feature `serde`).
//!
//! It is a sum of words field by field; lists and texts begin with their length, and texts are words byte by byte.

use basemat::coupled::Checkpoint;
use serde_json::Value;

use basemat_problems::check_sum::{check_sum, text_words};

const CHECKPOINT_FIELDS: [&str; 10] = [
    "format",
    "identity",
    "steps",
    "modes",
    "laws",
    "state",
    "ground",
    "structure",
    "tangent",
    "set_loads",
];
const IDENTITY_FIELDS: [&str; 11] = [
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

/// Adds the words of a value.
fn collect_words(value: &Value, words: &mut Vec<u64>) {
    match value {
        Value::Bool(flag) => words.push(u64::from(*flag)),
        Value::Number(number) => words.push(number.as_u64().unwrap()),
        Value::String(text) => words.extend(text_words(text)),
        Value::Array(list) => {
            words.push(list.len() as u64);
            for entry in list {
                collect_words(entry, words);
            }
        }
        Value::Object(identity) => {
            assert_eq!(identity.len(), IDENTITY_FIELDS.len());
            for name in IDENTITY_FIELDS {
                collect_words(&identity[name], words);
            }
        }
        Value::Null => panic!("null"),
    }
}

/// The sum that belongs to this form.
pub(super) fn sum(form: &Value) -> u64 {
    assert_eq!(form.as_object().unwrap().len(), CHECKPOINT_FIELDS.len() + 1);
    let mut words = Vec::new();
    for name in CHECKPOINT_FIELDS {
        if name == "modes" {
            let modes = form[name].as_array().unwrap();
            words.push(modes.len() as u64);
            // The length of a pair is not part of the sum.
            for entry in modes.iter().flat_map(|pair| pair.as_array().unwrap()) {
                collect_words(entry, &mut words);
            }
        } else {
            collect_words(&form[name], &mut words);
        }
    }
    check_sum(&words)
}

/// The checkpoint of this form with the sum that belongs to it, as if somebody had changed it on purpose.
pub(super) fn sealed(mut form: Value) -> serde_json::Result<Checkpoint> {
    form["sum"] = Value::from(sum(&form));
    serde_json::from_value(form)
}
