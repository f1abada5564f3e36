//! Statements that hold for every run: properties of given and of random scenes.

mod properties;
mod random_scenes;
mod yielding_solids;
