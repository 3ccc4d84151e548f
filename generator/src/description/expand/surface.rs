//! Named surfaces and groups of them: declared once, put into the contacts that name them.

use super::{Expander, Node};
use crate::description::tree::{Entry, MAX_ENTRIES, NodeKind, Span};
use crate::diagnostic::{quoted, suggestion};
use std::collections::{HashMap, HashSet};

/// The surfaces of all files read so far.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    named: HashMap<String, Named>,
    groups: HashMap<String, Group>,
    /// The names of both in the order of the text.
    order: Vec<String>,
}

#[derive(Clone, Debug)]
struct Named {
    /// As it would stand in a contact.
    node: Node,
    /// Name of the file with it.
    file: String,
}

#[derive(Clone, Debug)]
struct Group {
    /// Names of its surfaces.
    members: Vec<String>,
    /// Name of the file with it.
    file: String,
}

impl Surfaces {
    fn add_surface(&mut self, name: &str, node: &Node, file: &str) {
        let named = Named {
            node: node.clone(),
            file: file.to_owned(),
        };
        self.named.insert(name.to_owned(), named);
        self.order.push(name.to_owned());
    }

    fn add_group(&mut self, name: &str, members: Vec<String>, file: &str) {
        let group = Group {
            members,
            file: file.to_owned(),
        };
        self.groups.insert(name.to_owned(), group);
        self.order.push(name.to_owned());
    }

    /// Adds surfaces and groups.
    pub fn add(
        &mut self,
        surfaces: &[Entry],
        groups: impl Iterator<Item = (String, Vec<String>)>,
        file: &str,
    ) {
        for entry in surfaces {
            self.add_surface(&entry.key, &entry.value, file);
        }
        for (name, members) in groups {
            self.add_group(&name, members, file);
        }
    }

    /// The groups that a file declared, in the order of the text.
    pub fn groups_of<'s>(&'s self, file: &'s str) -> impl Iterator<Item = (&'s str, &'s [String])> {
        self.order.iter().filter_map(move |name| {
            let group = self.groups.get(name).filter(|group| group.file == file)?;
            Some((name.as_str(), group.members.as_slice()))
        })
    }

    /// Forgets what a file declared.
    pub fn forget(&mut self, file: &str) {
        self.named.retain(|_, surface| surface.file != file);
        self.groups.retain(|_, group| group.file != file);
        let known = |name: &String| self.named.contains_key(name) || self.groups.contains_key(name);
        self.order.retain(known);
    }
}

/// The sides of a contact, and whether an ellipsoid stands there.
const SIDES: [(&str, bool); 3] = [("ellipsoid", true), ("plane", false), ("with", true)];

/// A side of a contact: the surfaces, each with its name where one was written; whether several could stand there.
struct Side {
    key: &'static str,
    surfaces: Vec<(Option<String>, Node)>,
    several: bool,
}

