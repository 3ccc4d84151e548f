//! How a method hands back what it computed.

use super::expression::{Printer, ident};
use crate::expression::Node;
use crate::program::schedule::Schedule;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::Expr;

/// Rows up to which a matrix is written as a table.
const READABLE_ROWS: usize = 6;

/// What a method returns.
#[derive(Clone, Copy)]
pub(crate) enum Results<'a> {
    /// `T`.
    Scalar,
    /// `[T; n]`, n being the constant of this name.
    Array(&'static str),
    /// Nothing: they are put into a sink one by one.
    Each(Each),
    /// `[T; n]` of this length.
    List(usize),
    /// `([T; COORDINATES], [T; VELOCITIES])`, this many in the first.
    Start(usize),
    /// `([T; COORDINATES], [T; VELOCITIES], [T; MEMORY])`, so many in the first two.
    Renewed(usize, usize),
    /// A vector of nalgebra.
    Vector,
    /// A symmetric matrix of nalgebra with this many rows; the roots are its upper triangle, by rows.
    Matrix(usize),
    /// The mechanism itself, with these fields.
    Mechanism(&'a [String]),
}

/// How results are put into a sink.
#[derive(Clone, Copy)]
pub(crate) struct Each {
    /// The method that does it.
    pub method: &'static str,
    /// How many they are, by the name of a constant, where a second method puts them into an array and returns that.
    pub length: Option<&'static str>,
}

impl Results<'_> {
    /// The type.
    pub(crate) fn returned(&self) -> TokenStream {
        match *self {
            Results::Scalar => quote!(T),
            Results::Each(..) => quote!(()),
            Results::Array(length) => {
                let length = ident(length);
                quote!([T; #length])
            }
            Results::List(length) => {
                let length = Literal::usize_unsuffixed(length);
                quote!([T; #length])
            }
            Results::Start(_) => quote!(([T; COORDINATES], [T; VELOCITIES])),
            Results::Renewed(..) => {
                quote!(([T; COORDINATES], [T; VELOCITIES], [T; MEMORY]))
            }
            Results::Vector => quote!(SVector<T, VELOCITIES>),
            Results::Matrix(_) => quote!(SMatrix<T, VELOCITIES, VELOCITIES>),
            Results::Mechanism(_) => quote!(Self),
        }
    }

    /// Whether they are handed over by statements.
    pub(crate) fn one_by_one(&self) -> bool {
        matches!(self, Results::Each(..))
    }

    /// The last expression of a method. In pieces, the last one has the parameters by reference.
    pub(crate) fn written(
        &self,
        schedule: &Schedule,
        printer: &Printer<'_>,
        pieces: bool,
    ) -> TokenStream {
        let values: Vec<Expr> = schedule
            .returned()
            .iter()
            .map(|&id| printer.value(id))
            .collect();
        match *self {
            Results::Scalar => quote!(#(#values)*),
            Results::Each(..) => TokenStream::new(),
            Results::Array(_) | Results::List(_) => quote!([#(#values),*]),
            Results::Start(coordinates) => {
                let (q, v) = values.split_at(coordinates);
                quote!(([#(#q),*], [#(#v),*]))
            }
            Results::Renewed(coordinates, velocities) => {
                let (q, rest) = values.split_at(coordinates);
                let (v, m) = rest.split_at(velocities);
                quote!(([#(#q),*], [#(#v),*], [#(#m),*]))
            }
            Results::Vector => quote!(SVector::from([#(#values),*])),
            Results::Matrix(rows) if rows <= READABLE_ROWS => {
                let rows = (0..rows).map(|row| {
                    let entries =
                        (0..rows).map(|column| &values[upper_triangle(rows, row, column)]);
                    quote!([#(#entries),*])
                });
                quote!(SMatrix::from([#(#rows),*]))
            }
            Results::Matrix(rows) => sparse_matrix(schedule, rows, &values, printer),
            Results::Mechanism(fields) => {
                let fields = fields.iter().zip(&values).map(|(field, value)| {
                    let field = ident(field);
                    // A field of its own name is written once.
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
}

/// A large matrix entry by entry, without its zeros.
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

/// Place of an entry of a symmetric matrix in its upper triangle by rows.
fn upper_triangle(rows: usize, row: usize, column: usize) -> usize {
    let (row, column) = (row.min(column), row.max(column));
    row * rows - row * (row + 1) / 2 + column
}

#[cfg(test)]
mod tests {
    use super::upper_triangle;

    #[test]
    fn the_upper_triangle_is_counted_by_rows() {
        let mut next = 0;
        for row in 0..5 {
            for column in row..5 {
                assert_eq!(upper_triangle(5, row, column), next);
                assert_eq!(upper_triangle(5, column, row), next);
                next += 1;
            }
        }
    }
}
