//! The paper's parts: thin-layer interface, end-of-step time schemes, the flow chart, and how they
//! go together.

mod combinations;
mod layer;
#[path = "../support/scenes.rs"]
mod scenes;
mod schemes;
mod search;
