//! Springs: two ends, a curve of the elongation, a length without force.

use crate::description::force::Spring as Written;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::Resolver;
use crate::model::resolve::quantity::{FORCE, LENGTH, LINEAR_DAMPING, STIFFNESS};
use crate::model::{ForceKind, Spring};

impl Resolver<'_> {
    /// Resolves a spring.
    pub fn spring(&mut self, written: &Written, at: At<'_>) -> Option<ForceKind> {
        let name = &written.spring;
        let from = self.end(&written.from, at.key("from"));
        let to = self.end(&written.to, at.key("to"));
        if let (Some(a), Some(b)) = (&from, &to)
            && a.on == b.on
        {
            self.problems.add(at.key("to").problem(
                format!("both ends of spring {} are on the same body", quoted(name)),
                "a spring runs between two bodies; `frame` is the absolute frame",
            ));
        }
        let elastic = self.elastic(
            ("elastic", written.elastic.as_ref()),
            written.stiffness.as_ref(),
            at,
            &format!("spring {name} elastic"),
            [LENGTH, FORCE, STIFFNESS],
        );
        if written.length.is_some() && written.elastic.is_none() && written.stiffness.is_none() {
            self.problems.add(at.key("length").key_problem(
                "a length means nothing without an elastic force",
                "add `stiffness: …` or `elastic: …`, or remove `length`",
            ));
        }
        let length = written
            .length
            .as_ref()
            .map(|length| self.number(length, at.key("length"), LENGTH));
        let damping = self.coefficient(written.damping.as_ref(), at.key("damping"), LINEAR_DAMPING);
        Some(ForceKind::Spring(Box::new(Spring {
            from: from?,
            to: to?,
            length: length.filter(|_| elastic.is_some()),
            elastic,
            damping,
        })))
    }
}
