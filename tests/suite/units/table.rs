use bryant::table::{Column, Layout, Table};

fn column(name: &str, unit: &str, values: &[f64]) -> Column {
    Column {
        name: name.into(),
        unit: unit.into(),
        values: values.to_vec(),
    }
}

/// The rows of figure 5 of the paper, at times when all columns have values.
fn figure_5() -> Table {
    Table {
        columns: vec![
            column("time", "s", &[0.0, 0.002, 0.004]),
            column("lap belt force", "N", &[0.0, -1e-9, 1183.4]),
            column("head acceleration", "m/s^2", &[0.0, 39.6, 190.2]),
            column("head excursion", "m", &[0.0, 0.0004, 0.0228]),
        ],
    }
}

#[test]
fn reads_like_the_table_of_1980() {
    let text = figure_5().text(Layout::default());
    let lines: Vec<&str> = text.lines().collect();
    // Headings of two lines, units, rows; the time of a row has no more decimals than it needs.
    assert_eq!(lines.len(), 2 + 1 + 3, "{text}");
    assert_eq!(
        lines[2], "  [s]       [N]        [m/s²]        [m]",
        "{text}"
    );
    assert_eq!(
        lines[3], "0.000         0             0     0.0000",
        "{text}"
    );
    assert_eq!(
        lines[4], "0.002         0            40     0.0004",
        "{text}"
    );
    assert_eq!(
        lines[5], "0.004      1183           190     0.0228",
        "{text}"
    );
}

#[test]
fn wide_tables_continue_below_with_the_times() {
    let text = figure_5().text(Layout {
        width: Some(24),
        digits: None,
    });
    assert_eq!(text.matches("[s]").count(), 3, "{text}");
    assert!(text.lines().all(|l| l.chars().count() <= 24), "{text}");
}

#[test]
fn numbers_out_of_scale_keep_their_digits() {
    let table = Table {
        columns: vec![column("energy", "J", &[1.25e-12, 0.0, f64::NAN])],
    };
    let text = table.text(Layout::default());
    assert!(
        text.contains("1.25e-12") && text.ends_with("       -\n"),
        "{text}"
    );
    assert!(table.json()["rows"][2][0].is_null());
}

#[test]
fn csv_reads_back_to_the_last_bit() {
    let values = [0.1 + 0.2, -1.0 / 3.0, 6.02e23, 1e-7, 0.0];
    let table = Table {
        columns: vec![column("a, b", "", &values), column("x", "m", &values)],
    };
    let mut bytes = Vec::new();
    table.write_csv(&mut bytes).unwrap();
    let mut reader = csv::Reader::from_reader(bytes.as_slice());
    assert_eq!(reader.headers().unwrap(), vec!["a, b", "x [m]"]);
    let read: Vec<f64> = reader
        .records()
        .map(|r| r.unwrap()[0].parse().unwrap())
        .collect();
    assert_eq!(read, values);
}
