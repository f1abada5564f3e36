//! Files of the strong-motion databases: layouts in use, refusals, any bytes.

use basemat::motion::{
    AccelerationUnit, CosmosFormat, KNetFormat, PeerFormat, Record, RecordFormat, el_centro_1940,
};
use basemat::{Error, RecordError};
use proptest::prelude::*;

const GRAVITY: f64 = 9.80665;

fn read(text: &str, format: &dyn RecordFormat) -> Result<Record, Error> {
    Record::from_reader("file", text.as_bytes(), format)
}

#[track_caller]
fn refusal(text: &str, format: &dyn RecordFormat) -> (usize, RecordError) {
    match read(text, format) {
        Err(Error::Record { line, reason, .. }) => (line, reason),
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn same(record: &Record, step: f64, wanted: &[f64]) {
    assert!((record.time_step() / step - 1.0).abs() < 1e-15);
    assert_eq!(record.len(), wanted.len());
    for (found, wanted) in record.accelerations().iter().zip(wanted) {
        assert!((found - wanted).abs() <= 1e-14 * wanted.abs(), "{found} {wanted}");
    }
}

const PEER_TITLE: &str = "PEER NGA STRONG MOTION DATABASE RECORD\nEl Centro, 180\n";

#[test]
fn peer_headers_vary() {
    let body = " .100E-02 -.2000E-02-.300E-02\r\n  .4\r\n";
    let wanted = [1e-3, -2e-3, -3e-3, 0.4].map(|a| a * GRAVITY);
    for header in [
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   4, DT=   .0100 SEC,\n",
        "ACCELERATION TIME HISTORY IN UNITS OF G.\nNPTS= 4, DT= .01000 SEC\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=4, DT=.01\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\n   4    .0100    NPTS, DT\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\n 4, 0.0100, NPTS, DT\n",
        "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS =   4, DT =  1.0E-02SEC\n",
    ] {
        let record = read(&format!("{PEER_TITLE}{header}{body}"), &PeerFormat).unwrap();
        same(&record, 0.01, &wanted);
    }
}

#[test]
fn peer_files_that_do_not_hold_what_they_say_are_refused() {
    let title = format!("{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\n");
    let with = |rest: &str| refusal(&format!("{title}{rest}"), &PeerFormat);
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2\n"), (5, counted(2, 3)));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2\n3 4\n"), (6, counted(4, 3)));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 3\n\n4\n"), (7, counted(4, 3)));
    let number = |text: &str| RecordError::NotANumber { text: text.into() };
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 x3\n"), (5, number("x3")));
    assert_eq!(with("NPTS= 3, DT= .01 SEC\n1 2 ***\n"), (5, number("***")));
    for header in ["NPTS= 3, DT= 0 SEC", "NPTS= 1, DT= 1", "NPTS=, DT=", "NPTS= 1e99, DT=.1"] {
        let (line, reason) = with(&format!("{header}\n1 2 3\n"));
        assert!(line == 4 && matches!(reason, RecordError::Missing { .. }), "{header}: {reason}");
    }
    let (_, reason) = refusal(&format!("{PEER_TITLE}no numbers\n"), &PeerFormat);
    assert!(matches!(reason, RecordError::Missing { .. }));
    for other in ["VELOCITY TIME SERIES IN UNITS OF CM/S", "ACCELERATION IN UNITS OF CM/S/S"] {
        let text = format!("{PEER_TITLE}{other}\nNPTS= 2, DT= .01 SEC\n1 2\n");
        let (line, reason) = refusal(&text, &PeerFormat);
        assert!(line == 3 && matches!(reason, RecordError::NotAcceleration { .. }), "{reason}");
    }
}

fn counted(found: usize, needed: usize) -> RecordError {
    RecordError::SampleCount { found, needed }
}

