use bryant::command::effects::table::{Difference, Table, difference};

#[test]
fn differences_show_calls_beside() {
    let of = |operations, calls| difference(Difference { operations, calls });
    assert_eq!(
        [of(10, 0), of(10, 2), of(-3, -1)],
        ["10", "10 + 2", "-3 - 1"]
    );
}

#[test]
fn columns_are_aligned() {
    let lines = [
        ["effect", "", "operations", "with", "without", "code", "why"].map(str::to_owned),
        ["a long one", "in", "7", "1.5", "1.0", "8", "here"].map(str::to_owned),
    ];
    let text = |timed| {
        let table = Table::of(&lines, timed, None);
        lines
            .iter()
            .map(|line| table.line(line))
            .collect::<String>()
    };
    assert_eq!(
        text(true),
        "effect          operations     with  without     code  why\n\
             a long one  in           7      1.5      1.0        8  here\n"
    );
    assert_eq!(
        text(false),
        "effect          operations  why\na long one  in           7  here\n"
    );
}

#[test]
fn reasons_fit_the_line() {
    let reason = "all seven elements share the field, so that it enters once";
    let line = ["field", "out", "", "", "", "", reason].map(str::to_owned);
    let text = |room| Table::of(std::slice::from_ref(&line), false, Some(room)).line(&line);
    assert_eq!(
        text(46),
        "field  out    all seven elements share the\n\
             \x20             field, so that it enters once\n"
    );
    assert_eq!(
        text(30),
        "field  out\n\
             \x20   all seven elements share\n\
             \x20   the field, so that it\n\
             \x20   enters once\n"
    );
}
