//! Properties of every run, in fixed and in random scenes.

mod fiber_frames;
mod properties;
mod random_scenes;
mod yielding_solids;
