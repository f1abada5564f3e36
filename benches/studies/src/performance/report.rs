//! Times, and tables of them in Markdown.

use crate::document::{command_output, processor, threads};
use std::fmt::Write as _;

/// A result, and its processor time on this thread, s.
pub(crate) struct Timed<T> {
    pub(crate) result: T,
    pub(crate) seconds: f64,
}

pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> Timed<T> {
    let start_time = cpu_time::ThreadTime::now();
    let result = work();
    Timed { result, seconds: start_time.elapsed().as_secs_f64() }
}

/// The table of targets, and the other tables.
pub(crate) struct Report {
    targets: String,
    rest: String,
}

impl Report {
    pub(crate) fn new() -> Self {
        let head = "| what | target | measured | met |\n|---|---|---|---|\n";
        Self { targets: head.into(), rest: String::new() }
    }

    /// A row of the targets.
    pub(crate) fn target(&mut self, quantity: &str, target: &str, measured: &str, met: bool) {
        eprintln!("{quantity}: {measured} ({target})");
        let met = if met { "yes" } else { "**no**" };
        // Writing to a string does not fail.
        let _ = writeln!(self.targets, "| {quantity} | {target} | {measured} | {met} |");
    }

    /// Another table.
    pub(crate) fn table(&mut self, title: &str, head: &[&str], rows: &[Vec<String>]) {
        let mut table = format!("\n### {title}\n\n| {} |\n", head.join(" | "));
        let rule = vec!["---"; head.len()].join(" | ");
        // Writing to a string does not fail.
        let _ = writeln!(table, "| {rule} |");
        for row in rows {
            let _ = writeln!(table, "| {} |", row.join(" | "));
        }
        eprintln!("{table}");
        self.rest += &table;
    }

    /// All tables, with the machine on which they were measured.
    pub(crate) fn text(&self) -> String {
        let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        let load = load.split_whitespace().next().unwrap_or("unknown").to_owned();
        let rustc = command_output("rustc", &["--version"]);
        let sources = command_output("git", &["describe", "--always", "--dirty", "--tags"]);
        format!(
            "{}, {} processors, {} cache, load {load} at the end; {rustc}, no target \
             features beyond the default; basemat {}, sources {sources}.\n\n{}{}",
            processor("model name"),
            threads(),
            processor("cache size"),
            env!("CARGO_PKG_VERSION"),
            self.targets,
            self.rest
        )
    }
}
