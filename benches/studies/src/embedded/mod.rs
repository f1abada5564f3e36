//! Structures in a trench: accuracy against work, kinematic interaction, and pressures on walls under shaking.
//!
//! ```text
//! cargo study embedded --docs docs
//! ```

mod accuracy;
mod kinematics;
mod pressures;

use std::path::PathBuf;

use crate::AnyError;
use crate::document::splice;

/// Structures in a trench: accuracy against work, kinematic interaction, pressures on walls.
#[derive(Debug, clap::Args)]
pub(crate) struct EmbeddedOptions {
    /// Few elements, steps and scenes, as a test.
    #[arg(long)]
    short: bool,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/embedded")]
    out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
    /// Only this part: accuracy, kinematics or pressures.
    #[arg(long)]
    part: Option<String>,
}

/// Function that makes the tables of a part; `true` makes it short.
type EmbeddedPart = fn(bool) -> Result<String, AnyError>;

/// Runs the study.
pub(crate) fn run(options: &EmbeddedOptions) -> Result<(), AnyError> {
    let parts: [(&str, EmbeddedPart); 3] = [
        ("accuracy", accuracy::tables),
        ("kinematics", kinematics::tables),
        ("pressures", pressures::tables),
    ];
    std::fs::create_dir_all(&options.out)?;
    for (name, part) in parts {
        if options.part.as_ref().is_some_and(|selected| selected != name) {
            continue;
        }
        let text = part(options.short)?;
        println!("{text}");
        std::fs::write(options.out.join(format!("{name}.md")), &text)?;
        if options.docs.is_some() {
            splice("embedded.md", name, &text)?;
        }
    }
    Ok(())
}