#[test]
fn k_net_counts_become_accelerations() {
    let header = "Origin Time       2011/03/11 14:46:00\nLat.              38.103\n\
        Station Code      MYG004\nSampling Freq(Hz) 100Hz\nDuration Time(s)  DUR\nDir.              N-S\n\
        Scale Factor      7845(gal)/8223790\nMax. Acc. (gal)   2699.891\nMemo.\n";
    let two_seconds = header.replace("DUR", "2");
    let counts: Vec<i32> = (0..200).map(|k| 100 - 7 * k * k).collect();
    let lines: Vec<String> = counts
        .chunks(8)
        .map(|row| row.iter().map(|count| format!("{count:9}")).collect::<Vec<_>>().concat())
        .collect();
    let text = format!("{two_seconds}{}\n", lines.join("\n"));
    let wanted: Vec<f64> =
        counts.iter().map(|&count| f64::from(count) * 78.45 / 8_223_790.0).collect();
    same(&read(&text, &KNetFormat).unwrap(), 0.01, &wanted);

    // The last line lost, or a second too many.
    let short = format!("{two_seconds}{}\n", lines[..24].join("\n"));
    assert_eq!(refusal(&short, &KNetFormat), (33, counted(192, 200)));
    assert_eq!(refusal(&text.replace("(s)  2", "(s)  3"), &KNetFormat), (34, counted(200, 300)));
    for (key, other) in [
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz) 0Hz"),
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz)"),
        ("Duration Time(s)  2", "Duration"),
        ("7845(gal)/8223790", "7845(gal)/0"),
        ("7845(gal)/8223790", "7845(m)/8223790"),
        ("Memo.", "Remark"),
    ] {
        let (_, reason) = refusal(&text.replace(key, other), &KNetFormat);
        assert!(matches!(reason, RecordError::Missing { .. }), "{other}: {reason}");
    }
}

const CSMIP: &str = "Corrected accelerogram from Chan  1\n\
    3 points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n\
    1.000-12345.678     3.000\n\
    3 points of veloc data equally spaced at  .020 sec, in cm/sec.  (8f10.3)\n\
    1.000     2.000     3.000\n/&  ---------- End of data for channel  1 ----------\n\
    Corrected accelerogram from Chan  2\n\
    2 points of accel data equally spaced at  .010 sec, in g. (8f10.3)\n   .5 -.5\n";

#[test]
fn csmip_files_hold_channels() {
    let format = CosmosFormat::default();
    same(&read(CSMIP, &format).unwrap(), 0.02, &[0.01, -123.45678, 0.03]);
    let second = format.with_channel(2);
    same(&read(CSMIP, &second).unwrap(), 0.01, &[0.5 * GRAVITY, -0.5 * GRAVITY]);
    for needed in [0, 3] {
        let (_, reason) = refusal(CSMIP, &format.with_channel(needed));
        assert_eq!(reason, RecordError::Channel { found: 2, needed });
    }
    let counts = CSMIP.replace("in g.", "in counts.");
    assert!(matches!(refusal(&counts, &second).1, RecordError::NotAcceleration { .. }));
    let short = &CSMIP[..CSMIP.len() - 5];
    assert_eq!(refusal(short, &second), (9, counted(1, 2)));
}

