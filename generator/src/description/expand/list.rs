//! Lists in one entry: several joints with one law, several surfaces in one contact, several things in one output.

use super::{Expander, Node};
use crate::description::tree::{Entry, NodeKind};

/// The keys of `about` that stand for several rotations.
const SEVERAL: [&str; 4] = ["xy", "xz", "yz", "xyz"];

impl Expander<'_> {
    /// The forces that one entry stands for.
    pub fn each_force(&mut self, force: Node) -> Vec<Node> {
        if force.get("joint").is_some() {
            let mut force = force;
            if let Some(about) = force.get_mut("about") {
                self.rotations(about);
            }
            return each(&force, "joint")
                .into_iter()
                .map(|(_, force)| force)
                .collect();
        }
        if force.get("contact").is_some() {
            return self.each_contact(force);
        }
        vec![force]
    }

    /// Laws of several rotations, one for each.
    fn rotations(&self, about: &mut Node) {
        let mut single: Vec<Entry> = Vec::new();
        for entry in about.entries() {
            let axes: Vec<String> = match SEVERAL.contains(&entry.key.as_str()) {
                true => entry.key.chars().map(String::from).collect(),
                false => vec![entry.key.clone()],
            };
            for key in axes {
                if single.iter().any(|e| e.key == key) {
                    self.problem(
                        entry.span,
                        format!("the rotation about {key} has two laws"),
                        "write each of x, y and z in one key only",
                    );
                    continue;
                }
                single.push(Entry {
                    key,
                    ..entry.clone()
                });
            }
        }
        about.kind = NodeKind::Map(single);
    }

    /// The outputs that one entry stands for, named after what they look at and the component they show.
    pub fn each_output(&mut self, output: Node) -> Vec<Node> {
        let mut all = Vec::new();
        for (of, mut one) in each(&output, "of") {
            if let (Some(of), Some(name)) = (of, output.word("name")) {
                let last = of.rsplit([' ', '/']).next().unwrap_or_default();
                one.change("name", |n| n.with_text(format!("{last} {name}")));
            }
            for (component, mut column) in each(&one, "component") {
                if let (Some(component), Some(name)) = (component, one.word("name")) {
                    column.change("name", |n| n.with_text(format!("{name} {component}")));
                    column.change("code", |n| match n.text() {
                        Some(code) => n.with_text(directed(code, &component)),
                        None => n.clone(),
                    });
                }
                all.push(column);
            }
        }
        all
    }
}

/// A channel code with the letter of a component where it has `?` for the direction.
fn directed(code: &str, component: &str) -> String {
    const DIRECTION: usize = 14;
    let letter = component
        .chars()
        .next()
        .map_or('?', |c| c.to_ascii_uppercase());
    let each = code.chars().enumerate();
    each.map(|(place, c)| match (place, c) {
        (DIRECTION, '?') => letter,
        _ => c,
    })
    .collect()
}

/// For each entry of a list under `key`, its text and the whole with that one; the whole itself where there is no list.
fn each(whole: &Node, key: &str) -> Vec<(Option<String>, Node)> {
    let list = whole
        .get(key)
        .filter(|value| matches!(value.kind, NodeKind::List(_)));
    let Some(list) = list else {
        return vec![(None, whole.clone())];
    };
    list.items()
        .iter()
        .map(|item| {
            let mut one = whole.clone();
            one.set(key, item.clone());
            (item.text().map(str::to_owned), one)
        })
        .collect()
}
