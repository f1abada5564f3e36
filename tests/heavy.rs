//! Tests of whole runs: published problems, scenes in space and random scenes.

mod convergence;
mod coupled;
mod identities;
mod invariants;
mod joints;
mod published;
mod space;
