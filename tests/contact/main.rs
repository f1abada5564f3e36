//! Contact: the problem of a step, its laws, and events inside a step.

mod chatter;
mod contact_problems;
mod events;
mod host;
mod paper_parts;
mod spring_bed;
#[path = "../support/mod.rs"]
mod support;
mod variable_friction;
mod yielding;