impl Expander<'_> {
    /// Declares the surfaces and groups of a file, mirror images too, and leaves the surfaces in their long form.
    pub fn surfaces(&mut self, root: &mut Node) {
        if let Some(surfaces) = root.get_mut("surfaces") {
            self.mirror_surfaces(surfaces);
            for entry in surfaces.entries() {
                if !self.is_new_name(&entry.key, entry.span) {
                    continue;
                }
                let surfaces = &mut self.known.surfaces;
                surfaces.add_surface(&entry.key, &entry.value, &self.source.name);
            }
        }
        let groups = root.remove("groups");
        for entry in groups.iter().flat_map(Node::entries) {
            let members = self.members(entry.value.items());
            if self.is_new_name(&entry.key, entry.span) {
                let surfaces = &mut self.known.surfaces;
                surfaces.add_group(&entry.key, members, &self.source.name);
            }
        }
    }

    fn is_new_name(&self, name: &str, span: Span) -> bool {
        let known = &self.known.surfaces;
        let is_new = !known.named.contains_key(name) && !known.groups.contains_key(name);
        if !is_new {
            self.problem(
                span,
                format!("there are two surfaces or groups called {}", quoted(name)),
                "give one of them another name",
            );
        }
        is_new
    }

    /// The surfaces that a list names, those of groups in place of these.
    fn members(&self, list: &[Node]) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for item in list {
            let name = item.text().unwrap_or_default();
            let surfaces = &self.known.surfaces;
            let found = match surfaces.groups.get(name) {
                Some(group) => group.members.clone(),
                None if surfaces.named.contains_key(name) => vec![name.to_owned()],
                None => {
                    self.no_surface(name, item.span);
                    continue;
                }
            };
            for name in found {
                if names.contains(&name) {
                    self.problem(
                        item.span,
                        format!("the surface {} is named twice", quoted(&name)),
                        "name each once, by itself or in a group",
                    );
                } else {
                    names.push(name);
                }
            }
        }
        names
    }

    fn no_surface(&self, name: &str, span: Span) {
        let names = self.known.surfaces.order.iter().map(String::as_str);
        self.problem(
            span,
            format!("there is no surface {}", quoted(name)),
            suggestion(
                name,
                names,
                "declare it under `surfaces`, or write it here: `{ on: …, … }`",
            ),
        );
    }

    /// The sides of a contact that are written, each with the surfaces that it stands for.
    fn sides(&mut self, contact: &Node) -> Vec<Side> {
        let mut sides: Vec<Side> = Vec::new();
        for (key, _) in SIDES {
            let Some(value) = contact.get(key) else {
                continue;
            };
            let name = value.text().unwrap_or_default();
            let list = match &value.kind {
                NodeKind::List(items) => Some(self.members(items)),
                NodeKind::Scalar { .. } => {
                    let group = self.known.surfaces.groups.get(name);
                    group.map(|group| group.members.clone())
                }
                NodeKind::Map(_) => None,
            };
            let surfaces = match &list {
                None => vec![(None, value.clone())],
                Some(names) => names
                    .iter()
                    .map(|name| (Some(name.clone()), value.with_text(name)))
                    .collect(),
            };
            sides.push(Side {
                key,
                surfaces,
                several: list.is_some(),
            });
        }
        sides
    }

    /// The contacts that one entry stands for: one for each pair of surfaces on two bodies.
    pub fn each_contact(&mut self, contact: Node) -> Vec<Node> {
        let sides = self.sides(&contact);
        // what is wrong with the sides of a contact is reported where it is resolved
        let [first, second] = &sides[..] else {
            return match sides.iter().any(|side| side.several) {
                false => vec![contact],
                true => {
                    self.problem(
                        contact.span,
                        "a contact has two sides",
                        "write `ellipsoid: …` and one of `plane: …` and `with: …`",
                    );
                    Vec::new()
                }
            };
        };
        if !first.several && !second.several {
            return vec![contact];
        }
        if first.surfaces.len() * second.surfaces.len() > MAX_ENTRIES {
            self.problem(
                contact.span,
                format!("these are more than {MAX_ENTRIES} contacts"),
                "shorten the lists of surfaces",
            );
            return Vec::new();
        }
        let both = first.several && second.several;
        let mut made: HashSet<(&Option<String>, &Option<String>)> = HashSet::new();
        let mut all = Vec::new();
        for (a, of_a) in &first.surfaces {
            for (b, of_b) in &second.surfaces {
                let on_one_body = self
                    .body_of(of_a)
                    .is_some_and(|on| Some(on) == self.body_of(of_b));
                if both && (on_one_body || made.contains(&(b, a))) {
                    continue;
                }
                made.insert((a, b));
                let mut one = contact.clone();
                one.set(first.key, of_a.clone());
                one.set(second.key, of_b.clone());
                let name = [contact.word("contact").unwrap_or_default()]
                    .into_iter()
                    .chain([a, b].into_iter().flatten().map(String::as_str))
                    .collect::<Vec<_>>()
                    .join("-");
                one.change("contact", |n| n.with_text(name));
                all.push(one);
            }
        }
        if all.is_empty() && !first.surfaces.is_empty() && !second.surfaces.is_empty() {
            self.problem(
                contact.span,
                "all these surfaces are on one body",
                "name surfaces of two bodies",
            );
        }
        all
    }

    /// The body of a surface, named or in place.
    fn body_of<'n>(&'n self, surface: &'n Node) -> Option<&'n str> {
        match surface.text() {
            Some(name) => self.known.surfaces.named.get(name)?.node.word("on"),
            None => surface.word("on"),
        }
    }

    /// Puts the surfaces that a contact names into it.
    pub fn place_surfaces(&mut self, force: &mut Node) {
        if force.get("airbag").is_some() {
            return self.place_in_airbag(force);
        }
        if force.get("contact").is_none() {
            return;
        }
        for (key, ellipsoid) in SIDES {
            let Some(value) = force.get(key) else {
                continue;
            };
            if value.get("mirror").is_some() {
                self.problem(
                    value.span,
                    "a surface that stands in a contact has no mirror image of its own",
                    "write `mirror: true` in the contact, or give the surface a name under `surfaces`",
                );
            }
            let Some(name) = value.text() else {
                continue;
            };
            let Some(named) = self.known.surfaces.named.get(name) else {
                self.no_surface(name, value.span);
                continue;
            };
            let is_ellipsoid = named.node.get("normal").is_none();
            if is_ellipsoid != ellipsoid {
                let (what, keys) = match is_ellipsoid {
                    true => ("an ellipsoid", "`ellipsoid` or `with`"),
                    false => ("a plane", "`plane`"),
                };
                self.problem(
                    value.span,
                    format!("{} is {what}", quoted(name)),
                    format!("it stands behind {keys}"),
                );
                continue;
            }
            let mut node = named.node.clone();
            if named.file != self.source.name {
                // its places are in another text
                node.move_to(value.span);
            }
            force.set(key, node);
        }
    }
}

