//! Tests of parts: structures, interface laws, records, files, results and refused input.

#[path = "../allocation.rs"]
mod allocation;
#[path = "../contact/mod.rs"]
mod contact;
#[path = "../errors/mod.rs"]
mod errors;
#[path = "../io/mod.rs"]
mod io;
#[path = "../motion/mod.rs"]
mod motion;
#[path = "../plugin/mod.rs"]
mod plugin;
#[path = "../results/mod.rs"]
mod results;
#[path = "../structures/mod.rs"]
mod structures;
