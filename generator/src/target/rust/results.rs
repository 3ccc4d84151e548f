//! Writes the results of a method as Rust: the return type and the last expression.

use super::expression::{Printer, ident};
use crate::expression::Node;
use crate::method::inputs::Inputs;
use crate::method::results::{Length, Results};
use crate::program::schedule::Schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::Expr;

/// Matrices with at most this many rows are written as a table.
const READABLE_ROWS: usize = 6;

/// The type that a method returns.
pub(crate) fn returned(results: Results) -> TokenStream {
    match results {
        Results::Scalar => quote!(T),
        Results::Written { .. } => quote!(()),
        Results::Array(length) => {
            let length = written_length(length);
            quote!([T; #length])
        }
        Results::Start => quote!(([T; COORDINATES], [T; VELOCITIES])),
        Results::Renewed => {
            quote!(([T; COORDINATES], [T; VELOCITIES], [T; MEMORY]))
        }
        Results::Table(rows, columns) => {
            let (rows, columns) = (
                Literal::usize_unsuffixed(rows),
                Literal::usize_unsuffixed(columns),
            );
            match (results, columns.to_string() == "1") {
                (Results::Table(1, 1), _) => quote!(T),
                (_, true) => quote!([T; #rows]),
                (_, false) => quote!([[T; #columns]; #rows]),
            }
        }
        Results::Vector => quote!(SVector<T, VELOCITIES>),
        Results::Matrix => quote!(SMatrix<T, VELOCITIES, VELOCITIES>),
        Results::Mechanism => quote!(Self),
    }
}

/// A length as a constant of the module, or as a number if there is no such constant.
pub(crate) fn written_length(length: Length) -> TokenStream {
    let name = match length {
        Length::Coordinates => "COORDINATES",
        Length::Velocities => "VELOCITIES",
        Length::Auxiliaries => "AUXILIARIES",
        Length::Memory => "MEMORY",
        Length::Outputs => "OUTPUTS",
        Length::EventFunctions => "EVENT_FUNCTIONS",
        Length::Number(number) => {
            let number = Literal::usize_unsuffixed(number);
            return quote!(#number);
        }
    };
    let name = ident(name);
    quote!(#name)
}

/// The last expression of a method. The last of several pieces has the parameters by reference.
pub(crate) fn written(
    results: Results,
    schedule: &Schedule,
    inputs: &Inputs,
    printer: &Printer<'_>,
    pieces: bool,
) -> TokenStream {
    let values = schedule.returned().iter();
    let values: Vec<Expr> = values.map(|&id| printer.value(id)).collect();
    let (coordinates, velocities) = (inputs.coordinates.len(), inputs.velocities.len());
    match results {
        Results::Scalar => quote!(#(#values)*),
        Results::Written { .. } => TokenStream::new(),
        Results::Table(1, 1) => quote!(#(#values)*),
        Results::Array(_) | Results::Table(_, 1) => quote!([#(#values),*]),
        Results::Table(_, columns) => {
            let rows = values.chunks(columns).map(|row| quote!([#(#row),*]));
            quote!([#(#rows),*])
        }
        Results::Start => {
            let (q, v) = values.split_at(coordinates);
            quote!(([#(#q),*], [#(#v),*]))
        }
        Results::Renewed => {
            let (q, rest) = values.split_at(coordinates);
            let (v, m) = rest.split_at(velocities);
            quote!(([#(#q),*], [#(#v),*], [#(#m),*]))
        }
        Results::Vector => quote!(SVector::from([#(#values),*])),
        Results::Matrix if velocities <= READABLE_ROWS => {
            let rows = (0..velocities).map(|row| {
                let entries =
                    (0..velocities).map(|column| &values[upper_triangle(velocities, row, column)]);
                quote!([#(#entries),*])
            });
            quote!(SMatrix::from([#(#rows),*]))
        }
        Results::Matrix => sparse_matrix(schedule, velocities, &values, printer),
        Results::Mechanism => {
            let fields = inputs.derived.iter().zip(&values).map(|(field, value)| {
                let field = ident(field);
                // If the value has the name of the field, the name is written only once.
                if matches!(value, Expr::Path(path) if path.path.is_ident(&field)) {
                    quote!(#field)
                } else {
                    quote!(#field: #value)
                }
            });
            let copied = if pieces {
                quote!(parameters: *parameters)
            } else {
                quote!(parameters)
            };
            quote!(Self { #copied, #(#fields),* })
        }
    }
}

/// A large matrix, entry by entry; entries that are 0 are not written.
fn sparse_matrix(
    schedule: &Schedule,
    rows: usize,
    values: &[Expr],
    printer: &Printer<'_>,
) -> TokenStream {
    let entries = (0..rows).flat_map(|row| (row..rows).map(move |column| (row, column)));
    let entries = entries
        .zip(&schedule.roots)
        .zip(values)
        .filter(|&((_, &root), _)| schedule.graph.node(root) != Node::Constant(0.0_f64.to_bits()));
    let entries = entries.map(|(((row, column), _), value)| {
        let (row, column) = (
            Literal::usize_unsuffixed(row),
            Literal::usize_unsuffixed(column),
        );
        if row.to_string() == column.to_string() {
            quote!(s[(#row, #column)] = #value;)
        } else {
            quote!(s[(#row, #column)] = #value; s[(#column, #row)] = #value;)
        }
    });
    let zero = printer.number(0.0);
    quote! {
        let mut s = SMatrix::from_element(#zero);
        #(#entries)*
        s
    }
}

/// The index of an entry of a symmetric matrix in its upper triangle, stored by rows.
pub fn upper_triangle(rows: usize, row: usize, column: usize) -> usize {
    let (row, column) = (row.min(column), row.max(column));
    row * rows - row * (row + 1) / 2 + column
}