impl Expander<'_> {
    /// Puts the ellipsoids that an airbag names into it, those of groups too.
    fn place_in_airbag(&mut self, force: &mut Node) {
        if let Some(value) = force.get("ellipsoid")
            && let Some(name) = value.text()
        {
            match self.ellipsoid_called(name, value.span) {
                Some(node) => force.set("ellipsoid", node),
                None => return,
            }
        }
        if let Some(list) = force.get("ellipsoid")
            && let NodeKind::List(_) = list.kind
        {
            self.problem(
                list.span,
                "a bag is one ellipsoid",
                "name one; what it meets stands behind `against`",
            );
        }
        let Some(NodeKind::List(items)) = force.get("against").map(|list| &list.kind) else {
            return;
        };
        let mut all = Vec::new();
        for item in items {
            match item.text() {
                None => all.push(item.clone()),
                Some(_) => {
                    let names = self.members(std::slice::from_ref(item));
                    let nodes = names.iter();
                    all.extend(nodes.filter_map(|name| self.ellipsoid_called(name, item.span)));
                }
            }
        }
        force.change("against", |list| Node {
            span: list.span,
            kind: NodeKind::List(all),
        });
    }

    /// The ellipsoid of a name, as it would stand at a place.
    fn ellipsoid_called(&self, name: &str, span: Span) -> Option<Node> {
        let Some(named) = self.known.surfaces.named.get(name) else {
            self.no_surface(name, span);
            return None;
        };
        if named.node.get("normal").is_some() {
            self.problem(
                span,
                format!("{} is a plane", quoted(name)),
                "an airbag meets ellipsoids",
            );
            return None;
        }
        let mut node = named.node.clone();
        if named.file != self.source.name {
            // its places are in another text
            node.move_to(span);
        }
        Some(node)
    }
}

impl Node {
    /// The same at another place.
    pub fn move_to(&mut self, span: Span) {
        self.span = span;
        match &mut self.kind {
            NodeKind::Scalar { .. } => {}
            NodeKind::List(items) => items.iter_mut().for_each(|item| item.move_to(span)),
            NodeKind::Map(entries) => {
                for entry in entries {
                    entry.span = span;
                    entry.value.move_to(span);
                }
            }
        }
    }
}
