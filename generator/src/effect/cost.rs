//! What the equations of a variant cost: operations of the emitted text, after all passes.

use super::Variant;
use crate::emit;
use crate::expression::count::{Count, Table};
use crate::formalism::{self, derive_with};

/// Operations of one evaluation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Of `accelerations`.
    pub accelerations: Count,
    /// Of `outputs`; where it calls `accelerations`, without them.
    pub outputs: Count,
}

/// Operations of a variant.
pub fn cost(variant: &Variant) -> Cost {
    let equations = derive_with(&variant.model, options(variant));
    let tables = emit::costs(&variant.model, &equations, &EMITTED);
    let of = |method: &str| {
        let found = tables.iter().find(|(name, _)| *name == method);
        found.map_or_else(Count::default, |(_, table): &(_, Table)| {
            table.total.clone()
        })
    };
    Cost {
        accelerations: of("accelerations"),
        outputs: of("outputs"),
    }
}

/// The module of a variant, without matrices.
pub fn source(variant: &Variant) -> String {
    let equations = derive_with(&variant.model, options(variant));
    emit::module(&variant.model, &equations, &EMITTED)
}

const EMITTED: emit::Options = emit::Options {
    matrices: false,
    statements: 900,
};

fn options(variant: &Variant) -> formalism::Options {
    formalism::Options {
        matrices: false,
        omitted: variant.omitted,
        ..formalism::Options::default()
    }
}
