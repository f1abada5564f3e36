//! Documents and tables: text between markers, comma-separated files, the machine that a table was made on.

use std::path::Path;
use std::process::Command;

/// Error that ends a study.
pub(crate) type AnyError = Box<dyn std::error::Error + Send + Sync>;

/// Puts `text` between the markers of this name in a file of `benches/studies/tables`.
pub(crate) fn splice(file: &str, name: &str, text: &str) -> Result<(), AnyError> {
    splice_into(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tables").join(file), name, text)
}

/// Puts `text` between the markers of this name in a file.
pub(crate) fn splice_into(path: &Path, name: &str, text: &str) -> Result<(), AnyError> {
    let begin = format!("<!-- {name}: begin -->");
    let end = format!("<!-- {name}: end -->");
    let old_text = std::fs::read_to_string(path)?;
    let parts = old_text.split_once(&begin).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(&end)?;
        Some([before, after])
    });
    let Some([before, after]) = parts else {
        return Err(format!("{}: no markers '{begin}', '{end}'", path.display()).into());
    };
    let new_text = format!("{before}{begin}\n\n{}\n\n{end}{after}", text.trim());
    Ok(std::fs::write(path, new_text)?)
}

/// Writes a comma-separated file: its columns, then its rows.
pub(crate) fn write_csv<const N: usize>(
    path: impl AsRef<Path>,
    columns: [&str; N],
    rows: impl IntoIterator<Item = [String; N]>,
) -> Result<(), AnyError> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(columns)?;
    for row in rows {
        writer.write_record(row)?;
    }
    Ok(writer.flush()?)
}

/// Name of a file or of a part of its name: letters and digits only.
pub(crate) fn file_stem(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect()
}

/// Entry of `/proc/cpuinfo` for the first processor, or "unknown".
pub(crate) fn processor(entry: &str) -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(entry)?.split_once(": "));
    line.map_or("unknown", |(_, value)| value.trim()).to_owned()
}

/// Number of processors.
pub(crate) fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Output of a command, or "unknown".
pub(crate) fn command_output(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().ok();
    let successful = output.filter(|output| output.status.success());
    successful
        .map_or("unknown".into(), |output| String::from_utf8_lossy(&output.stdout).trim().into())
}

/// Largest resident memory of this process so far, MB; `None` where it is not available.
pub(crate) fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1.024e-3 * peak.split_whitespace().next()?.parse::<f64>().ok()?)
}
