//! The scene of the example `containment`.
#![allow(dead_code, reason = "that example writes files as well")]

use super::AnyError;

#[path = "../containment/case.rs"]
pub(crate) mod case;
#[path = "../common/containment.rs"]
pub(crate) mod containment;
#[path = "../containment/options.rs"]
pub(crate) mod options;
