//! Tables in Markdown.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use super::AnyError;

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
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let processor = info.lines().find_map(|line| line.strip_prefix("model name"));
        let processor = processor
            .map_or(std::env::consts::ARCH, |name| name.trim_start_matches([' ', '\t', ':']));
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        let load = load.split_whitespace().next().unwrap_or("unknown").to_owned();
        let rustc = tell("rustc", &["--version"]);
        let sources = tell("git", &["describe", "--always", "--dirty", "--tags"]);
        format!(
            "{processor}, {threads} processors, {} cache, load {load} at the end; {rustc}, no target \
             features beyond the default; basemat {}, sources {sources}.\n\n{}{}",
            info.lines()
                .find_map(|line| line.strip_prefix("cache size"))
                .map_or("unknown", |size| size.trim_start_matches([' ', '\t', ':'])),
            env!("CARGO_PKG_VERSION"),
            self.targets,
            self.rest
        )
    }
}

/// What a command prints, or "unknown".
fn tell(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().ok();
    let told = output.filter(|output| output.status.success());
    told.map_or("unknown".into(), |output| String::from_utf8_lossy(&output.stdout).trim().into())
}

/// Puts `text` between the markers of `path`.
pub(crate) fn splice(path: &Path, text: &str) -> Result<(), AnyError> {
    const MARKERS: [&str; 2] = ["<!-- performance: begin -->", "<!-- performance: end -->"];
    let old = std::fs::read_to_string(path)?;
    let missing = || format!("{}: no markers '{}'", path.display(), MARKERS.join("', '"));
    let (before, rest) = old.split_once(MARKERS[0]).ok_or_else(missing)?;
    let (_, after) = rest.split_once(MARKERS[1]).ok_or_else(missing)?;
    let new = format!("{before}{}\n\n{}\n\n{}{after}", MARKERS[0], text.trim(), MARKERS[1]);
    Ok(std::fs::write(path, new)?)
}
