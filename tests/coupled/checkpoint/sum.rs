//! The check sum of a checkpoint's form, worked out from the form itself (feature `serde`).
//!
//! Words of 64 bits, field by field: h ← rotate((h ⊕ word) · 0x100000001b3, 23 to the left) from
//! 0xcbf29ce484222325. Lists and texts begin with their length; texts are words byte by byte.

use basemat::coupled::Checkpoint;
use serde_json::Value;

const FIELDS: [&str; 8] =
    ["format", "identity", "steps", "modes", "memory", "state", "ground", "structure"];
const IDENTITY: [&str; 9] = [
    "unknowns", "ledger", "probes", "memory", "steps", "elements", "structure", "ground", "preload",
];

fn words(value: &Value, all: &mut Vec<u64>) {
    match value {
        Value::Bool(flag) => all.push(u64::from(*flag)),
        Value::Number(number) => all.push(number.as_u64().unwrap()),
        Value::String(text) => {
            all.push(text.len() as u64);
            all.extend(text.bytes().map(u64::from));
        }
        Value::Array(list) => {
            all.push(list.len() as u64);
            list.iter().for_each(|entry| words(entry, all));
        }
        Value::Object(identity) => {
            assert_eq!(identity.len(), IDENTITY.len());
            IDENTITY.iter().for_each(|name| words(&identity[*name], all));
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
            pairs.for_each(|entry| words(entry, &mut all));
        } else {
            words(&form[name], &mut all);
        }
    }
    let start = 0xcbf2_9ce4_8422_2325_u64;
    all.iter().fold(start, |sum, word| {
        let product = u128::from(sum ^ word) * 0x0100_0000_01b3;
        let low = (product & u128::from(u64::MAX)) as u64;
        low << 23 | low >> 41
    })
}

/// The checkpoint of this form with the sum that belongs to it: as one who means to mislead.
pub(super) fn sealed(mut form: Value) -> serde_json::Result<Checkpoint> {
    form["sum"] = Value::from(sum(&form));
    serde_json::from_value(form)
}
