//! Tests of whole runs: published problems, scenes in space and random scenes.

#[path = "../convergence.rs"]
mod convergence;
#[path = "../coupled/mod.rs"]
mod coupled;
#[path = "../identities/mod.rs"]
mod identities;
#[path = "../invariants/mod.rs"]
mod invariants;
#[path = "../published/mod.rs"]
mod published;
#[path = "../space/mod.rs"]
mod space;
