use bryant_generator::description::table::{Column, Columns, Fault, Table};

fn columns(text: &str, wanted: Option<[Column; 2]>) -> Result<Columns, String> {
    match Table::new("t.csv", text).unwrap().columns(wanted.as_ref()) {
        Ok(columns) => Ok(columns),
        Err(Fault::Column(which, message, help)) => Err(format!("{which}: {message} ({help})")),
        Err(Fault::InFile(problem)) => Err(problem.line()),
    }
}

fn numbers(text: &str, wanted: Option<[Column; 2]>) -> Result<Vec<[f64; 2]>, String> {
    columns(text, wanted).map(|found| found.rows.iter().map(|r| r.values).collect())
}

fn named(x: &str, y: &str) -> Option<[Column; 2]> {
    Some([Column::Name(x.into()), Column::Name(y.into())])
}

fn numbered(x: usize, y: usize) -> Option<[Column; 2]> {
    Some([Column::Number(x), Column::Number(y)])
}

#[test]
fn columns_are_found_by_number_and_by_heading() {
    let rows = Ok(vec![[0.0, 1.5], [2e-3, -4.0]]);
    for text in [
        "0,1.5\n2e-3,-4\n",
        "\u{feff}time,ax\r\n0, 1.5\r\n2e-3 , -4\r\n",
        "# made by hand\ntime;ax\n\n0;1.5\n # in between\n0.002;-4",
        "\"time\"\t\"a, x\"\n0\t1.5\n.002\t-4.0\n",
    ] {
        assert_eq!(numbers(text, None), rows, "{text:?}");
    }
    let text = "\"t [ms]\",\"a, y\",ax\n0,9,1.5\n2e-3,9,-4\n";
    assert_eq!(numbers(text, named("t [ms]", "ax")), rows);
    assert_eq!(numbers(text, named("t", "ax")), rows);
    assert_eq!(
        numbers(text, named("ax", "a, y")),
        Ok(vec![[1.5, 9.0], [-4.0, 9.0]])
    );
    assert_eq!(
        numbers("1,2,3\n4,5,6", numbered(3, 1)),
        Ok(vec![[3.0, 1.0], [6.0, 4.0]])
    );
}

#[test]
fn headings_have_units_in_the_words_of_the_model() {
    for (text, units) in [
        ("time [ms],ax [g]\n0,1\n1,2\n", [Some("ms"), Some("gn")]),
        (
            "time (ms);ax/(m/s2)\n0;1\n1;2\n",
            [Some("ms"), Some("m/s^2")],
        ),
        ("time,force [kN]\n0,1\n1,2\n", [None, Some("kN")]),
        ("time,force (left)\n0,1\n1,2\n", [None, None]),
        ("0,1\n1,2\n", [None, None]),
    ] {
        let found = columns(text, None).unwrap().units;
        assert_eq!(found.each_ref().map(Option::as_deref), units, "{text}");
    }
}

#[test]
fn faults_are_placed() {
    let of = |text: &str| numbers(text, None).unwrap_err();
    assert_eq!(
        of("t,a\n0,1\n1,  x2\n"),
        "t.csv:3:5: \"x2\" is no number (help: write a number without unit; lines that are no data begin with `#`)"
    );
    assert!(
        of("t;a\n0;1,5\n1;2\n")
            .contains("t.csv:2:3: \"1,5\" is no number (help: its comma is a decimal mark")
    );
    assert!(of("0,1\n1\n").starts_with("t.csv:2:1: this line has 1 field"));
    assert!(of("time,ax\n0,0,0,0\n10,0,100,5\n").starts_with("t.csv:2:1: this line has 4 fields"));
    assert!(
        of("0,0,0,0\n10,0,100,5\n").starts_with("t.csv:1:5: there are 4 columns without headings")
    );
    assert!(of("0,1\n1,\n").starts_with("t.csv:2:3: here a number is missing"));
    assert!(of("0,1\n1,inf\n").starts_with("t.csv:2:3: \"inf\" is no number"));
    assert!(of("0,x\n1,2\n").starts_with("t.csv:1:3: \"x\" is no number"));
    assert!(of("t,a\n").contains("below the headings there are no numbers"));
    assert!(of("t,a\n0,1\n").contains("at least two points"));
    assert!(of("# nothing\n").contains("no numbers"));
    assert!(of("5\n6\n").starts_with("1: \"t.csv\" has no column 2: its first line has 1"));
    let wrong = numbers("time,ax\n0,1\n1,2\n", named("time", "az")).unwrap_err();
    assert_eq!(
        wrong,
        "1: \"t.csv\" has no column \"az\" (did you mean \"ax\"?)"
    );
    for equal in [
        "time,ax,ax\n0,1,2\n1,2,3\n",
        "time,ax [g],ax [m/s^2]\n0,1,2\n1,2,3\n",
    ] {
        let wrong = numbers(equal, named("time", "ax")).unwrap_err();
        assert!(
            wrong.starts_with("1: \"t.csv\" has 2 columns \"ax\""),
            "{wrong}"
        );
        // where neither is named they may be equal
        assert!(numbers(equal, None).is_ok());
    }
}
