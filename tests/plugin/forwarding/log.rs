//! Calls that a recording part received, and methods that its trait has.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

/// Names of the methods that were called.
#[derive(Clone, Default)]
pub(crate) struct CallLog(Arc<Mutex<BTreeSet<String>>>);

impl CallLog {
    pub(crate) fn add(&self, method: &str) {
        self.0.lock().unwrap().insert(method.to_owned());
    }

    pub(crate) fn take(&self) -> BTreeSet<String> {
        std::mem::take(&mut self.0.lock().unwrap())
    }
}

/// The methods of a trait in its source.
pub(crate) fn methods(source: &str, name: &str) -> BTreeSet<String> {
    let declaration = format!("pub trait {name}");
    let start = source.find(&declaration).unwrap();
    let end = start + source[start..].find("\n}\n").unwrap();
    let mut methods = BTreeSet::new();
    for line in source[start..end].lines() {
        if let Some(signature) = line.strip_prefix("    fn ")
            && let Some((name, _)) = signature.split_once('(')
        {
            methods.insert(name.to_owned());
        }
    }
    assert!(!methods.is_empty());
    methods
}

macro_rules! source {
    ($path:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../src/", $path))
    };
}
pub(crate) use source;
