//! Everything of a module that is not a formula: imports, sizes, parameters, the mechanism, what the runtime is told.

use super::GENERATED_CODE_VERSION;
use super::expression::{ident, number};
use super::header::plain;
use super::library::{self, Calls, Library, allow};
use crate::equations::Equations;
use crate::method::inputs::Inputs;
use crate::model::{Interpolate, Model, Parameter, Rule};
use crate::names::{Names, screaming};
use crate::program::{Adjustable, Column, Facts, Watched};
use crate::program::{Options, breakpoints};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::ops::Range;

/// Imports, and the handshake with the runtime.
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
    let behind = (!equations.auxiliaries.is_empty()).then(|| quote!(Behind,));
    let version = Literal::u32_unsuffixed(GENERATED_CODE_VERSION);
    quote! {
        #curve
        #force
        use bryant_runtime::{#behind #watched Info, Model, #output #parameter ParameterSet, Real, Sink, StateKind};
        #phantom
        #nalgebra

        const _: () = bryant_runtime::check_generated_code_version(#version);
    }
}

/// Constants for the lengths of q, v and the outputs.
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
    let (auxiliaries, memory) = (equations.auxiliaries.len(), equations.memory.len());
    let laws = [
        (auxiliaries > 0).then(|| size("Length of z.", "AUXILIARIES", auxiliaries)),
        (memory > 0).then(|| size("Length of m.", "MEMORY", memory)),
    ];
    [
        size("Length of q.", "COORDINATES", equations.coordinates.len()),
        size("Length of v.", "VELOCITIES", equations.velocities.len()),
        size("Number of outputs.", "OUTPUTS", equations.outputs.len()),
        size("Number of guards.", "GUARDS", equations.guards.len()),
        size("Number of kinks.", "KINKS", equations.kinks.len()),
        size("Number of powers.", "POWERS", equations.powers.len()),
        size(
            "Number of curves of the state.",
            "CURVES",
            equations.curves.len(),
        ),
    ]
    .into_iter()
    .chain(laws.into_iter().flatten())
    .collect()
}

/// Names of modules of constants.
pub(crate) const INDICES: [&str; 6] = [
    "auxiliaries",
    "coordinates",
    "memory",
    "outputs",
    "parameters",
    "velocities",
];

/// Modules of constants: the place of each coordinate, velocity, output and so on by its name. Only what a model has, has a module.
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

/// The struct of what the model leaves adjustable.
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

/// "belt stiffness \[N/m\], 60000.0 unless set, from 5000.0 to 200000.0"
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

/// The struct that has the methods.
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

