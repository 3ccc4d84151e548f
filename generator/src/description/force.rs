//! Forces as written. The key that names a force says which [law](crate::law) it is.

use super::expand::{Expander, Node};
use super::measure::Length;
use super::place::At;
use super::quantity::Number;
use super::schema::{Schema, any_of};
use super::shape::{Key, Misfit, Problems, Shape, record};
use super::tree::NodeKind;
use crate::diagnostic::{nearest, quoted};
use serde_yaml::Value;

/// A law as the language knows it.
#[derive(Debug)]
pub struct LawKeys {
    /// The key that names a force of this law.
    pub key: &'static str,
    /// Name of the law with its article.
    pub title: &'static str,
    /// Reports values that do not have the shape of this law.
    pub shape: fn(At<'_>, &Problems),
    /// The JSON Schema of this law.
    pub schema: fn(&mut Schema) -> Value,
    /// The records of the law's keys, in the order of the reference page.
    pub records: fn() -> Vec<(&'static str, Vec<Key>)>,
    /// Turns a copy of a force into its mirror image, with its name. `None`, with a report, if the force has no mirror
    /// image.
    pub image: fn(&mut Expander<'_>, &Node, &mut Node) -> Option<()>,
    /// Advice for two forces with the same name, in place of renaming one of them.
    pub same_name_advice: Option<&'static str>,
    /// True if the law has outputs.
    pub is_observable: bool,
    /// True if outputs name a part of the law after its name: `of: user drag/head`.
    pub has_ports: bool,
    /// The key of a Rust file that belongs to a force.
    pub source: Option<&'static str>,
}

impl LawKeys {
    /// Name of the law without its article: "joint force", "spring".
    pub fn called(&self) -> &'static str {
        self.title
            .split_once(' ')
            .map_or(self.title, |(_, called)| called)
    }
}

/// A force as written. It has the shape of its law, which reads the value when the force is resolved.
#[derive(Clone, Debug)]
pub struct Force(pub Value);

record! {
    /// When a force acts.
    Acting as "when a force acts" {
        /// `false` leaves the force out
        enabled: Option<bool> = "`true`",
        /// the force acts from this [switch](#a-switch) on
        since: Option<String> = "the start",
        /// the force acts up to this switch
        until: Option<String> = "the end",
    }
}

record! {
    /// A point on a body.
    Attachment as "an attachment" {
        /// `frame`, a vehicle, or an element as `system/element`
        on: String,
        /// the point, local frame
        at: Vec<Number<Length>>,
    }
}

impl Shape for Force {
    fn schema(to: &mut Schema) -> Value {
        let laws = to.language.laws.iter();
        let laws: Vec<Value> = laws.map(|law| (law.schema)(to)).collect();
        any_of(laws)
    }

    fn check(at: At<'_>, problems: &Problems) {
        let laws = problems.language.laws;
        let kinds = || laws.iter().map(|law| law.key);
        let help = || {
            let keys: Vec<String> = kinds().map(|key| format!("`{key}:`")).collect();
            format!("a force begins with one of {}", keys.join(", "))
        };
        let NodeKind::Map(entries) = &at.node.kind else {
            problems.add(at.problem(
                format!("here stands {}, but a force has keys", at.node.article()),
                help(),
            ));
            return;
        };
        let written = |key: &str| entries.iter().any(|e| e.key == key);
        let mut named = laws.iter().filter(|law| written(law.key));
        match (named.next(), named.next()) {
            (Some(law), None) => (law.shape)(at, problems),
            (None, _) => {
                let near = entries
                    .iter()
                    .find_map(|e| nearest(&e.key, kinds()).map(|kind| (e, kind)));
                problems.add(match near {
                    Some((entry, kind)) => at.problem_at(
                        entry.span,
                        format!("{} is no kind of force", quoted(&entry.key)),
                        format!("did you mean `{kind}`?"),
                    ),
                    None => at.problem("the force has no kind", help()),
                });
            }
            (Some(first), Some(second)) => problems.add(at.key(second.key).key_problem(
                format!("the force has two kinds, {} and {}", first.key, second.key),
                "write two forces, each begun with `- `",
            )),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Ok(Force(value.clone()))
    }
}
