//! Writes the implementation of the trait `Model` for the runtime; it calls the methods that take the parts of a state
//! (q, v, z, m).

use super::expression::ident;
use super::library::Library;
use super::method::method_name;
use crate::equations::Equations;
use crate::method::results::Results;
use crate::method::table::{self, Specification};
use crate::model::Rule;
use crate::program::neighbours;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The implementation of the trait, and the helper functions that it calls besides the methods.
pub(crate) fn implementation(
    equations: &Equations,
    methods: &[Specification],
    library: &Library,
) -> TokenStream {
    let state = State::of(equations);
    let (length, accelerations_of) = (state.length(equations), state.accelerations_of());
    let rates = state.rates();
    let initial_state = state.initial_state();
    let at_states = state.at_states(methods);
    let pivots = (!equations.pivots.is_empty()).then(|| state.smallest_pivot());
    let conditions = violated(equations);
    let renew = state.renew(equations);
    let (normalize, unit) = (normalize(equations), unit(equations));
    let kink_after = kink_after(equations, library);
    let states = states(state.z, state.m);
    quote! {
        #length
        #accelerations_of

        impl<T: Real> Model<T> for Mechanism<T> {
            type With<U: Real> = Mechanism<U>;
            type Parameters = Parameters<T>;
            type State = [T; STATE];
            const INFO: &'static Info<'static> = &INFO;

            #[inline(always)]
            fn new(parameters: Parameters<T>) -> Self {
                Self::new(parameters)
            }

            fn parameters(&self) -> &Parameters<T> {
                &self.parameters
            }

            #initial_state
            #rates
            #(#at_states)*
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

/// Whether a state has z (auxiliaries) and m (memory), and code that splits a state into its parts.
struct State {
    z: bool,
    m: bool,
    /// A statement that names all parts of `y`.
    split: TokenStream,
    /// The arguments of a call of a method that takes the parts of a state.
    arguments: TokenStream,
}

impl State {
    fn of(equations: &Equations) -> Self {
        let (has_z, has_m) = (
            !equations.auxiliaries.is_empty(),
            !equations.memory.is_empty(),
        );
        let (z, m) = (has_z.then(|| quote!(, z)), has_m.then(|| quote!(, m)));
        Self {
            z: has_z,
            m: has_m,
            split: quote!(let (q, v #z #m) = parts(y);),
            arguments: quote!(t, q, v #z #m),
        }
    }

    fn length(&self, equations: &Equations) -> TokenStream {
        let text = match (self.z, self.m) {
            (false, false) => " Length of the state: q followed by v.",
            (true, false) => " Length of the state: q, v, z.",
            (false, true) => " Length of the state: q, v, m.",
            (true, true) => " Length of the state: q, v, z, m.",
        };
        let moving = equations.coordinates.len() + equations.velocities.len();
        let laws = equations.auxiliaries.len() + equations.memory.len();
        let length = Literal::usize_unsuffixed(moving + laws);
        quote! {
            #[doc = #text]
            pub const STATE: usize = #length;
        }
    }

    fn accelerations_of(&self) -> TokenStream {
        let Self {
            split, arguments, ..
        } = self;
        quote! {
            #[allow(dead_code)]
            impl<T: Real> Mechanism<T> {
                /// v̇ at a whole state, as [`Model::initial_state`] and runs have it. Force laws may get states of
                /// their own, and what calls this stays as it is.
                #[inline(always)]
                pub fn accelerations_of(&self, t: T, y: &[T; STATE]) -> [T; VELOCITIES] {
                    #split
                    self.accelerations(#arguments)
                }
            }
        }
    }

    fn initial_state(&self) -> TokenStream {
        let z = self.z.then(|| quote!(, &self.initial_auxiliaries()));
        let m = self.m.then(|| quote!(, &self.initial_memory()));
        quote! {
            #[inline(always)]
            fn initial_state(&self) -> [T; STATE] {
                let (q, v) = self.initial_conditions();
                joined(&q, &v #z #m)
            }
        }
    }

    /// The method for the rate of the whole state, and the method for the rate of q alone.
    fn rates(&self) -> TokenStream {
        let Self {
            split, arguments, ..
        } = self;
        let motion = ident(table::EACH_MOTION);
        let z = self.z.then(|| {
            quote!(self.each_auxiliary_rate(#arguments, &mut OffsetView::<_, { COORDINATES + VELOCITIES }>(writer));)
        });
        // memory does not change during a step
        let m = self.m.then(|| {
            quote! {
                for i in STATE - MEMORY..STATE {
                    writer.put(i, T::from_f64(0.0));
                }
            }
        });
        let rest = (self.z || self.m).then(|| quote!(, ..));
        quote! {
            #[inline(always)]
            fn derivative(&self, t: T, y: &[T; STATE]) -> [T; STATE] {
                let mut rate = [T::from_f64(0.0); STATE];
                self.each_rate(t, y, &mut rate);
                rate
            }

            #[inline(always)]
            fn each_rate(&self, t: T, y: &[T; STATE], writer: &mut impl OutputWriter<T>) {
                #split
                self.#motion(#arguments, writer);
                #z
                #m
            }

            #[inline(always)]
            fn coordinate_rates(&self, y: &[T; STATE], rate: &mut [T; STATE]) {
                let (q, v #rest) = parts(y);
                self.each_coordinate_rate(q, v, rate);
            }
        }
    }

    /// The methods of the trait that only split the state and call a method that takes its parts.
    fn at_states(&self, methods: &[Specification]) -> Vec<TokenStream> {
        let same = |method: &&Specification| method.of_parts && !method.results.one_by_one();
        let methods = methods.iter().filter(same);
        methods.map(|of| self.at_state(of)).collect()
    }

    fn at_state(&self, method: &Specification) -> TokenStream {
        let Self {
            split, arguments, ..
        } = self;
        let (name, at_parts) = (ident(&method.name), ident(&method_name(method)));
        let inline = method.in_lanes.then(|| quote!(#[inline(always)]));
        let results = quote!(self.#at_parts(#arguments));
        let results = match method.results {
            Results::Scalar => quote!([#results]),
            _ => results,
        };
        quote! {
            #inline
            fn #name(&self, t: T, y: &[T; STATE], results: &mut [T]) {
                #split
                results.copy_from_slice(&#results);
            }
        }
    }

    fn smallest_pivot(&self) -> TokenStream {
        let Self {
            split, arguments, ..
        } = self;
        quote! {
            fn smallest_pivot(&self, t: T, y: &[T; STATE]) -> Option<(usize, T)> {
                #split
                let pivots = self.pivots(#arguments).into_iter().enumerate();
                pivots.reduce(|least, next| if next.1.to_f64() < least.1.to_f64() { next } else { least })
            }
        }
    }

    fn renew(&self, equations: &Equations) -> Option<TokenStream> {
        let Self {
            split, arguments, ..
        } = self;
        let by_event_functions = table::renews_by_event_functions(equations)
            .then(|| quote!(, &self.event_functions_at(#arguments)));
        let renew = match equations.charts {
            0 => quote! {
                let renewed = self.renewed_memory(#arguments #by_event_functions);
                y[STATE - MEMORY..].copy_from_slice(&renewed);
            },
            _ => quote! {
                let (q, v, m) = self.renewed(#arguments #by_event_functions);
                y[..COORDINATES].copy_from_slice(&q);
                y[COORDINATES..COORDINATES + VELOCITIES].copy_from_slice(&v);
                y[STATE - MEMORY..].copy_from_slice(&m);
            },
        };
        self.m.then(|| {
            quote! {
                #[inline(always)]
                fn renew(&self, t: T, y: &mut [T; STATE]) {
                    #split
                    #renew
                }
            }
        })
    }
}

/// The method that returns the first condition that the parameters break; `None` if the model has no conditions.
fn violated(equations: &Equations) -> Option<TokenStream> {
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
    (!equations.conditions.is_empty()).then(|| {
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
    })
}

/// The method that returns the next kink after a time, over all curves of time that a parameter stretches; `None` if
/// there are no such curves.
fn kink_after(equations: &Equations, library: &Library) -> Option<TokenStream> {
    let curves: Vec<Ident> = equations
        .stretched_curves_of_time()
        .map(|(curve, _)| format_ident!("{}", library.name(curve)))
        .collect();
    let indices = (0..curves.len()).map(Literal::usize_unsuffixed);
    (!curves.is_empty()).then(|| {
        quote! {
            fn kink_after(&self, t: f64) -> T {
                let rates = self.kink_rates();
                T::from_f64(f64::INFINITY) #(.min(#curves.kink_after(rates[#indices], t)))*
            }
        }
    })
}

/// The functions that join the parts of a state, and split a state into its parts.
fn states(has_z: bool, has_m: bool) -> TokenStream {
    // (name, constant with its length)
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
    // each part but the last is split off at the front
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
    // From the last entry to the first: the last stage of a step has just written the last entries, so they are still
    // in the cache; the next stage begins at the first entries, which are in the cache then.
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

/// The loop that applies a change to the entries from `start` to `end`, which are no quaternions.
fn changed(start: usize, end: &TokenStream) -> TokenStream {
    let start = Literal::usize_unsuffixed(start);
    quote! {
        for i in (#start..#end).rev() {
            y[i] = change.of(i, y[i]);
        }
    }
}

/// The function that scales a quaternion to length 1; `None` if the model has no quaternions.
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
