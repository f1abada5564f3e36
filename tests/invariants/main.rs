//! What holds for every run: properties of given scenes and of random ones.

mod properties;
mod random_scenes;
