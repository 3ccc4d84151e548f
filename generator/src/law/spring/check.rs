//! Springs: two ends, a curve of the elongation, and a length at which there is no force.

use super::keys::Spring as Written;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::Resolver;
use crate::model::{Attachment, Number, ScaledCurve};
use serde::Serialize;

/// A spring and a damper side by side between two attachments, which pull and push.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spring {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
    /// Force as a function of the elongation \[m\] → \[N\], positive where it pulls.
    pub elastic: Option<ScaledCurve>,
    /// Length at which the elongation is 0 \[m\]; `None` for the distance of the attachments at the start.
    pub length: Option<Number>,
    /// Viscous coefficient on the rate of the length \[N s/m\].
    pub damping: Option<Number>,
}

/// The checked form of a spring.
pub(crate) fn spring(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Spring> {
    let name = &written.spring;
    let from = resolver.end(&written.from, at.key("from"));
    let to = resolver.end(&written.to, at.key("to"));
    if let (Some(a), Some(b)) = (&from, &to)
        && a.on == b.on
    {
        resolver.problems.add(at.key("to").problem(
            format!("both ends of spring {} are on the same body", quoted(name)),
            "a spring runs between two bodies; `frame` is the absolute frame",
        ));
    }
    let elastic = resolver.elastic(
        ("elastic", written.elastic.as_ref()),
        written.stiffness.as_ref(),
        at,
    );
    if written.length.is_some() && written.elastic.is_none() && written.stiffness.is_none() {
        resolver.problems.add(at.key("length").key_problem(
            "a length means nothing without an elastic force",
            "add `stiffness: …` or `elastic: …`, or remove `length`",
        ));
    }
    let length = written
        .length
        .as_ref()
        .map(|length| resolver.number(length, at.key("length")));
    let damping = resolver.coefficient(written.damping.as_ref(), at.key("damping"));
    Some(Spring {
        from: from?,
        to: to?,
        length: length.filter(|_| elastic.is_some()),
        elastic,
        damping,
    })
}
