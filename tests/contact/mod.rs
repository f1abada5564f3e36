//! Contact: the problem of a step, its laws, and events inside a step.

mod adhesion;
mod bearing_capacity;
mod chatter;
mod contact_problems;
mod cyclic_yielding;
mod earth_pressure;
mod events;
mod extreme_layers;
mod host;
mod largest_convergent_step;
mod long_steps;
mod paper_parts;
mod spring_bed;
mod variable_friction;
mod yielding;
