//! The keys of models and studies as pages and schemas show them: both follow from the declarations.

use bryant_generator::description::load::{Included, Model};
use bryant_generator::description::schema::Schema;
use bryant_generator::description::shape::Key;
use bryant_generator::description::vocabulary;
use bryant_generator::read::LANGUAGE;
use serde_json::Value;
use std::path::Path;

type Vocabulary = Vec<(&'static str, Vec<Key>)>;

/// A page with the table of keys of each record below the heading that is its title.
fn with_tables(page: &str, records: &Vocabulary) -> String {
    let capital = |title: &str| title[..1].to_uppercase() + &title[1..];
    let mut records = records.iter();
    let (mut text, mut heading, mut inside) = (String::new(), String::new(), false);
    for line in page.lines() {
        if line.starts_with('#') {
            heading = line.trim_start_matches('#').trim().to_owned();
        }
        if line.starts_with("| key |") {
            inside = true;
            let (title, keys) = records.next().expect("a record for each table");
            assert_eq!(heading, capital(title), "the order of records");
            text += "| key | unit | default | meaning |\n|---|---|---|---|\n";
            text.extend(keys.iter().map(Key::row));
        } else if !line.starts_with('|') {
            inside = false;
        }
        if !inside {
            text += line;
            text.push('\n');
        }
    }
    assert_eq!(records.next().map(|(title, _)| *title), None, "no table");
    text
}

/// All pages with tables of keys, and what they show.
fn pages() -> [(&'static str, Vocabulary); 2] {
    [
        ("reference.md", vocabulary(LANGUAGE)),
        ("studies.md", bryant_study::file::keys::vocabulary()),
    ]
}

#[test]
fn the_tables_of_keys_are_those_of_the_declarations() {
    let stale = pages().into_iter().filter(|(name, records)| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../docs")
            .join(name);
        let page = std::fs::read_to_string(&path).unwrap();
        let now = with_tables(&page, records);
        if std::env::var_os("PAGES_UPDATE").is_some() {
            std::fs::write(&path, &now).unwrap();
        }
        now != page
    });
    let stale: Vec<&str> = stale.map(|(name, _)| name).collect();
    assert!(
        stale.is_empty(),
        "{stale:?}: PAGES_UPDATE=1 renews the tables"
    );
}

#[test]
fn every_key_has_a_meaning_and_says_whether_it_is_required() {
    for (title, key) in pages()
        .into_iter()
        .flat_map(|(_, records)| records)
        .flat_map(|(title, keys)| keys.into_iter().map(move |key| (title, key)))
    {
        let Key { name, meaning, .. } = key;
        assert!(!meaning.trim().is_empty(), "{title}: {name}");
        assert!(!meaning.contains('|'), "{title}: {name}");
        // if one of several keys is required, a check of its own says so
        assert_eq!(key.default == "required", !key.optional, "{title}: {name}");
    }
}

/// All schemas as JSON.
fn schemas() -> [Value; 3] {
    [
        Schema::of::<Model>(LANGUAGE),
        Schema::of::<Included>(LANGUAGE),
        Schema::of::<bryant_study::file::Keys>(LANGUAGE),
    ]
    .map(|schema| serde_json::to_value(schema).unwrap())
}

/// Calls a function with each mapping of a value.
fn each_object(value: &Value, called: &mut dyn FnMut(&serde_json::Map<String, Value>)) {
    match value {
        Value::Object(object) => {
            called(object);
            object.values().for_each(|value| each_object(value, called));
        }
        Value::Array(items) => items.iter().for_each(|item| each_object(item, called)),
        _ => {}
    }
}

#[test]
fn references_of_a_schema_lead_to_its_definitions_and_all_of_these_are_used() {
    for schema in schemas() {
        let definitions = schema["definitions"].as_object().unwrap();
        let mut used = Vec::new();
        each_object(&schema, &mut |object| {
            let Some(reference) = object.get("$ref") else {
                return;
            };
            let name = reference
                .as_str()
                .unwrap()
                .strip_prefix("#/definitions/")
                .unwrap();
            let name = name.replace("%20", " ");
            assert!(definitions.contains_key(&name), "{name}");
            used.push(name);
        });
        for (name, definition) in definitions {
            assert!(used.contains(name) && !definition.is_null(), "{name}");
        }
    }
}

#[test]
fn sentences_of_a_schema_have_meaning_unit_and_default_without_links() {
    let records = vocabulary(LANGUAGE);
    let said = |record: &str, name: &str| {
        let (_, keys) = records.iter().find(|(title, _)| *title == record).unwrap();
        let key = keys.iter().find(|key| key.name == name).unwrap();
        key.sentence()
    };
    assert_eq!(
        said("a spring", "damping"),
        "viscous coefficient on the rate of the length [N·s/m, ≥ 0]; default: 0"
    );
    assert_eq!(
        said("a joint force", "since"),
        "the force acts from this switch on; default: the start"
    );
    assert_eq!(
        said("a curve", "points"),
        "`[abscissa, ordinate]`, at least two, abscissae increasing; numbers, not parameters [of its use]; default: required without `file`"
    );
}

#[test]
fn the_keys_of_a_schema_are_those_of_the_page() {
    let [model, included, study] = schemas();
    for (of, (_, records)) in [&model, &study].into_iter().zip(pages()) {
        for (title, keys) in records {
            let definition = match &of["definitions"][title] {
                Value::Null => &included["definitions"][title],
                found => found,
            };
            let properties = definition["properties"].as_object();
            let properties = properties.unwrap_or_else(|| panic!("{title}"));
            assert_eq!(properties.len(), keys.len(), "{title}");
            for key in keys {
                let said = properties[key.name]["description"].as_str().unwrap();
                assert_eq!(said, key.sentence(), "{title}");
                assert!(!said.contains("]("), "{title}: {said}");
                let required = definition["required"].as_array().unwrap();
                assert_eq!(
                    required.iter().any(|name| name == key.name),
                    !key.optional,
                    "{title}: {}",
                    key.name
                );
            }
        }
    }
}
