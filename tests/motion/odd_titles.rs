//! GOAL: a column is never read in another unit than that of its title.
//! SCENE: titles of one or several lines, in brackets and without, behind marks of comments.
//! REFERENCE: the unit in the title.

use basemat::motion::{AccelerationUnit, ColumnFormat, RecordFormat};

use basemat_problems::faults::is_value;

use super::{GRAVITY_UNIT, SI_UNIT, error_in, read};

/// Columns of time and acceleration in m/s².
fn si_columns() -> ColumnFormat {
    ColumnFormat::new(SI_UNIT)
}

/// Asserts that two samples under a header are read.
#[track_caller]
fn assert_two_samples(header: &str, rows: &str, format: &ColumnFormat) {
    let record = read(&format!("{header}\n{rows}"), format);
    assert_eq!(record.unwrap_or_else(|error| panic!("{header:?}: {error}")).len(), 2);
}

/// Asserts the error of a title with another unit.
#[track_caller]
fn assert_other_unit(header: &str, rows: &str, format: &ColumnFormat) {
    let error = read(&format!("{header}\n{rows}"), format).map(drop);
    let error = error.expect_err(header);
    assert!(error.to_string().contains("must be without another unit than"), "{header:?}: {error}");
}

/// Two samples, 0.02 s apart.
const TWO_ROWS: &str = "0,1\n0.02,2\n";

/// GOAL: titles above the last line of the header are checked, too.
#[test]
fn every_line_of_the_header_is_checked() {
    let g = ColumnFormat::new(GRAVITY_UNIT);
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
        assert_other_unit(header, TWO_ROWS, &ColumnFormat { header_lines: lines, ..g });
    }
    for (header, lines) in [
        ("# t (s), a (g)\n# ------", 0),
        ("time,acc\n(s),(g)", 2),
        ("time,acc\n[sec],[g]", 2),
        ("time acc\ns g", 2),
        // The line next to the numbers counts first.
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
        assert_two_samples(header, TWO_ROWS, &ColumnFormat { header_lines: lines, ..g });
    }
    assert_other_unit("# time, NS, EW\n# units: cm/s2", "0,1,2\n0.02,3,4\n", &g);
    assert_other_unit("時間（s）,加速度（gal）", TWO_ROWS, &g);
    // Names of components are taken from the line that has them.
    let text = "time,NS,EW\n(s),(g),(g)\n0,1,2\n0.02,3,4\n";
    let format = ColumnFormat { header_lines: 2, ..g };
    let records = format.parse_all("text", &mut text.as_bytes()).unwrap();
    assert_eq!([&records[0].0, &records[1].0], ["NS", "EW"]);
}

/// GOAL: units without brackets and in unusual spellings are checked.
#[test]
fn every_spelling_of_a_unit_is_checked() {
    let g = ColumnFormat::new(GRAVITY_UNIT);
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
        assert_other_unit(header, TWO_ROWS, &g);
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
        assert_two_samples(header, TWO_ROWS, &g);
    }
    // Not UTF-8, as spreadsheets write it.
    for (unit, is_accepted) in [(AccelerationUnit::Gal, true), (GRAVITY_UNIT, false)] {
        let record = read(b"t (s),a (cm/s\xb2)\n0,1\n0.02,2\n", &ColumnFormat::new(unit));
        assert_eq!(record.is_ok(), is_accepted, "{record:?}");
    }
}

/// GOAL: cells at the end of a line that are empty in titles or numbers do not hide a unit.
#[test]
fn empty_cells_do_not_hide_a_unit() {
    let g = ColumnFormat::new(GRAVITY_UNIT);
    for (header, rows) in [
        ("t (s),a (cm/s2),", TWO_ROWS),
        ("t (s),a (cm/s2)", "0,1,\n0.02,2,\n"),
        ("t (s),a (cm/s2),", "0,1,\n0.02,2,\n"),
        ("t (s),a (cm/s2),remark", "0,1,\n0.02,2,end\n"),
    ] {
        assert_other_unit(header, rows, &g);
        assert_two_samples(&header.replace("cm/s2", "g"), rows, &g);
    }
    // The column of row numbers that has no title.
    let third = ColumnFormat { time_column: 2, acceleration_column: Some(3), ..g };
    assert_other_unit(",t (s),a (cm/s2)", "0,0,1\n1,0.02,2\n", &third);
    assert_two_samples(",t (s),a (g)", "0,0,1\n1,0.02,2\n", &third);
}

/// GOAL: the title of a single column is the whole line.
#[test]
fn titles_of_a_single_column_are_whole_lines() {
    let single_column = ColumnFormat::equally_spaced(GRAVITY_UNIT, 0.02);
    for header in [
        "Ground acceleration (cm/s2)",
        "Acc. in cm/s2",
        "# acceleration, cm/s2",
        "cm/s2",
        "CH1 [gal]",
    ] {
        assert_other_unit(header, "1\n2\n", &single_column);
    }
    for header in [
        "Ground acceleration (g)",
        "Acc. in g",
        "# 0.02 s",
        "# PGA 0.3 m/s2",
        "# PGA = 312 (cm/s2)",
    ] {
        assert_two_samples(header, "1\n2\n", &single_column);
    }
}

/// GOAL: a title with another unit than the format's is an error; titles of other columns and lines are not checked.
#[test]
fn titles_are_compared_with_the_format() {
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
        let error = error_in(text, &si_columns());
        assert!(error.line == 2 && is_value(&error.fault, "title"), "{text:?}: {error}");
    }
    for text in [
        "time (s),a (m/s2)\n0,1\n0.02,2\n",
        "time_s,acceleration_m_per_s2\n0,1\n0.02,2\n",
        "t (sec) a (m/sec/sec)\n0 1\n0.02 2\n",
        "t,a (filtered)\n0,1\n0.02,2\n",
        // Units of other columns, and of other lines.
        "t,a,v (cm/s)\n0,1,5\n0.02,2,5\n",
        "# (ms)\n0,1\n0.02,2\n",
    ] {
        let record = read(text, &si_columns()).unwrap();
        assert_eq!(
            (record.time_step(), record.accelerations()),
            (0.02, &[1.0, 2.0][..]),
            "{text:?}"
        );
    }
}

/// GOAL: reading a title takes time proportional to its length, up to the longest line.
#[test]
fn long_titles_are_read_at_once() {
    let single_column = ColumnFormat::equally_spaced(GRAVITY_UNIT, 0.02);
    for word in ["a ", "a_", "(m/", "[", "m s ", "g x ", "1 g/", "n,"] {
        let title = word.repeat(60_000 / word.len());
        let header = vec![format!("# {title}"); 2].join("\n");
        assert_two_samples(&header, "1\n2\n", &single_column);
    }
}