/// The model as the runtime wants it.
pub(crate) fn implementation(equations: &Equations, library: &Library) -> TokenStream {
    let (normalize, unit) = (normalize(equations), unit(equations));
    let kink_after = breakpoints::method(equations, library);
    let (auxiliaries, memory) = (equations.auxiliaries.len(), equations.memory.len());
    let (has_z, has_m) = (auxiliaries > 0, memory > 0);
    let length = equations.coordinates.len() + equations.velocities.len() + auxiliaries + memory;
    let state = Literal::usize_unsuffixed(length);
    let z = has_z.then(|| quote!(, z));
    let m = has_m.then(|| quote!(, m));
    let text = match (has_z, has_m) {
        (false, false) => " Length of the state: q followed by v.",
        (true, false) => " Length of the state: q, v, z.",
        (false, true) => " Length of the state: q, v, m.",
        (true, true) => " Length of the state: q, v, z, m.",
    };
    let split = quote!(let (q, v #z #m) = parts(y););
    let rest = (has_z || has_m).then(|| quote!(, ..));
    let q_and_v = quote!(let (q, v #rest) = parts(y););
    let arguments = quote!(t, q, v #z #m);
    let start_z = has_z.then(|| quote!(, &self.initial_auxiliaries()));
    let start_m = has_m.then(|| quote!(, &self.initial_memory()));
    let rate_z = has_z.then(|| {
        quote!(self.each_auxiliary_rate(#arguments, &mut Behind::<_, { COORDINATES + VELOCITIES }>(sink));)
    });
    let motion = ident(crate::program::plan::EACH_MOTION);
    // memory does not change during a step
    let rate_m = has_m.then(|| {
        quote! {
            for i in STATE - MEMORY..STATE {
                sink.put(i, T::from_f64(0.0));
            }
        }
    });
    let by_guards = crate::program::plan::renews_by_guards(equations)
        .then(|| quote!(, &self.guards_at(#arguments)));
    let renew = has_m.then(|| match equations.charts {
        0 => quote! {
            #[inline(always)]
            fn renew(&self, t: T, y: &mut [T; STATE]) {
                #split
                let renewed = self.renewed_memory(#arguments #by_guards);
                y[STATE - MEMORY..].copy_from_slice(&renewed);
            }
        },
        _ => quote! {
            #[inline(always)]
            fn renew(&self, t: T, y: &mut [T; STATE]) {
                #split
                let (q, v, m) = self.renewed(#arguments #by_guards);
                y[..COORDINATES].copy_from_slice(&q);
                y[COORDINATES..COORDINATES + VELOCITIES].copy_from_slice(&v);
                y[STATE - MEMORY..].copy_from_slice(&m);
            }
        },
    });
    let guards = (!equations.guards.is_empty()).then(|| {
        quote! {
            #[inline(always)]
            fn guards(&self, t: T, y: &[T; STATE]) -> [T; GUARDS] {
                #split
                self.guards_at(#arguments)
            }
        }
    });
    let kinks = (!equations.kinks.is_empty()).then(|| {
        quote! {
            #[inline(always)]
            fn kinks(&self, t: T, y: &[T; STATE]) -> [T; KINKS] {
                #split
                self.kinks_at(#arguments)
            }
        }
    });
    let onsets = (!equations.onsets.is_empty()).then(|| {
        quote! {
            #[inline(always)]
            fn onsets(&self, t: T, y: &[T; STATE], onsets: &mut [T]) {
                #split
                onsets.copy_from_slice(&self.onsets_at(#arguments));
            }
        }
    });
    let curves = (!equations.curves.is_empty()).then(|| {
        quote! {
            fn curves(&self, t: T, y: &[T; STATE]) -> [T; CURVES] {
                #split
                self.curves_at(#arguments)
            }
        }
    });
    let pivots = (!equations.pivots.is_empty()).then(|| {
        quote! {
            fn smallest_pivot(&self, t: T, y: &[T; STATE]) -> Option<(usize, T)> {
                #split
                let pivots = self.pivots(#arguments).into_iter().enumerate();
                pivots.min_by(|a, b| a.1.to_f64().total_cmp(&b.1.to_f64()))
            }
        }
    });
    let conditions = (!equations.conditions.is_empty()).then(|| {
        let rules = equations
            .conditions
            .iter()
            .map(|condition| match condition.rule {
                Rule::Finite => quote!(|_| true),
                Rule::NotZero => quote!(|value| value != 0.0),
                Rule::NotNegative => quote!(|value| value >= 0.0),
                Rule::Positive => quote!(|value| value > 0.0),
            });
        let count = Literal::usize_unsuffixed(equations.conditions.len());
        quote! {
            fn violated(&self) -> Option<usize> {
                let rules: [fn(f64) -> bool; #count] = [#(#rules),*];
                let mut conditions = self.conditions().into_iter().zip(rules);
                conditions.position(|(value, keeps)| {
                    let value = value.to_f64();
                    !(value.is_finite() && keeps(value))
                })
            }
        }
    });
    let powers = (!equations.powers.is_empty()).then(|| {
        quote! {
            fn powers(&self, t: T, y: &[T; STATE]) -> [T; POWERS] {
                #split
                self.powers_at(#arguments)
            }
        }
    });
    let momentum = (!equations.momentum.is_empty()).then(|| {
        quote! {
            fn momentum(&self, t: T, y: &[T; STATE]) -> [T; 6] {
                #split
                self.momentum_at(#arguments)
            }

            fn external_wrench(&self, t: T, y: &[T; STATE]) -> [T; 6] {
                #split
                self.external_wrench_at(#arguments)
            }
        }
    });
    let states = states(has_z, has_m);
    quote! {
        #[doc = #text]
        pub const STATE: usize = #state;

        #[allow(dead_code)]
        impl<T: Real> Mechanism<T> {
            /// v̇ at a whole state, as [`Model::initial_state`] and runs have it. Force laws may get states of their own, and what calls this stays as it is.
            #[inline(always)]
            pub fn accelerations_of(&self, t: T, y: &[T; STATE]) -> [T; VELOCITIES] {
                #split
                self.accelerations(#arguments)
            }
        }

        impl<T: Real> Model<T> for Mechanism<T> {
            type With<U: Real> = Mechanism<U>;
            type Parameters = Parameters<T>;
            type State = [T; STATE];
            type Outputs = [T; OUTPUTS];
            type Guards = [T; GUARDS];
            type Kinks = [T; KINKS];
            type Powers = [T; POWERS];
            type Curves = [T; CURVES];
            const INFO: &'static Info = &INFO;

            #[inline(always)]
            fn new(parameters: Parameters<T>) -> Self {
                Self::new(parameters)
            }

            fn parameters(&self) -> &Parameters<T> {
                &self.parameters
            }

            #[inline(always)]
            fn initial_state(&self) -> [T; STATE] {
                let (q, v) = self.initial_conditions();
                joined(&q, &v #start_z #start_m)
            }

            #[inline(always)]
            fn derivative(&self, t: T, y: &[T; STATE]) -> [T; STATE] {
                let mut rate = [T::from_f64(0.0); STATE];
                self.each_rate(t, y, &mut rate);
                rate
            }

            #[inline(always)]
            fn each_rate(&self, t: T, y: &[T; STATE], sink: &mut impl Sink<T>) {
                #split
                self.#motion(#arguments, sink);
                #rate_z
                #rate_m
            }

            #[inline(always)]
            fn coordinate_rates(&self, y: &[T; STATE], rate: &mut [T; STATE]) {
                #q_and_v
                self.each_coordinate_rate(q, v, rate);
            }

            #[inline(always)]
            fn outputs(&self, t: T, y: &[T; STATE]) -> [T; OUTPUTS] {
                #split
                self.outputs_at(#arguments)
            }

            fn kinetic_energy(&self, t: T, y: &[T; STATE]) -> T {
                #split
                self.kinetic_energy_at(#arguments)
            }

            #powers
            #momentum
            #guards
            #kinks
            #onsets
            #curves
            #pivots
            #conditions
            #renew
            #normalize
            #kink_after
        }

        #unit
        #states
    }
}

/// The functions that put a state together and take it apart.
fn states(has_z: bool, has_m: bool) -> TokenStream {
    // (name, length, of what)
    let mut parts = vec![("q", "COORDINATES"), ("v", "VELOCITIES")];
    if has_z {
        parts.push(("z", "AUXILIARIES"));
    }
    if has_m {
        parts.push(("m", "MEMORY"));
    }
    let names: Vec<_> = parts.iter().map(|(name, _)| ident(name)).collect();
    let lengths: Vec<_> = parts.iter().map(|(_, length)| ident(length)).collect();
    let words = match parts.len() {
        2 => "q and v".to_string(),
        _ => {
            let (last, first) = (parts[parts.len() - 1].0, &parts[..parts.len() - 1]);
            let first: Vec<&str> = first.iter().map(|part| part.0).collect();
            format!("{} and {last}", first.join(", "))
        }
    };
    let (joins, splits) = (
        format!(" The state made of {words}."),
        format!(" {words} of a state."),
    );
    if parts.len() == 2 {
        return quote! {
            #[doc = #joins]
            #[inline(always)]
            fn joined<T: Real>(q: &[T; COORDINATES], v: &[T; VELOCITIES]) -> [T; STATE] {
                let mut y = [T::from_f64(0.0); STATE];
                y[..COORDINATES].copy_from_slice(q);
                y[COORDINATES..].copy_from_slice(v);
                y
            }

            #[doc = #splits]
            #[inline(always)]
            fn parts<T>(y: &[T; STATE]) -> (&[T; COORDINATES], &[T; VELOCITIES]) {
                match (y.first_chunk(), y.last_chunk()) {
                    (Some(q), Some(v)) => (q, v),
                    _ => unreachable!("a state is as long as q and v together"),
                }
            }
        };
    }
    // all but the last are split off from the front
    let front = &names[..names.len() - 1];
    let last = &names[names.len() - 1];
    let too_short = format!("a state is as long as {words} together");
    quote! {
        #[doc = #joins]
        #[inline(always)]
        fn joined<T: Real>(#(#names: &[T; #lengths]),*) -> [T; STATE] {
            let mut y = [T::from_f64(0.0); STATE];
            let parts = [#(&#names[..]),*];
            for (entry, value) in y.iter_mut().zip(parts.into_iter().flatten()) {
                *entry = *value;
            }
            y
        }

        #[doc = #splits]
        #[inline(always)]
        fn parts<T>(y: &[T; STATE]) -> (#(&[T; #lengths]),*) {
            let rest = &y[..];
            #(let Some((#front, rest)) = rest.split_first_chunk() else { unreachable!(#too_short) };)*
            let Some(#last) = rest.first_chunk() else { unreachable!(#too_short) };
            (#(#names),*)
        }
    }
}

fn normalize(equations: &Equations) -> TokenStream {
    if equations.quaternions.is_empty() {
        return quote!(
            #[inline(always)]
            fn normalize(&self, _y: &mut [T; STATE]) {}
        );
    }
    let ranges = neighbours(&equations.quaternions);
    let literal = Literal::usize_unsuffixed;
    let loops = ranges.iter().map(|range| {
        let (start, end) = (literal(range.start), literal(range.end));
        quote! {
            for quaternion in y[#start..#end].as_chunks_mut::<4>().0 {
                *quaternion = unit(*quaternion);
            }
        }
    });
    // Backwards: what the last stage of a step found last is still near, and what the next one reads first is near then.
    let mut changes = Vec::new();
    let mut end = quote!(STATE);
    for range in ranges.iter().rev() {
        changes.push(changed(range.end, &end));
        let (start, number) = (literal(range.start), literal(range.len() / 4));
        let first = match range.start {
            0 => quote!(4 * i),
            _ => quote!(#start + 4 * i),
        };
        changes.push(quote! {
            for i in (0..#number).rev() {
                let i = #first;
                [y[i], y[i + 1], y[i + 2], y[i + 3]] = unit([
                    change.of(i, y[i]),
                    change.of(i + 1, y[i + 1]),
                    change.of(i + 2, y[i + 2]),
                    change.of(i + 3, y[i + 3]),
                ]);
            }
        });
        end = quote!(#start);
    }
    if ranges.first().is_none_or(|range| range.start > 0) {
        changes.push(changed(0, &end));
    }
    quote! {
        #[inline(always)]
        fn normalize(&self, y: &mut [T; STATE]) {
            #(#loops)*
        }

        #[inline(always)]
        fn normalize_changed(&self, y: &mut [T; STATE], change: &impl bryant_runtime::Change<T>) {
            #(#changes)*
        }
    }
}

/// Quaternions by runs of neighbours, which are scaled in one loop.
pub(crate) fn neighbours(quaternions: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for quaternion in quaternions {
        match ranges.last_mut() {
            Some(range) if range.end == quaternion.start => range.end = quaternion.end,
            _ => ranges.push(quaternion.clone()),
        }
    }
    ranges
}

/// Entries that are no quaternions, changed.
fn changed(start: usize, end: &TokenStream) -> TokenStream {
    let start = Literal::usize_unsuffixed(start);
    quote! {
        for i in (#start..#end).rev() {
            y[i] = change.of(i, y[i]);
        }
    }
}

/// What generated code scales quaternions by, where there are any.
fn unit(equations: &Equations) -> Option<TokenStream> {
    (!equations.quaternions.is_empty()).then(|| {
        quote! {
            /// The quaternion of length 1 in the same direction.
            #[inline(always)]
            fn unit<T: Real>([w, x, y, z]: [T; 4]) -> [T; 4] {
                let squared = w * w + x * x + y * y + z * z;
                let scale = T::from_f64(1.0) / squared.sqrt();
                [w * scale, x * scale, y * scale, z * scale]
            }
        }
    })
}

/// Names, units and sizes.
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
        guards,
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
            told,
            kind,
            ..
        } = watched;
        let ([first, last], [start, end]) = (watched.range.map(number), watched.ends.map(number));
        let extrapolate = library::extrapolate(watched.extrapolate);
        let kind = match kind {
            crate::equations::Watched::Curve(_) => quote!(CurveKind::Curve),
            crate::equations::Watched::Bearing => quote!(CurveKind::Bearing),
            crate::equations::Watched::Volume => quote!(CurveKind::Volume),
            crate::equations::Watched::Direction(i) => {
                let i = Literal::u8_unsuffixed(*i);
                quote!(CurveKind::Direction(#i))
            }
        };
        quote!(CurveInfo { name: #name, first: #first, last: #last, ends: [#start, #end], extrapolate: #extrapolate, told: #told, kind: #kind })
    });
    let outputs = facts
        .outputs
        .iter()
        .map(|Column { name, unit }| quote!(OutputInfo { name: #name, unit: #unit }));
    let parameters = facts.parameters.iter().map(|parameter| {
        let Adjustable { name, unit, .. } = parameter;
        let [default, min, max] = [parameter.default, parameter.min, parameter.max].map(number);
        quote!(ParameterInfo { name: #name, unit: #unit, default: #default, min: #min, max: #max })
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
            guards: &[#(#guards),*],
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
