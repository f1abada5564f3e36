//! Times, and tables of them in Markdown.

use crate::document::{processor, threads, told_by};
use std::fmt::Write as _;

/// Result of `work`, and the seconds that this thread was on a processor for it.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = cpu_time::ThreadTime::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

/// The table of targets, and those that follow.
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
    pub(crate) fn target(&mut self, what: &str, target: &str, measured: &str, met: bool) {
        eprintln!("{what}: {measured} ({target})");
        let met = if met { "yes" } else { "**no**" };
        // Writing to a string does not fail.
        let _ = writeln!(self.targets, "| {what} | {target} | {measured} | {met} |");
    }

    /// Another table.
    pub(crate) fn table(&mut self, title: &str, head: &[&str], rows: &[Vec<String>]) {
        let line = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
        let mut table = format!("\n### {title}\n\n{}", line(head));
        table += &line(&vec!["---"; head.len()]);
        for row in rows {
            table += &line(&row.iter().map(String::as_str).collect::<Vec<_>>());
        }
        eprintln!("{table}");
        self.rest += &table;
    }

    /// All of it, with the machine it was measured on.
    pub(crate) fn text(&self) -> String {
        let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        let load = load.split_whitespace().next().unwrap_or("unknown").to_owned();
        let rustc = told_by("rustc", &["--version"]);
        let sources = told_by("git", &["describe", "--always", "--dirty", "--tags"]);
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
