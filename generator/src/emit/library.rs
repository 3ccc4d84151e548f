//! What the emitted text calls outside itself: curves, as constants of the module, and the force laws of the runtime.

use super::expression::{ident, number};
use super::names::{Names, screaming};
use crate::expression::{Function, Graph, Node, NodeId, live::Live};
use crate::model::{Extrapolate, Model};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

/// The curves of a model by the names of their constants.
pub(super) struct Library {
    names: Vec<String>,
}

impl Library {
    /// Names for the curves of a model.
    pub(super) fn new(model: &Model) -> Self {
        let taken = ["COORDINATES", "VELOCITIES", "OUTPUTS", "INFO"];
        let mut names = Names::with(&taken);
        let names = model
            .curves
            .iter()
            .map(|curve| names.take(&screaming(&curve.name)))
            .collect();
        Self { names }
    }

    /// Path of the function that is called.
    pub(super) fn path(&self, function: Function) -> TokenStream {
        match function {
            Function::Curve(i) => self.method(i, "value"),
            Function::CurveSlope(i) => self.method(i, "slope"),
            Function::CurveInverse(i) => self.method(i, "inverse"),
            Function::CurveIntegral(i) => self.method(i, "integral"),
            Function::CurveDoubleIntegral(i) => self.method(i, "double_integral"),
            Function::Coulomb => quote!(force::friction::coulomb),
            Function::CoulombScale => quote!(force::friction::coulomb_scale),
            Function::ContactNormalForce => quote!(force::contact::normal_force),
            Function::BeltTension => quote!(force::belt::tension),
        }
    }

    fn method(&self, curve: u32, method: &str) -> TokenStream {
        let (curve, method) = (ident(&self.names[curve as usize]), ident(method));
        quote!(#curve.#method)
    }

    /// The constant of one curve.
    pub(super) fn constant(&self, model: &Model, curve: usize) -> TokenStream {
        let (name, curve) = (ident(&self.names[curve]), &model.curves[curve]);
        let length = Literal::usize_unsuffixed(curve.points.len());
        let points = curve.points.iter().map(|&[x, y]| {
            let (x, y) = (number(x), number(y));
            quote!([#x, #y])
        });
        let extrapolate = match curve.extrapolate {
            Extrapolate::Linear => quote!(Linear),
            Extrapolate::Hold => quote!(Hold),
            Extrapolate::Error => quote!(Error),
        };
        // An angle such as 45 deg is what the user wrote, not a constant that wants its name: hence the permission.
        let text = format!(" Curve \"{}\".", super::header::plain(&curve.name));
        quote! {
            #[doc = #text]
            #[allow(clippy::approx_constant)]
            const #name: Curve<#length> = Curve::new([#(#points),*], Extrapolate::#extrapolate);
        }
    }
}

/// The curve that a function evaluates, if it is one of the curve.
pub(super) fn curve_of(function: Function) -> Option<usize> {
    match function {
        Function::Curve(i)
        | Function::CurveSlope(i)
        | Function::CurveInverse(i)
        | Function::CurveIntegral(i)
        | Function::CurveDoubleIntegral(i) => Some(i as usize),
        Function::Coulomb
        | Function::CoulombScale
        | Function::ContactNormalForce
        | Function::BeltTension => None,
    }
}

/// What some results call.
#[derive(Default)]
pub(super) struct Calls {
    /// Curves.
    pub curves: BTreeSet<usize>,
    /// Curves whose argument is time.
    pub curves_of_time: BTreeSet<usize>,
    /// True where a force law is called.
    pub laws: bool,
}

impl Calls {
    /// Adds what these roots need.
    pub(super) fn add(&mut self, graph: &Graph, roots: &[NodeId]) {
        for &id in Live::new(graph, roots).nodes() {
            if let Node::Call(function, arguments) = graph.node(id) {
                let Some(curve) = curve_of(function) else {
                    self.laws = true;
                    continue;
                };
                self.curves.insert(curve);
                let time = crate::expression::Symbol::Time;
                if graph.node(arguments[0]) == Node::Symbol(time) {
                    self.curves_of_time.insert(curve);
                }
            }
        }
    }
}
