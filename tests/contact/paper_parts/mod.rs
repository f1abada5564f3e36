//! The paper's parts: thin-layer interface, end-of-step time schemes, the flow chart, and how they
//! go together.

mod combinations;
mod layer;
mod schemes;
mod search;
