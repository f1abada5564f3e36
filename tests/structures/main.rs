//! Structures: finite elements, hysteresis, matrices, groups.

mod fem;
mod group;
mod hysteresis;
mod matrices;
#[path = "../support/mod.rs"]
mod support;
