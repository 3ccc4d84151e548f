use bryant::build_on_demand::Text;
use bryant::build_on_demand::message::Messages;

const MODULE: &str = "mod a {\n// drag.rs\n\nfn drag() {\n    let x = y;\n}\n}\n";

fn error(file: &str, line: u64) -> String {
    serde_json::json!({
            "message": "cannot find value `y` in this scope",
            "level": "error",
            "rendered": "error[E0425]: cannot find value `y`",
            "spans": [{
                "file_name": file, "line_start": line, "line_end": line, "column_start": 13, "column_end": 14,
                "is_primary": true, "label": "not found in this scope",
            }],
            "children": [],
        })
        .to_string()
}

#[test]
fn an_error_in_the_users_text_is_one_of_the_users_file() {
    let texts = [Text {
        name: "models/drag.rs",
        text: "fn drag() {\n    let x = y;\n}\n",
    }];
    let found = |file, line| {
        let messages = Messages::parse(&error(file, line));
        let found = messages.in_texts(MODULE, &texts);
        found.map(|all| {
            (
                all.problems[0].line,
                all.problems[0].column,
                all.problems[0].excerpt.clone(),
            )
        })
    };
    let place = (2, 13, "    let x = y;".to_owned());
    assert_eq!(found("/anywhere/x/model.rs", 5), Some(place));
    // before the text, behind it, and in another file
    assert_eq!(found("/anywhere/x/model.rs", 3), None);
    assert_eq!(found("/anywhere/x/model.rs", 7), None);
    assert_eq!(found("/anywhere/x/main.rs", 5), None);
}

#[test]
fn what_is_no_message_is_kept_for_people() {
    let messages = Messages::parse(&format!("linker `cc` not found\n{}", error("model.rs", 5)));
    assert!(messages.text.contains("linker `cc`") && messages.text.contains("E0425"));
    assert_eq!(
        messages.first_error(),
        "cannot find value `y` in this scope"
    );
    assert_eq!(Messages::parse("\n segfault \n").first_error(), "segfault");
    assert_eq!(
        Messages::parse("").first_error(),
        "the compiler printed no message"
    );
}