#[test]
fn cosmos_takes_the_interval_from_its_real_header() {
    let mut header = vec![-999.0; 100];
    header[33] = 5.0;
    let rows: Vec<String> = header
        .chunks(6)
        .map(|row| row.iter().map(|value| format!("{value:13.6}")).collect::<Vec<_>>().concat())
        .collect();
    let text = format!(
        "Corrected acceleration (Format v01.20 with 13 text lines)\n\
         100 Real-header values follow on  17 lines, Format= (6F13.6)\n{}\n\
         1 Comment line(s) follow, each starting with a \"|\":\n| acceleration\n\
         10 acceleration pts, approx  0 secs, units=cm/s^2 (4),Format=(10F8.5)\n\
         -0.00003-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004-0.00004 9.99999\n\
         End-of-data for Chan  1 acceleration\n",
        rows.join("\n")
    );
    let mut wanted = [-4e-7; 10];
    (wanted[0], wanted[9]) = (-3e-7, 0.0999_999);
    same(&read(&text, &CosmosFormat::default()).unwrap(), 0.005, &wanted);
    let unknown = text.replace("     5.000000", "  -999.000000");
    let (_, reason) = refusal(&unknown, &CosmosFormat::default());
    assert_eq!(reason, RecordError::Missing { quantity: "sampling interval" });
    let counts = text.replace("cm/s^2 (4)", "counts (50)");
    let (_, reason) = refusal(&counts, &CosmosFormat::default());
    assert!(matches!(reason, RecordError::NotAcceleration { .. }));
}

/// El Centro, printed as each of the formats print, comes back to the digits printed.
#[test]
fn el_centro_survives_all_formats() {
    let record = el_centro_1940();
    let in_g: Vec<f64> = record.accelerations().iter().map(|a| a / GRAVITY).collect();
    let rows = |numbers: Vec<String>, columns: usize| {
        numbers.chunks(columns).map(|row| row.concat() + "\n").collect::<String>()
    };
    let count = in_g.len();
    let peer = format!(
        "{PEER_TITLE}ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  {count}, DT=   .0200 SEC\n{}",
        rows(in_g.iter().map(|a| format!("{a:15.7E}")).collect(), 5)
    );
    let csmip = format!(
        "{count} points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.3)\n{}",
        rows(in_g.iter().map(|a| format!("{:10.4}", a * 100.0 * GRAVITY)).collect(), 8)
    );
    let formats: [(String, &dyn RecordFormat); 2] =
        [(peer, &PeerFormat), (csmip, &CosmosFormat::default())];
    for (text, format) in formats {
        let read = read(&text, format).unwrap();
        assert_eq!((read.len(), read.time_step()), (count, 0.02));
        for (found, wanted) in read.accelerations().iter().zip(record.accelerations()) {
            assert!((found - wanted).abs() < 0.51e-6, "{found} {wanted}");
        }
    }
    assert_eq!(AccelerationUnit::Gal.in_metres_per_second_squared(), 0.01);
}

/// Text much like that of records, so that inner parts are reached.
fn nearly_a_record() -> impl Strategy<Value = Vec<u8>> {
    let pieces = [
        "NPTS= 3, DT= .01 SEC\n",
        "UNITS OF G\n",
        "3 .01 NPTS, DT\n",
        "3 points of accel data equally spaced at .01 sec, in g.\n",
        "3 acceleration pts, units=cm/s^2\n",
        "3 Real-header values follow\n",
        "Sampling Freq(Hz) 3Hz\n",
        "Duration Time(s) 1\n",
        "Scale Factor 2(gal)/3\n",
        "Memo.\n",
        " 1",
        "-2.5E+3",
        "+",
        "E",
        "nan",
        "\n",
        "\u{feff}",
        "é",
        "1e308",
        " 99999999999",
    ];
    prop::collection::vec(prop::sample::select(pieces.to_vec()), 0..30)
        .prop_map(|pieces| pieces.concat().into_bytes())
}

proptest! {
    #[test]
    fn readers_never_panic(
        bytes in prop_oneof![prop::collection::vec(any::<u8>(), 0..300), nearly_a_record()],
        channel in 0..3_usize,
    ) {
        let cosmos = CosmosFormat::default().with_channel(channel);
        let formats: [&dyn RecordFormat; 3] = [&PeerFormat, &KNetFormat, &cosmos];
        for format in formats {
            if let Ok(record) = Record::from_reader("bytes", &bytes[..], format) {
                prop_assert!(record.len() >= 2 && record.time_step() > 0.0);
                prop_assert!(record.displacements().iter().all(|u| u.is_finite()));
            }
        }
    }
}
