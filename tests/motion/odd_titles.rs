//! GOAL: a column is never read in another unit than its title names.
//! SCENE: titles of one or several lines, in brackets and without, behind marks of comments.
//! REFERENCE: the unit in the title.

use basemat::motion::{AccelerationUnit, ColumnFormat, Record, RecordFormat};

use basemat_problems::faults::is_value;

use super::refusal;

const METRIC: AccelerationUnit = AccelerationUnit::MetrePerSecondSquared;
const G: AccelerationUnit = AccelerationUnit::StandardGravity;

fn pairs() -> ColumnFormat {
    ColumnFormat::new(METRIC)
}

/// Two samples under a header, 0.02 s apart.
#[track_caller]
fn is_read(header: &str, rows: &str, format: &ColumnFormat) {
    let text = format!("{header}\n{rows}");
    let record = Record::from_reader("text", text.as_bytes(), format);
    assert_eq!(record.unwrap_or_else(|error| panic!("{header:?}: {error}")).len(), 2);
}

#[track_caller]
fn is_refused(header: &str, rows: &str, format: &ColumnFormat) {
    let text = format!("{header}\n{rows}");
    match Record::from_reader("text", text.as_bytes(), format) {
        Ok(_) => panic!("{header:?} is read"),
        Err(error) => {
            assert!(
                error.to_string().contains("must be without another unit than"),
                "{header:?}: {error}"
            );
        }
    }
}

const ROWS: &str = "0,1\n0.02,2\n";

/// Titles above the last line of the header count, too.
#[test]
fn every_line_of_the_header_counts() {
    let g = ColumnFormat::new(G);
    for (header, lines) in [
        ("# t (ms), a (cm/s2)\n# ------", 0),
        ("# t (s), a (cm/s2)\n# ------", 0),
        ("# t (s), a (cm/s2)\n#\n# El Centro 1940\n#", 0),
        ("# time (ms), a\nt,a", 0),
        ("time,acc\n(s),(cm/s2)", 2),
        ("time,acc\n[s],[cm/s2]", 2),
        ("time;acc\n(ms);(g)", 2),
        ("time,acc\ns,cm/s2", 2),
        ("(s),(cm/s2)\ntime,acc", 2),
        ("El Centro\ntime acc\n(s) (cm/s2)\n1 2", 4),
        ("# t (s), a (cm/s2)\nt,a", 0),
        ("# Time (ms)\n# Acceleration (g)", 0),
        ("# Time (s)\n# Acceleration (cm/s2)", 0),
        ("# Acceleration in cm/s2\n# of El Centro, component North-South", 0),
    ] {
        is_refused(header, ROWS, &ColumnFormat { header_lines: lines, ..g });
    }
    for (header, lines) in [
        ("# t (s), a (g)\n# ------", 0),
        ("time,acc\n(s),(g)", 2),
        ("time,acc\n[sec],[g]", 2),
        ("time acc\ns g", 2),
        // The line next to the numbers.
        ("# recorded: t (ms), a (cm/s2)\nt (s),a (g)", 0),
        ("# Time (s)\n# Acceleration (g)", 0),
        // Values are no titles.
        ("# PGA (cm/s2): 312\nt,a", 0),
        ("# PGA (cm/s2) 312.8\nt,a", 0),
        ("# depth 10 (km), Vs30 360 (m/s)", 0),
        ("# PGA = 312 cm/s2, Mw 6.9", 0),
        ("# (ms)", 0),
        ("# Time of the peak 2.04 (min)", 0),
    ] {
        is_read(header, ROWS, &ColumnFormat { header_lines: lines, ..g });
    }
    is_refused("# time, NS, EW\n# units: cm/s2", "0,1,2\n0.02,3,4\n", &g);
    is_refused("時間（s）,加速度（gal）", ROWS, &g);
    // Names of components come from the line that has them.
    let text = "time,NS,EW\n(s),(g),(g)\n0,1,2\n0.02,3,4\n";
    let format = ColumnFormat { header_lines: 2, ..g };
    let all = format.parse_all("text", &mut text.as_bytes()).unwrap();
    assert_eq!([&all[0].0, &all[1].0], ["NS", "EW"]);
}

