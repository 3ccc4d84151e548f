//! Compares a file with what URDF knows: nothing in it vanishes.

use super::reader::Reader;
use super::robot::{LeftOut, TextPlace, Why};
use super::vocabulary::{Element, Fate};
use crate::diagnostic::quoted;
use roxmltree::Node;
use std::collections::BTreeMap;

impl Reader<'_> {
    /// Lists or refuses everything in an element that is not read.
    pub fn inspect(&self, node: Node<'_, '_>, known: &Element) {
        for attribute in node.attributes() {
            let name = self.xml.name(&attribute);
            let place = self.xml.place_of_name(&attribute);
            let found = known.attributes.iter().find(|(of, _)| *of == name);
            match found.map(|(_, fate)| *fate) {
                Some(fate) => self.follow(node, place, fate),
                None => {
                    // a name that is there, too, was not meant
                    let candidates = known.attributes.iter().map(|(of, _)| *of);
                    let candidates = candidates.filter(|of| node.attribute(*of).is_none());
                    let what = format!("attribute `{name}` of <{}>", known.tag);
                    self.unknown(node, place, (name, what), candidates);
                }
            }
        }
        let mut first: BTreeMap<&str, usize> = BTreeMap::new();
        for child in node.children() {
            if !child.is_element() {
                self.stray(child);
                continue;
            }
            let tag = self.xml.tag(child);
            let place = self.xml.place(child);
            let Some(found) = known.children.iter().find(|k| k.tag == tag) else {
                let there = |k: &&Element| k.once && self.xml.child(node, k.tag).is_some();
                let candidates = known.children.iter().filter(|k| !there(k)).map(|k| k.tag);
                let what = format!("<{tag}> in <{}>", known.tag);
                self.unknown(child, place, (tag, what), candidates);
                continue;
            };
            match first.get(found.tag) {
                Some(first) if found.once => self.problem(
                    place,
                    format!(
                        "there are two <{tag}> in {}; the first is in line {first}",
                        self.named(node)
                    ),
                    "only one is allowed: remove the other",
                ),
                _ => drop(first.entry(found.tag).or_insert(place.0)),
            }
            match found.fate {
                Fate::Read => self.inspect(child, found),
                fate => self.follow(child, place, fate),
            }
            if let Fate::Idle(_) = found.fate {
                self.inside(child, found);
            }
        }
    }

    /// What matters in an element that is listed as a whole.
    fn inside(&self, node: Node<'_, '_>, known: &Element) {
        for child in node.children().filter(Node::is_element) {
            let tag = self.xml.tag(child);
            if let Some(found) = known.children.iter().find(|k| k.tag == tag) {
                self.follow(child, self.xml.place(child), found.fate);
            }
        }
    }

    /// Does with a part what is declared.
    fn follow(&self, node: Node<'_, '_>, place: TextPlace, fate: Fate) {
        match fate {
            Fate::Read | Fate::Partly => {}
            Fate::Idle(what) => self.leave_out(node, place, Why::Idle, what),
            Fate::Missing(what) => self.leave_out(node, place, Why::Missing, what),
            Fate::Refused(what, help) => {
                self.problem(place, format!("{} {what}", self.named(node)), help);
            }
        }
    }

    /// Lists a part that is not taken over.
    pub fn leave_out(&self, node: Node<'_, '_>, place: TextPlace, why: Why, what: &str) {
        self.left_out.borrow_mut().push(LeftOut {
            why,
            what: what.to_owned(),
            line: place.0,
            name: node.attribute("name").map(str::to_owned),
        });
    }

    /// Something that URDF does not know: an extension, a misspelt name, or a name of its own.
    fn unknown<'k>(
        &self,
        node: Node<'_, '_>,
        place: TextPlace,
        (name, what): (&str, String),
        candidates: impl Iterator<Item = &'k str>,
    ) {
        if name.starts_with("xacro:") {
            return; // said once for the file
        }
        match misspelt(name, candidates) {
            Some(near) => self.problem(
                place,
                format!("URDF has no {what}"),
                format!("did you mean `{near}`?"),
            ),
            None => self.leave_out(node, place, Why::Unknown, &what),
        }
    }

    /// Text between elements, where URDF has none.
    fn stray(&self, node: Node<'_, '_>) {
        let text = node.text().unwrap_or_default();
        if node.is_text() && !text.trim().is_empty() {
            let place = self.xml.place_of_text(node);
            self.leave_out(node, place, Why::Unknown, "text between elements");
        }
    }

    /// An element with its name: `the <loop_joint> "l"`.
    fn named(&self, node: Node<'_, '_>) -> String {
        let tag = self.xml.tag(node);
        let owner = match node.attribute("name") {
            Some(_) => Some(node),
            None => node.parent().filter(|p| p.attribute("name").is_some()),
        };
        match owner.and_then(|n| Some((n, n.attribute("name")?))) {
            Some((owner, name)) if owner == node => format!("the <{tag}> {}", quoted(name)),
            Some((owner, name)) => {
                format!(
                    "the <{tag}> of the {} {}",
                    self.xml.tag(owner),
                    quoted(name)
                )
            }
            None => format!("<{tag}>"),
        }
    }
}

/// The known name that a name was meant to be: one letter of a short name is wrong, or two of a long one.
pub fn misspelt<'k>(name: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    let allowed = if name.chars().count() < 6 { 1 } else { 2 };
    let distance = |of: &str| strsim::damerau_levenshtein(&name.to_lowercase(), &of.to_lowercase());
    let near = known.filter(|of| of.len() > 2 && !of.contains(':') && !name.contains(':'));
    let found = near.map(|of| (distance(of), of)).min_by_key(|(d, _)| *d)?;
    (found.0 <= allowed && name.len() < 60).then_some(found.1)
}
