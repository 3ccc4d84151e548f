//! Tables as programs and people write them, and what is refused.

use super::{Fault, Field, Heading, Table};

/// All numbers of a table; whether the first line has headings is seen from its first field. Missing numbers are NaN.
fn numbers(text: &str) -> Result<Vec<Vec<f64>>, Fault> {
    let table = Table::of(text)?.expect("a line with content");
    let rows = table.rows(table.is_headed(0));
    rows.map(|row| {
        let numbers = row?.into_iter().map(|field| field.number());
        numbers
            .map(|number| number.map(|number| number.unwrap_or(f64::NAN)))
            .collect()
    })
    .collect()
}

#[test]
fn separators_quotes_comments_and_line_ends() {
    let expected = Ok(vec![vec![0.0, 1.5], vec![2e-3, -4.0]]);
    for text in [
        "0,1.5\n2e-3,-4\n",
        "0;1.5\n2e-3;-4",
        "0\t1.5\n2e-3\t-4\n\n\n",
        "\u{feff}time,ax\r\n0, 1.5\r\n2e-3 , -4\r\n",
        "# made by hand\ntime;ax\n\n0;1.5\n # in between\n0.002;-4",
        "\"time\"\t\"a, x; y\"\n0\t1.5\n.002\t-4.0\n",
        // a separator in a heading that no line of numbers has
        "time,\"a; x\"\n0,1.5\n0.002,-4\n",
        "time,angle; left\n0,1.5\n0.002,-4\n",
        "\"0\",\"1.5\"\n\"0.002\",\"-4\"\n",
        // a separator at the end of lines
        "time,ax\n0,1.5,\n0.002,-4,\n",
    ] {
        assert_eq!(numbers(text), expected, "{text:?}");
    }
    assert!(Table::of("# nothing\n\n").unwrap().is_none());
    assert!(Table::of("\u{feff}").unwrap().is_none());
    let missing = numbers("t,a\n0,\n1,2\n").unwrap();
    assert!(missing[0][1].is_nan() && missing[1] == [1.0, 2.0]);
}

#[test]
fn what_can_be_read_in_two_ways_is_refused_at_its_place() {
    for (text, place, told) in [
        // decimal commas and commas between fields
        (
            "time,ax\n0,0,0,0\n10,0,100,5\n",
            (2, 1, 7),
            "4 fields, but the line of headings has 2",
        ),
        (
            "0,0\n10,0,100,5\n",
            (2, 1, 10),
            "4 fields, but the first line has 2",
        ),
        ("time;ax\n0,0;1,5\n", (2, 1, 3), "\"0,0\" is no number"),
        ("0,5;1,5\n1,0;2\n", (1, 1, 3), "\"0,5\" is no number"),
        ("time\tax\n0\t1\n1\t2\t3\n", (3, 1, 5), "3 fields"),
        ("time,ax\n0\n", (2, 1, 1), "1 field, but"),
        ("time,ax\n0,1\n1,  2 g\n", (3, 5, 3), "\"2 g\" is no number"),
        ("time,ax\n0,\"1\n1,2\n", (2, 3, 1), "does not end"),
        ("time,ax\n0,1.000.5\n", (2, 3, 7), "is no number"),
    ] {
        let fault = numbers(text).unwrap_err();
        let found = (fault.line, fault.column, fault.length);
        assert_eq!(found, place, "{text:?}: {fault:?}");
        assert!(fault.message.contains(told), "{text:?}: {fault:?}");
        let has_comma = text.contains("0,0") || text.contains("0,5");
        assert_eq!(
            fault.help.contains("decimal"),
            has_comma,
            "{text:?}: {fault:?}"
        );
    }
}

#[test]
fn headings_have_units() {
    let is_unit = |text: &str| ["g", "ms", "m/s", "m/s^2", "km/h", "N"].contains(&text);
    for (text, name, unit) in [
        ("time [ms]", "time", Some("ms")),
        ("ax[g]", "ax", Some("g")),
        ("force [furlong]", "force", Some("furlong")),
        ("ax []", "ax", None),
        ("ax (g)", "ax", Some("g")),
        ("force (left)", "force (left)", None),
        ("force (left) [N]", "force (left)", Some("N")),
        ("ax/g", "ax", Some("g")),
        ("ax / (m/s^2)", "ax", Some("m/s^2")),
        ("t/ms", "t", Some("ms")),
        ("v m/s", "v m/s", None),
        ("km/h", "km/h", None),
        ("left/right", "left/right", None),
        ("ax", "ax", None),
        ("", "", None),
    ] {
        let field = Field {
            text,
            line: 1,
            column: 1,
            length: text.len(),
        };
        let heading = Heading::of(field, &is_unit);
        assert_eq!((heading.name, heading.unit), (name, unit), "{text}");
        assert!(heading.is_called(text) && heading.is_called(name), "{text}");
    }
}
