//! Everything that the generated text calls: curves, as constants of the module, and the force laws of the runtime.

use super::expression::{Callee, ident, number};
use super::user::Users;
use crate::expression::{Function, Graph, Node, NodeId, liveness::Live};
use crate::law::ForceKind;
use crate::model::{Extrapolate, Interpolate, Model};
use crate::names::{Names, screaming};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

/// The names of the constants of a model's curves, and the modules of the user's functions.
pub(crate) struct Library {
    names: Vec<String>,
    users: Users,
}

impl Library {
    /// Names for the curves of a model.
    pub(crate) fn new(model: &Model) -> Self {
        let taken = [
            "COORDINATES",
            "VELOCITIES",
            "AUXILIARIES",
            "MEMORY",
            "STATE",
            "OUTPUTS",
            "EVENT_FUNCTIONS",
            "INFO",
        ];
        let mut names = Names::with(&taken);
        let names = model
            .curves
            .iter()
            .map(|curve| names.take(&screaming(&curve.name)))
            .collect();
        Self {
            names,
            users: Users::new(model),
        }
    }

    /// The text of the modules of the user's functions.
    pub(crate) fn users(&self, model: &Model) -> String {
        self.users.text(model, &self.names)
    }

    /// The modules of the user's functions.
    pub(crate) fn user_modules(&self) -> &Users {
        &self.users
    }

    /// The name of the constant of a curve.
    pub(crate) fn name(&self, curve: usize) -> &str {
        &self.names[curve]
    }

    /// The Rust function or method that a call in the graph refers to.
    pub(crate) fn callee(&self, function: Function) -> Callee<'_> {
        let method = |curve: u32, name| Callee::Method {
            of: &self.names[curve as usize],
            name,
        };
        match function {
            Function::Curve(i) => method(i, "value"),
            Function::CurveSlope(i) => method(i, "slope"),
            Function::CurveSecondDerivative(i) => method(i, "second_derivative"),
            Function::CurveInverse(i) => method(i, "inverse"),
            Function::CurveIntegral(i) => method(i, "integral"),
            Function::CurveDoubleIntegral(i) => method(i, "double_integral"),
            Function::CurveBreakpoints(i) => method(i, "breakpoint_indicator"),
            Function::CurveStop(i) => method(i, "stop"),
            Function::Choose => Callee::Function("force::switch::choose"),
            Function::Power => Callee::Function("force::power::power"),
            Function::User(call) => Callee::Adapter(self.users.path(call.force)),
            Function::Approach(call) => Callee::Function(call.path()),
            Function::Support(_) => Callee::Function("force::ellipsoid::support"),
        }
    }

    /// The definition of the constant of a curve.
    pub(crate) fn constant(&self, model: &Model, curve: usize) -> TokenStream {
        let (name, curve) = (ident(&self.names[curve]), &model.curves[curve]);
        let length = Literal::usize_unsuffixed(curve.points.len());
        let cubic = curve.interpolate == Interpolate::Cubic;
        let kind = ident(if cubic { "Cubic" } else { "Curve" });
        let tangents: Vec<f64> = match cubic {
            true => (0..curve.points.len()).map(|k| curve.tangent(k)).collect(),
            false => Vec::new(),
        };
        let points = curve.points.iter().enumerate().map(|(k, &[x, y])| {
            let (x, y) = (number(x), number(y));
            let tangent = tangents.get(k).map(|&m| number(m)).into_iter();
            quote!([#x, #y #(, #tangent)*])
        });
        let extrapolate = extrapolate(curve.extrapolate);
        let allowed = allow(curve.points.iter().flatten().chain(&tangents));
        let text = format!(" Curve \"{}\".", crate::names::plain(&curve.name));
        quote! {
            #[doc = #text]
            #allowed
            const #name: #kind<#length> = #kind::new([#(#points),*], #extrapolate);
        }
    }
}

/// The way a curve is extrapolated beyond its points.
pub(crate) fn extrapolate(extrapolate: Extrapolate) -> TokenStream {
    match extrapolate {
        Extrapolate::Linear => quote!(Extrapolate::Linear),
        Extrapolate::Hold => quote!(Extrapolate::Hold),
        Extrapolate::Error => quote!(Extrapolate::Error),
    }
}

/// An attribute that keeps clippy from suggesting `PI` for a number that only comes close to it; `None` if no number
/// does.
pub(crate) fn allow<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Option<TokenStream> {
    use std::f64::consts::*;
    let names = [
        PI,
        TAU,
        FRAC_PI_2,
        FRAC_PI_3,
        FRAC_PI_4,
        FRAC_PI_6,
        FRAC_PI_8,
        FRAC_1_PI,
        FRAC_2_PI,
        FRAC_2_SQRT_PI,
        SQRT_2,
        FRAC_1_SQRT_2,
        E,
        LN_2,
        LN_10,
        LOG2_10,
        LOG2_E,
        LOG10_2,
        LOG10_E,
    ];
    // Clippy compares only the digits that are written.
    let close = |x: f64| names.iter().any(|name| (x.abs() / name - 1.0).abs() < 1e-2);
    let any = numbers.into_iter().any(|&x| close(x));
    any.then(|| quote!(#[allow(clippy::approx_constant)]))
}

/// The curve that a function evaluates; `None` if the function evaluates no curve.
pub(crate) fn curve_of(function: Function) -> Option<usize> {
    match function {
        Function::Curve(i)
        | Function::CurveSlope(i)
        | Function::CurveSecondDerivative(i)
        | Function::CurveInverse(i)
        | Function::CurveIntegral(i)
        | Function::CurveDoubleIntegral(i)
        | Function::CurveBreakpoints(i)
        | Function::CurveStop(i) => Some(i as usize),
        Function::Choose
        | Function::Power
        | Function::User(_)
        | Function::Support(_)
        | Function::Approach(_) => None,
    }
}

/// The curves and laws that some results call.
#[derive(Default)]
pub(crate) struct Calls {
    /// Curves.
    pub curves: BTreeSet<usize>,
    /// True if a force law is called.
    pub laws: bool,
}

impl Calls {
    /// Imports that the constants of curves need.
    pub(crate) fn uses_of_curves(&self, model: &Model) -> Option<TokenStream> {
        let uses = |kind| {
            let mut curves = self.curves.iter();
            curves.any(|&curve| model.curves[curve].interpolate == kind)
        };
        let cubic = uses(Interpolate::Cubic).then(|| quote!(Cubic,));
        let linear = uses(Interpolate::Linear).then(|| quote!(Curve,));
        (!self.curves.is_empty()).then(|| {
            quote!(
                use bryant_runtime::curve::{#cubic #linear Extrapolate};
            )
        })
    }

    /// Adds the curves that the user's functions look up.
    pub(crate) fn add_user(&mut self, model: &Model) {
        for force in &model.forces {
            if let ForceKind::User(user) = ForceKind::of(force)
                && !user.function.name.is_empty()
            {
                let curves = user
                    .function
                    .curves
                    .iter()
                    .filter_map(|port| port.value.as_ref());
                self.curves.extend(curves.map(|scaled| scaled.curve));
            }
        }
    }

    /// Adds the curves and laws on which these roots depend.
    pub(crate) fn add(&mut self, graph: &Graph, roots: &[NodeId]) {
        for &id in Live::new(graph, roots).nodes() {
            if let Node::Call(function, _) = graph.node(id) {
                let Some(curve) = curve_of(function) else {
                    self.laws |= !matches!(function, Function::User(_));
                    continue;
                };
                self.curves.insert(curve);
            }
        }
    }
}
