use bryant_generator::model::digest::write_value;

#[derive(serde::Serialize)]
struct Old {
    b: f64,
    a: Vec<Option<usize>>,
    c: Variant,
}

#[derive(serde::Serialize)]
struct New<'a> {
    a: Vec<Option<usize>>,
    b: f64,
    c: Variant,
    flag: bool,
    more: Vec<f64>,
    name: &'a str,
    other: Option<f64>,
}

#[derive(serde::Serialize)]
enum Variant {
    Plain,
    With(f64),
}

fn text(value: &impl serde::Serialize) -> String {
    let mut text = String::new();
    write_value(&serde_yaml::to_value(value).unwrap(), &mut text);
    text
}

/// Types, order and fields that say nothing leave no trace; whatever says something does.
#[test]
fn a_text_has_what_is_said() {
    let kinds = || [Variant::Plain, Variant::With(0.1)];
    let old = kinds().map(|c| {
        text(&Old {
            b: f64::INFINITY,
            a: vec![None, Some(2)],
            c,
        })
    });
    assert_eq!(
        old,
        [
            "{a=[~;2;];b=inf;c=5:Plain;}",
            "{a=[~;2;];b=inf;c=!With 0.1;}"
        ]
    );
    let new = |flag, more: &[f64], name, other| {
        let more = more.to_vec();
        kinds().map(|c| {
            text(&New {
                a: vec![None, Some(2)],
                b: f64::INFINITY,
                c,
                flag,
                more: more.clone(),
                name,
                other,
            })
        })
    };
    assert_eq!(new(false, &[], "", None), old);
    let all = [
        new(true, &[], "", None),
        new(false, &[0.0], "", None),
        new(false, &[], "x", None),
        new(false, &[], "", Some(0.0)),
        new(false, &[-0.0], "", None),
    ];
    for (i, one) in all.iter().enumerate() {
        assert!(
            *one != old && all[..i].iter().all(|other| other != one),
            "{one:?}"
        );
    }
}
