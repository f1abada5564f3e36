//! Calls that a double received, and calls that its trait must make.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

/// Calls that a double received.
#[derive(Clone, Default)]
pub(crate) struct Log(Arc<Mutex<BTreeSet<String>>>);

impl Log {
    pub(crate) fn asked(&self, method: &str) {
        self.0.lock().unwrap().insert(method.to_owned());
    }

    pub(crate) fn take(&self) -> BTreeSet<String> {
        std::mem::take(&mut self.0.lock().unwrap())
    }
}

/// The methods of a trait, in its source.
pub(crate) fn methods(source: &str, name: &str) -> BTreeSet<String> {
    let (_, body) = source.split_once(&format!("pub trait {name}")).unwrap();
    let (body, _) = body.split_once("\n}\n").unwrap();
    let name = |line: &str| {
        let (name, _) = line.strip_prefix("    fn ")?.split_once('(')?;
        Some(name.to_owned())
    };
    let all: BTreeSet<_> = body.lines().filter_map(name).collect();
    assert!(!all.is_empty());
    all
}

macro_rules! source {
    ($path:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../src/", $path))
    };
}
pub(crate) use source;
