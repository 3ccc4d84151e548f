//! Writes all items of a module that are not formulas: imports, sizes, parameters, the mechanism, and the information
//! for the runtime.

use super::GENERATED_CODE_VERSION;
use super::expression::{ident, number};
use super::library::{self, Calls, allow};
use crate::equations::Equations;
use crate::method::inputs::Inputs;
use crate::model::{Interpolate, Model, Parameter};
use crate::names::{Names, plain, screaming};
use crate::program::Options;
use crate::program::{Adjustable, Column, Facts, Watched};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The imports, and the check that the version of the runtime fits.
pub(crate) fn uses(
    model: &Model,
    equations: &Equations,
    calls: &Calls,
    options: &Options,
) -> TokenStream {
    let uses = |kind| {
        let mut curves = calls.curves.iter();
        curves.any(|&curve| model.curves[curve].interpolate == kind)
    };
    let cubic = uses(Interpolate::Cubic).then(|| quote!(Cubic,));
    let linear = uses(Interpolate::Linear).then(|| quote!(Curve,));
    let watches = !equations.curves.is_empty();
    let curve = (!calls.curves.is_empty() || watches).then(|| {
        quote!(
            use bryant_runtime::curve::{#cubic #linear Extrapolate};
        )
    });
    let force = calls.laws.then(|| {
        quote!(
            use bryant_runtime::force;
        )
    });
    let nalgebra = options.matrices.then(|| {
        quote!(
            bryant_runtime::use_nalgebra!(SMatrix, SVector);
        )
    });
    let output = (!model.outputs.is_empty()).then(|| quote!(OutputInfo,));
    let parameter = (!model.parameters.is_empty()).then(|| quote!(ParameterInfo,));
    let watched = (!equations.curves.is_empty()).then(|| quote!(CurveInfo, CurveKind,));
    let phantom = model.parameters.is_empty().then(|| {
        quote!(
            use core::marker::PhantomData;
        )
    });
    let offset_view = (!equations.auxiliaries.is_empty()).then(|| quote!(OffsetView,));
    let version = Literal::u32_unsuffixed(GENERATED_CODE_VERSION);
    quote! {
        #curve
        #force
        use bryant_runtime::{#watched Info, Model, #offset_view #output OutputWriter, #parameter ParameterSet, Real, StateKind};
        #phantom
        #nalgebra

        const _: () = bryant_runtime::check_generated_code_version(#version);
    }
}

/// The constants for the lengths of q, v, the outputs and so on.
pub(crate) fn sizes(equations: &Equations) -> TokenStream {
    let size = |text: &str, name: &str, size: usize| {
        let (text, name, size) = (
            format!(" {text}"),
            ident(name),
            Literal::usize_unsuffixed(size),
        );
        quote! {
            #[doc = #text]
            pub const #name: usize = #size;
        }
    };
    let laws = [
        (
            "Number of event functions.",
            "EVENT_FUNCTIONS",
            equations.event_functions.len(),
        ),
        ("Length of z.", "AUXILIARIES", equations.auxiliaries.len()),
        ("Length of m.", "MEMORY", equations.memory.len()),
    ];
    let laws = laws.into_iter().filter(|(_, _, length)| *length > 0);
    [
        size("Length of q.", "COORDINATES", equations.coordinates.len()),
        size("Length of v.", "VELOCITIES", equations.velocities.len()),
        size("Number of outputs.", "OUTPUTS", equations.outputs.len()),
    ]
    .into_iter()
    .chain(laws.map(|(text, name, length)| size(text, name, length)))
    .collect()
}

/// Names of the modules of constants.
pub(crate) const INDICES: [&str; 6] = [
    "auxiliaries",
    "coordinates",
    "memory",
    "outputs",
    "parameters",
    "velocities",
];

/// Modules of constants that give the index of each coordinate, velocity, output and so on by its name. There is no
/// module for a kind of entry that the model does not have.
// Long: an entry for each module.
pub(crate) fn indices(model: &Model, equations: &Equations, inputs: &Inputs) -> TokenStream {
    let facts = Facts::of(model, equations);
    let units = |start: usize, names: &[String]| -> Vec<(String, String)> {
        let units = facts.units[start..].iter();
        names.iter().cloned().zip(units.cloned()).collect()
    };
    let of_q = facts.coordinates.len();
    let of_z = of_q + facts.velocities.len();
    let of_m = of_z + facts.auxiliaries.len();
    let columns = facts.outputs.iter();
    let adjustable = facts.parameters.iter();
    let outputs: Vec<String> = model.outputs.iter().map(|o| o.name.clone()).collect();
    let modules = [
        (
            "coordinates",
            "Places in q, by name.",
            units(0, &facts.coordinates),
            &inputs.coordinates,
        ),
        (
            "velocities",
            "Places in v, by name.",
            units(of_q, &facts.velocities),
            &inputs.velocities,
        ),
        (
            "auxiliaries",
            "Places in z, by name.",
            units(of_z, &facts.auxiliaries),
            &inputs.auxiliaries,
        ),
        (
            "memory",
            "Places in m, by name.",
            units(of_m, &facts.memory),
            &inputs.memory,
        ),
        (
            "outputs",
            "Places among the outputs, by name.",
            columns.map(|c| (c.name.clone(), c.unit.clone())).collect(),
            &outputs,
        ),
        (
            "parameters",
            "Places among the parameters, by name.",
            adjustable
                .map(|p| (p.name.clone(), p.unit.clone()))
                .collect(),
            &inputs.parameters,
        ),
    ];
    let modules = modules
        .into_iter()
        .filter(|(_, _, named, _)| !named.is_empty());
    let modules = modules.map(|(module, text, named, words)| {
        let mut names = Names::default();
        let constants = named
            .iter()
            .zip(words)
            .enumerate()
            .map(|(index, (of, words))| {
                let (name, unit) = of;
                let unit = match unit.as_str() {
                    "" => String::new(),
                    unit => format!(" \\[{}\\]", plain(unit)),
                };
                let text = format!(" {}{unit}", plain(name));
                let name = ident(&names.take(&screaming(words)));
                let index = Literal::usize_unsuffixed(index);
                quote! {
                    #[doc = #text]
                    pub const #name: usize = #index;
                }
            });
        let (module, text) = (ident(module), format!(" {text}"));
        quote! {
            #[doc = #text]
            #[allow(dead_code)]
            pub mod #module {
                #(#constants)*
            }
        }
    });
    modules.collect()
}

/// The struct of the parameters, which the model leaves adjustable.
pub(crate) fn parameters(model: &Model, inputs: &Inputs) -> TokenStream {
    let names: Vec<_> = inputs.parameters.iter().map(|name| ident(name)).collect();
    let indices: Vec<_> = (0..names.len()).map(Literal::usize_unsuffixed).collect();
    let texts = model
        .parameters
        .iter()
        .map(|parameter| format!(" {}", describe(parameter)));
    let allowed = allow(model.parameters.iter().map(|parameter| &parameter.default));
    let defaults = model
        .parameters
        .iter()
        .map(|parameter| number(parameter.default));
    if names.is_empty() {
        return quote! {
            /// The model leaves nothing adjustable.
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Parameters<T> {
                scalar: PhantomData<T>,
            }

            impl<T> Default for Parameters<T> {
                fn default() -> Self {
                    Self { scalar: PhantomData }
                }
            }

            impl<T: Real> ParameterSet<T> for Parameters<T> {
                fn defaults() -> Self {
                    Self::default()
                }
                fn get(&self, _index: usize) -> Option<T> {
                    None
                }
                fn set(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            }
        };
    }
    quote! {
        /// What the model leaves adjustable, in SI units.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters<T> {
            #(#[doc = #texts] pub #names: T,)*
        }

        #allowed
        impl<T: Real> Default for Parameters<T> {
            fn default() -> Self {
                Self { #(#names: T::from_f64(#defaults)),* }
            }
        }

        impl<T: Real> ParameterSet<T> for Parameters<T> {
            fn defaults() -> Self {
                Self::default()
            }
            fn get(&self, index: usize) -> Option<T> {
                match index {
                    #(#indices => Some(self.#names),)*
                    _ => None,
                }
            }
            fn set(&mut self, index: usize, value: T) -> bool {
                let parameter = match index {
                    #(#indices => &mut self.#names,)*
                    _ => return false,
                };
                *parameter = value;
                true
            }
        }
    }
}

/// The description of a parameter, such as "belt stiffness \[N/m\], 60000.0 unless set, from 5000.0 to 200000.0".
fn describe(parameter: &Parameter) -> String {
    let mut text = plain(&parameter.name).replace('_', " ");
    if !parameter.unit.is_empty() {
        text += &format!(" \\[{}\\]", plain(&parameter.unit));
    }
    text += &format!(", {:?} unless set", parameter.default);
    match (parameter.min, parameter.max) {
        (Some(min), Some(max)) => text + &format!(", from {min:?} to {max:?}."),
        (Some(min), None) => text + &format!(", at least {min:?}."),
        (None, Some(max)) => text + &format!(", at most {max:?}."),
        (None, None) => text + ".",
    }
}

/// The struct `Mechanism`, which has the methods.
pub(crate) fn mechanism(inputs: &Inputs) -> TokenStream {
    let names = inputs.derived.iter().map(|name| ident(name));
    let texts = inputs
        .derived_in
        .iter()
        .map(|section| match section.as_str() {
            "" => " Depends on parameters alone.".to_string(),
            section => format!(" Of {}.", plain(section)),
        });
    quote! {
        /// The model at one set of parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Mechanism<T> {
            parameters: Parameters<T>,
            #(#[doc = #texts] #names: T,)*
        }
    }
}

/// The constant `INFO`: names, units and sizes.
// Long: an entry for each field of the runtime's `Info`.
pub(crate) fn info(model: &Model, equations: &Equations) -> TokenStream {
    let facts = Facts::of(model, equations);
    let Facts {
        name,
        digest,
        coordinates,
        velocities,
        units,
        auxiliaries,
        memory,
        event_functions,
        kinks,
        onsets,
        powers,
        time_ends,
        pivots,
        conditions,
        free,
        ..
    } = &facts;
    let dimension = Literal::u8_unsuffixed(facts.dimension);
    let corners = Literal::usize_unsuffixed(facts.corners);
    let kinds = facts.kinds.iter().map(|kind| ident(&format!("{kind:?}")));
    let watched = facts.curves.iter().map(|watched| {
        let Watched {
            name,
            unit,
            states_extrapolation,
            kind,
            ..
        } = watched;
        let ([first, last], [start, end]) = (watched.range.map(number), watched.ends.map(number));
        let extrapolate = library::extrapolate(watched.extrapolate);
        let kind = match kind {
            crate::equations::Watched::Curve(..) => quote!(CurveKind::Curve),
            crate::equations::Watched::Bearing => quote!(CurveKind::Bearing),
            crate::equations::Watched::HalfTurn => quote!(CurveKind::HalfTurn),
            crate::equations::Watched::Volume => quote!(CurveKind::Volume),
            crate::equations::Watched::Edge => quote!(CurveKind::Edge),
            crate::equations::Watched::Direction(i) => {
                let i = Literal::u8_unsuffixed(*i);
                quote!(CurveKind::Direction(#i))
            }
        };
        quote!(CurveInfo { name: #name, unit: #unit, first: #first, last: #last, ends: [#start, #end], extrapolate: #extrapolate, told: #states_extrapolation, kind: #kind })
    });
    let outputs = facts
        .outputs
        .iter()
        .map(|Column { name, unit }| quote!(OutputInfo { name: #name, unit: #unit }));
    let parameters = facts.parameters.iter().map(|parameter| {
        let Adjustable {
            name, unit, input, ..
        } = parameter;
        let [default, min, max] = [parameter.default, parameter.min, parameter.max].map(number);
        quote!(ParameterInfo { name: #name, unit: #unit, default: #default, min: #min, max: #max, input: #input })
    });
    let ends = facts
        .curves
        .iter()
        .flat_map(|watched| [watched.range, watched.ends].concat());
    let bounds = facts.parameters.iter().flat_map(|parameter| {
        let bounds = [parameter.default, parameter.min, parameter.max];
        bounds.into_iter().filter(|bound| bound.is_finite())
    });
    let run = [facts.duration, facts.every];
    let numbers: Vec<f64> = bounds
        .chain(facts.breakpoints.iter().copied())
        .chain(run)
        .chain(ends)
        .collect();
    let allowed = allow(&numbers);
    let breakpoints = facts.breakpoints.iter().map(|&time| number(time));
    let [duration, every] = run.map(number);
    let longest_step = match facts.longest_step.is_finite() {
        true => number(facts.longest_step),
        false => quote!(f64::INFINITY),
    };
    quote! {
        /// Names, units and sizes.
        #allowed
        pub static INFO: Info = Info {
            name: #name,
            digest: #digest,
            dimension: #dimension,
            coordinates: &[#(#coordinates),*],
            velocities: &[#(#velocities),*],
            kinds: &[#(StateKind::#kinds),*],
            units: &[#(#units),*],
            auxiliaries: &[#(#auxiliaries),*],
            memory: &[#(#memory),*],
            event_functions: &[#(#event_functions),*],
            kinks: &[#(#kinks),*],
            onsets: &[#(#onsets),*],
            corners: #corners,
            longest_step: #longest_step,
            powers: &[#(#powers),*],
            curves: &[#(#watched),*],
            time_ends: #time_ends,
            pivots: &[#(#pivots),*],
            conditions: &[#(#conditions),*],
            free: #free,
            outputs: &[#(#outputs),*],
            parameters: &[#(#parameters),*],
            breakpoints: &[#(#breakpoints),*],
            duration: #duration,
            every: #every,
        };
    }
}