/// Units without brackets, and units in spellings that no one expects.
#[test]
fn every_spelling_of_a_unit_counts() {
    let g = ColumnFormat::new(G);
    for header in [
        "t,cm/s2",
        "ms,g",
        "ms,cm/s2",
        "t,m/s2",
        "t,mg",
        "t,%g",
        "t (s),a (m s-2)",
        "t,a (cm/sec²)",
        "t,a (ms-2)",
        "t,a (m/s^-2)",
        "t,a (cm s-2)",
        "t,a (mm/s2)",
        "t,a (mg)",
        "t,a (%g)",
        "t,a (m·s⁻²)",
        "t,a (milli-g)",
        "t,a (10^-3 g)",
        "t,a_m_s2",
        "t,\"a (cm/s2)\"",
        "t; a, cm/s2",
        "Time, s, Acc, cm/s2",
        "Elapsed time [s] Ground acceleration [cm/s2]",
        "Elapsed time  Ground acceleration (gal)",
        "Time sec\tGround acc cm/s2",
        "t (s), CH 1 (cm/s2)",
        "t s a cm/s2",
        "t in s a in cm/s2",
        "t / s, a / (m/s²)",
        "t,velocity_m_per_s",
        "t,velocity",
        "t (s), a (cm/s2, filtered)",
        "h,a",
        "sample,a",
        "% t (s), a (cm/s2)",
        "// t (s), a (cm/s2)",
    ] {
        is_refused(header, ROWS, &g);
    }
    for header in [
        "t,g",
        "s,g",
        "t (s),a (g)",
        "t,a (NS)",
        "t,a (CH1)",
        "t,a (H1)",
        "t,a (MS-2)",
        "t,a_min",
        "t,input",
        "t,in",
        "Time, s, Acc, g",
        "Elapsed time [s] Ground acceleration [g]",
        "T,G",
        "t,S",
        "t,a (S)",
        "t,a (V)",
        "t,H/V",
        "t,a (50g)",
        "t,a (360)",
        "t,a (filtered)",
        "\"t (s)\",\"a (g)\"",
        "t,a (g, filtered)",
        "t,n",
    ] {
        is_read(header, ROWS, &g);
    }
    // Not UTF-8, as spreadsheets write it.
    for (unit, read) in [(AccelerationUnit::Gal, true), (G, false)] {
        let text = b"t (s),a (cm/s\xb2)\n0,1\n0.02,2\n";
        let record = Record::from_reader("text", &text[..], &ColumnFormat::new(unit));
        assert_eq!(record.is_ok(), read, "{record:?}");
    }
}

/// Cells at the end of a line that are empty in the titles or in the numbers.
#[test]
fn empty_cells_do_not_hide_a_unit() {
    let g = ColumnFormat::new(G);
    for (header, rows) in [
        ("t (s),a (cm/s2),", ROWS),
        ("t (s),a (cm/s2)", "0,1,\n0.02,2,\n"),
        ("t (s),a (cm/s2),", "0,1,\n0.02,2,\n"),
        ("t (s),a (cm/s2),remark", "0,1,\n0.02,2,end\n"),
    ] {
        is_refused(header, rows, &g);
        is_read(&header.replace("cm/s2", "g"), rows, &g);
    }
    // The column of row numbers that has no title.
    let third = ColumnFormat { time_column: 2, acceleration_column: Some(3), ..g };
    is_refused(",t (s),a (cm/s2)", "0,0,1\n1,0.02,2\n", &third);
    is_read(",t (s),a (g)", "0,0,1\n1,0.02,2\n", &third);
}

#[test]
fn titles_of_a_single_column_are_whole_lines() {
    let alone = ColumnFormat::equally_spaced(G, 0.02);
    for header in [
        "Ground acceleration (cm/s2)",
        "Acc. in cm/s2",
        "# acceleration, cm/s2",
        "cm/s2",
        "CH1 [gal]",
    ] {
        is_refused(header, "1\n2\n", &alone);
    }
    for header in [
        "Ground acceleration (g)",
        "Acc. in g",
        "# 0.02 s",
        "# PGA 0.3 m/s2",
        "# PGA = 312 (cm/s2)",
    ] {
        is_read(header, "1\n2\n", &alone);
    }
}

/// A title that names another unit than the file is read in.
#[test]
fn titles_are_held_against_the_format() {
    for text in [
        "time(ms),a\n0,1\n0.02,2\n",
        "# time (ms), a (m/s2)\n0,1\n0.02,2\n",
        "time (ms) a\n0 1\n0.02 2\n",
        "t,a (cm/s2)\n0,1\n0.02,2\n",
        "t a [g]\n0 1\n0.02 2\n",
        "time_s,velocity (cm/s)\n0,1\n0.02,2\n",
        "time_s,acceleration_g\n0,1\n0.02,2\n",
        "a (m/s2),t (s)\n0,1\n0.02,2\n",
    ] {
        let (line, reason) = refusal(text, &pairs());
        assert!(line == 2 && is_value(&reason, "title"), "{text:?}: {reason}");
    }
    for text in [
        "time (s),a (m/s2)\n0,1\n0.02,2\n",
        "time_s,acceleration_m_per_s2\n0,1\n0.02,2\n",
        "t (sec) a (m/sec/sec)\n0 1\n0.02 2\n",
        "t,a (filtered)\n0,1\n0.02,2\n",
        // Of other columns, and of other lines.
        "t,a,v (cm/s)\n0,1,5\n0.02,2,5\n",
        "# (ms)\n0,1\n0.02,2\n",
    ] {
        let record = Record::from_reader("text", text.as_bytes(), &pairs()).unwrap();
        assert_eq!(
            (record.time_step(), record.accelerations()),
            (0.02, &[1.0, 2.0][..]),
            "{text:?}"
        );
    }
}

/// Titles that are as long as a line may be cost no more than their length.
#[test]
fn long_titles_are_read_at_once() {
    let alone = ColumnFormat::equally_spaced(G, 0.02);
    for word in ["a ", "a_", "(m/", "[", "m s ", "g x ", "1 g/", "n,"] {
        let title = word.repeat(60_000 / word.len());
        let header = vec![format!("# {title}"); 2].join("\n");
        is_read(&header, "1\n2\n", &alone);
    }
}
