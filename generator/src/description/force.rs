//! Forces as written. The key that names a force says which [law](crate::law) it is.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Misfit, Problems, Shape, record};
use super::tree::Kind;
use crate::diagnostic::{nearest, quoted};
use crate::law::LAWS;
use serde_yaml::Value;

pub use crate::law::Written as Force;

record! {
    /// A point on a body.
    Attachment as "an attachment" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// The point, local frame \[m\].
        at: Vec<Quantity>,
    }
}

/// The keys that say which force it is.
pub fn kinds() -> impl Iterator<Item = &'static str> + Clone {
    LAWS.iter().map(|law| law.key)
}

impl Shape for Force {
    fn check(at: At<'_>, problems: &Problems) {
        let help = || {
            let keys: Vec<String> = kinds().map(|key| format!("`{key}:`")).collect();
            format!("a force begins with one of {}", keys.join(", "))
        };
        let Kind::Map(entries) = &at.node.kind else {
            problems.add(at.problem(
                format!("here stands {}, but a force has keys", at.node.article()),
                help(),
            ));
            return;
        };
        let written = |key: &str| entries.iter().any(|e| e.key == key);
        let mut laws = LAWS.iter().filter(|law| written(law.key));
        match (laws.next(), laws.next()) {
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
        let law = LAWS.iter().find(|law| value.get(law.key).is_some());
        let law = law.ok_or("the force has no kind")?;
        (law.read)(value)
    }
}
