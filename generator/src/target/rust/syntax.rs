//! Builds the syntax trees of formulas directly: parsing thousands of lines of tokens would take longer than everything
//! else.

use super::expression::ident;
use proc_macro2::{Literal, Span};
use syn::punctuated::Punctuated;
use syn::{BinOp, Expr, Pat, Path, Stmt, Token};

/// A word, or words joined by `::`.
pub(crate) fn path(words: &str) -> Path {
    let segments = words
        .split("::")
        .map(|word| syn::PathSegment::from(ident(word)));
    Path {
        leading_colon: None,
        segments: segments.collect(),
    }
}

/// A name.
pub(crate) fn word(words: &str) -> Expr {
    Expr::Path(syn::ExprPath {
        attrs: Vec::new(),
        qself: None,
        path: path(words),
    })
}

/// A name, or for two names with a dot between them, the field of the first that has the second as its name.
pub(crate) fn place(name: &str) -> Expr {
    match name.split_once('.') {
        Some((base, name)) => field(word(base), name),
        None => word(name),
    }
}

/// A literal, which must not be negative.
pub(crate) fn literal(literal: Literal) -> Expr {
    Expr::Lit(syn::ExprLit {
        attrs: Vec::new(),
        lit: syn::Lit::new(literal),
    })
}

/// `base.name`
pub(crate) fn field(base: Expr, name: &str) -> Expr {
    Expr::Field(syn::ExprField {
        attrs: Vec::new(),
        base: Box::new(base),
        dot_token: Default::default(),
        member: ident(name).into(),
    })
}

/// `base.0`
pub(crate) fn tuple_field(base: Expr, index: u32) -> Expr {
    let index = syn::Index {
        index,
        span: Span::call_site(),
    };
    Expr::Field(syn::ExprField {
        attrs: Vec::new(),
        base: Box::new(base),
        dot_token: Default::default(),
        member: syn::Member::Unnamed(index),
    })
}

/// `array[index]`
pub(crate) fn element(array: &str, index: usize) -> Expr {
    Expr::Index(syn::ExprIndex {
        attrs: Vec::new(),
        expr: Box::new(word(array)),
        bracket_token: Default::default(),
        index: Box::new(literal(Literal::usize_unsuffixed(index))),
    })
}

/// `function(arguments)`
pub(crate) fn call(function: Expr, arguments: impl IntoIterator<Item = Expr>) -> Expr {
    Expr::Call(syn::ExprCall {
        attrs: Vec::new(),
        func: Box::new(function),
        paren_token: Default::default(),
        args: arguments.into_iter().collect(),
    })
}

/// `[a, b]`
pub(crate) fn array(elements: impl IntoIterator<Item = Expr>) -> Expr {
    Expr::Array(syn::ExprArray {
        attrs: Vec::new(),
        bracket_token: Default::default(),
        elems: elements.into_iter().collect(),
    })
}

/// `receiver.name(arguments)`
pub(crate) fn method(
    receiver: Expr,
    name: &str,
    arguments: impl IntoIterator<Item = Expr>,
) -> Expr {
    Expr::MethodCall(syn::ExprMethodCall {
        attrs: Vec::new(),
        receiver: Box::new(receiver),
        dot_token: Default::default(),
        method: ident(name),
        turbofish: None,
        paren_token: Default::default(),
        args: arguments.into_iter().collect(),
    })
}

/// `left op right`
pub(crate) fn binary(left: Expr, op: BinOp, right: Expr) -> Expr {
    Expr::Binary(syn::ExprBinary {
        attrs: Vec::new(),
        left: Box::new(left),
        op,
        right: Box::new(right),
    })
}

/// `-a`
pub(crate) fn negative(a: Expr) -> Expr {
    Expr::Unary(syn::ExprUnary {
        attrs: Vec::new(),
        op: syn::UnOp::Neg(Default::default()),
        expr: Box::new(a),
    })
}

/// `(a)`
pub(crate) fn brackets(a: Expr) -> Expr {
    Expr::Paren(syn::ExprParen {
        attrs: Vec::new(),
        paren_token: Default::default(),
        expr: Box::new(a),
    })
}

/// The pattern `name`, or `_` without a name.
pub(crate) fn binding(name: Option<&str>) -> Pat {
    match name {
        Some(name) => Pat::Ident(syn::PatIdent {
            attrs: Vec::new(),
            by_ref: None,
            mutability: None,
            ident: ident(name),
            subpat: None,
        }),
        None => Pat::Wild(syn::PatWild {
            attrs: Vec::new(),
            underscore_token: Default::default(),
        }),
    }
}

/// `(first, second)`
pub(crate) fn pair(first: Pat, second: Pat) -> Pat {
    let elems: Punctuated<Pat, Token![,]> = [first, second].into_iter().collect();
    Pat::Tuple(syn::PatTuple {
        attrs: Vec::new(),
        paren_token: Default::default(),
        elems,
    })
}

/// `[a, _, c]`
pub(crate) fn array_pattern(elements: impl IntoIterator<Item = Pat>) -> Pat {
    Pat::Slice(syn::PatSlice {
        attrs: Vec::new(),
        bracket_token: Default::default(),
        elems: elements.into_iter().collect(),
    })
}

/// `value;`
pub(crate) fn does(value: Expr) -> Stmt {
    Stmt::Expr(value, Some(Default::default()))
}

/// `let pattern = value;` with a marked comment above it.
pub(crate) fn binds(comment: Option<syn::Attribute>, pattern: Pat, value: Expr) -> Stmt {
    Stmt::Local(syn::Local {
        attrs: comment.into_iter().collect(),
        let_token: Default::default(),
        modifiers: Default::default(),
        pat: pattern,
        init: Some(syn::LocalInit {
            eq_token: Default::default(),
            expr: Box::new(value),
            diverge: None,
        }),
        semi_token: Default::default(),
    })
}
