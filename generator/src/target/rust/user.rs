//! Writes the user's own forces: a module for each function, with plain structs for its arguments and results, and an
//! adapter that the equations call with scalars.
//!
//! The text of the user comes first in its module, unchanged, so that the messages of a compiler refer to the user's
//! lines. Forces that call the same function with the same names share a module.

use super::expression::ident;
use super::items::INDICES;
use super::library::{Calls, Library};
use crate::law::ForceKind;
use crate::law::types::{Port, User, UserSource};
use crate::model::{Dimension, Model};
use crate::names::{Names, plain, snake};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::{File, Path, parse_quote};

/// Name of the adapter function in each module.
const ADAPTER: &str = "scalars";

/// Names of modules that generated code uses already.
const TAKEN: [&str; 5] = ["bryant_runtime", "core", "curve", "force", "nalgebra"];

/// The modules of the user forces of a model.
#[derive(Default)]
pub(crate) struct Users {
    modules: Vec<Module>,
    /// For each force of the model, the path of its adapter; empty for forces of other kinds.
    paths: Vec<String>,
}

struct Module {
    name: String,
    /// The first of the forces that share the module.
    force: usize,
}

impl Users {
    /// Names the modules of a model.
    pub(crate) fn new(model: &Model) -> Self {
        let mut users = Users::default();
        let mut names = Names::with(&[&TAKEN[..], &INDICES].concat());
        for (index, force) in model.forces.iter().enumerate() {
            let user = match ForceKind::of(force) {
                ForceKind::User(user) if !user.function.name.is_empty() => user,
                _ => {
                    users.paths.push(String::new());
                    continue;
                }
            };
            let same = users.modules.iter().find(|module| {
                matches!(ForceKind::of(&model.forces[module.force]), ForceKind::User(other) if alike(other, user))
            });
            let name = match same {
                Some(module) => module.name.clone(),
                None => {
                    let function = user.function.name.rsplit("::").next().unwrap_or_default();
                    let name = names.take(&snake(function));
                    users.modules.push(Module {
                        name: name.clone(),
                        force: index,
                    });
                    name
                }
            };
            users.paths.push(format!("{name}::{ADAPTER}"));
        }
        users
    }

    /// The path of the adapter that a force calls.
    pub(crate) fn path(&self, force: u16) -> &str {
        self.paths
            .get(usize::from(force))
            .map_or(ADAPTER, String::as_str)
    }

    /// The text of the modules. `curves` are the names of the constants of the model's curves.
    pub(crate) fn text(&self, model: &Model, curves: &[String]) -> String {
        let mut text = String::new();
        for module in &self.modules {
            if let ForceKind::User(user) = ForceKind::of(&model.forces[module.force]) {
                let interface = Interface { user, curves };
                text.push('\n');
                text.push_str(&interface.module(&module.name));
            }
        }
        text
    }
}

/// The user's file as it is pasted into a module, unchanged.
pub(crate) fn pasted(source: &UserSource) -> String {
    let (file, text) = (plain(&source.name), source.text.trim_end());
    format!("// {file}, as its author wrote it\n\n{text}\n\n// end of {file}\n")
}

/// A Rust file for the user to begin with: the function of a user force that uses all its arguments, and returns zeros.
/// `None` if there is no such force.
pub fn skeleton(model: &Model, force: &str) -> Option<String> {
    let user = model.forces.iter().find_map(|f| match ForceKind::of(f) {
        ForceKind::User(user) if f.name == force => Some(user),
        _ => None,
    })?;
    let interface = Interface { user, curves: &[] };
    Some(interface.skeleton(&model.name, force))
}

/// The functions of the user forces of a model, as text that is compiled by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Apart {
    /// The modules of the functions, with the curves that they look up.
    pub text: String,
    /// The functions, one for each module.
    pub functions: Vec<Adapter>,
    /// For each force of the model, the index of its function; `None` for forces of other kinds.
    pub forces: Vec<Option<usize>>,
}

/// A function of the user's that takes and returns scalars: `fn<T: Real>([T; ARGUMENTS]) -> [T; RESULTS]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// The path of the function in the text.
    pub path: String,
    /// Number of arguments.
    pub arguments: usize,
    /// Number of results.
    pub results: usize,
}

/// The functions of the user forces of a model, as text that is compiled by itself; `None` if the model has no user
/// forces.
pub fn apart(model: &Model) -> Option<Apart> {
    let library = Library::new(model);
    let users = library.user_modules();
    if users.modules.is_empty() {
        return None;
    }
    let mut calls = Calls::default();
    calls.add_user(model);
    let uses = calls.uses_of_curves(model);
    let curves = calls
        .curves
        .iter()
        .map(|&curve| library.constant(model, curve));
    let constants: File = parse_quote! {
        #uses
        #(#curves)*
    };
    let mut functions = Vec::new();
    for module in &users.modules {
        let ForceKind::User(user) = ForceKind::of(&model.forces[module.force]) else {
            continue;
        };
        let interface = Interface { user, curves: &[] };
        let (arguments, results) = interface.lengths();
        functions.push(Adapter {
            path: format!("{}::{ADAPTER}", module.name),
            arguments,
            results,
        });
    }
    let forces = users.paths.iter().map(|path| {
        let mut paths = functions.iter();
        paths.position(|function| function.path == *path)
    });
    Some(Apart {
        text: prettyplease::unparse(&constants) + &library.users(model),
        forces: forces.collect(),
        functions,
    })
}

/// True if two forces call the same function with the same names of ports.
fn alike(a: &User, b: &User) -> bool {
    fn names<T>(a: &[Port<T>], b: &[Port<T>]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.name == b.name)
    }
    let curve = |user: &User| -> Vec<Option<usize>> {
        let curves = user.function.curves.iter();
        curves
            .map(|port| port.value.as_ref().map(|scaled| scaled.curve))
            .collect()
    };
    let turns = |user: &User| -> Vec<bool> {
        let freedoms = user.freedoms.iter();
        freedoms.map(|port| port.value.turns).collect()
    };
    a.function.name == b.function.name
        && a.function.source == b.function.source
        && a.dimension == b.dimension
        && names(&a.points, &b.points)
        && names(&a.bodies, &b.bodies)
        && names(&a.lines, &b.lines)
        && names(&a.joints, &b.joints)
        && names(&a.freedoms, &b.freedoms)
        && turns(a) == turns(b)
        && names(&a.function.parameters, &b.function.parameters)
        && names(&a.function.curves, &b.function.curves)
        && names(&a.states, &b.states)
        && curve(a) == curve(b)
}

/// Writes the arguments and results of a user's function.
struct Interface<'a> {
    user: &'a User,
    curves: &'a [String],
}

/// One kind of port, such as points: the struct `Points` has a field of type `Point` for each port.
struct PortKind {
    /// Name of the field of `Input` and `Output`.
    field: &'static str,
    all: &'static str,
    one: &'static str,
    /// A description of these ports.
    text: &'static str,
    names: Vec<String>,
    /// Fields of the struct of one port: name, type, description.
    given: Vec<(&'static str, Shape, String)>,
    returned: (&'static str, Shape, String),
}

/// The type of a field.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    Scalar,
    Vector(usize),
    Matrix,
}

impl Shape {
    fn of(self) -> TokenStream {
        match self {
            Shape::Scalar => quote!(T),
            Shape::Vector(length) => {
                let length = Literal::usize_unsuffixed(length);
                quote!([T; #length])
            }
            Shape::Matrix => quote!([[T; 3]; 3]),
        }
    }

    /// Number of scalars in a field of this shape.
    fn length(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector(length) => length,
            Shape::Matrix => 9,
        }
    }

    /// The expression of this shape, filled with the next scalars.
    fn from(self, next: &mut dyn FnMut() -> TokenStream) -> TokenStream {
        let mut some = |count: usize| -> TokenStream {
            let entries: Vec<_> = (0..count).map(|_| next()).collect();
            quote!([#(#entries),*])
        };
        match self {
            Shape::Scalar => next(),
            Shape::Vector(length) => some(length),
            Shape::Matrix => {
                let rows: Vec<_> = (0..3).map(|_| some(3)).collect();
                quote!([#(#rows),*])
            }
        }
    }

    fn zero(self) -> TokenStream {
        match self {
            Shape::Scalar => quote!(zero),
            Shape::Vector(length) => {
                let length = Literal::usize_unsuffixed(length);
                quote!([zero; #length])
            }
            Shape::Matrix => quote!([[zero; 3]; 3]),
        }
    }
}

fn names<T>(ports: &[Port<T>]) -> Vec<String> {
    ports.iter().map(|port| snake(&port.name)).collect()
}

impl Interface<'_> {
    fn planar(&self) -> bool {
        self.user.dimension == Dimension::Plane
    }

    // Long: an entry for each kind of port.
    fn kinds(&self) -> Vec<PortKind> {
        let (vector, rotation, axes) = match self.user.dimension {
            Dimension::Plane => (Shape::Vector(2), Shape::Scalar, "[x, z] in absolute axes"),
            Dimension::Space => (
                Shape::Vector(3),
                Shape::Vector(3),
                "[x, y, z] in absolute axes",
            ),
        };
        let (orientation, about, angles) = match self.user.dimension {
            Dimension::Plane => (
                (
                    "angle",
                    Shape::Scalar,
                    "Absolute angle about +y [rad].".to_owned(),
                ),
                "about +y",
                "",
            ),
            Dimension::Space => (
                (
                    "rotation",
                    Shape::Matrix,
                    "Rotation from the local to the absolute frame, by rows.".to_owned(),
                ),
                axes,
                ", by Bryant angle",
            ),
        };
        let user = self.user;
        let kinds = vec![
            PortKind {
                field: "points",
                all: "Points",
                one: "Point",
                text: "Points fixed in bodies.",
                names: names(&user.points),
                given: vec![
                    ("position", vector, format!("Position, {axes} [m].")),
                    ("velocity", vector, format!("Velocity, {axes} [m/s].")),
                ],
                returned: (
                    "force",
                    vector,
                    format!("Force on the body at the point, {axes} [N]."),
                ),
            },
            PortKind {
                field: "bodies",
                all: "Bodies",
                one: "Body",
                text: "Elements.",
                names: names(&user.bodies),
                given: vec![
                    orientation,
                    (
                        "angular_velocity",
                        rotation,
                        format!("Angular velocity, {about} [rad/s]."),
                    ),
                ],
                returned: (
                    "moment",
                    rotation,
                    format!("Moment on the body, {about} [N m]."),
                ),
            },
            PortKind {
                field: "lines",
                all: "Lines",
                one: "Line",
                text: "Straight lines between two points.",
                names: names(&user.lines),
                given: vec![
                    (
                        "length",
                        Shape::Scalar,
                        "Distance of the ends [m].".to_owned(),
                    ),
                    (
                        "rate",
                        Shape::Scalar,
                        "Its rate, positive while it lengthens [m/s].".to_owned(),
                    ),
                ],
                returned: (
                    "tension",
                    Shape::Scalar,
                    "Force that draws the ends together, negative where it pushes [N].".to_owned(),
                ),
            },
            PortKind {
                field: "joints",
                all: "Joints",
                one: "Joint",
                text: "Joints, between an element and the one that carries it.",
                names: names(&user.joints),
                given: vec![
                    (
                        "angle",
                        rotation,
                        format!("Angle relative to what carries the element{angles} [rad]."),
                    ),
                    ("rate", rotation, "Its rate [rad/s].".to_owned()),
                ],
                returned: (
                    "torque",
                    rotation,
                    format!(
                        "Torque on the element{angles} [N m]; what carries it feels the opposite."
                    ),
                ),
            },
            PortKind {
                field: "freedoms",
                all: "Freedoms",
                one: "Freedom",
                text: "Freedoms of joints, in m where they slide and in rad where they turn.",
                names: names(&user.freedoms),
                given: vec![
                    (
                        "coordinate",
                        Shape::Scalar,
                        "Coordinate [m] or [rad].".to_owned(),
                    ),
                    (
                        "rate",
                        Shape::Scalar,
                        "Its rate [m/s] or [rad/s].".to_owned(),
                    ),
                ],
                returned: (
                    "effort",
                    Shape::Scalar,
                    "Force or torque along it, positive where it drives the coordinate up [N] or [N m]."
                        .to_owned(),
                ),
            },
        ];
        kinds
            .into_iter()
            .filter(|kind| !kind.names.is_empty())
            .collect()
    }

    /// The text of the module.
    fn module(&self, name: &str) -> String {
        let mut text = String::new();
        let function = plain(&self.user.function.name);
        let vectors = if self.planar() { "[x, z]" } else { "[x, y, z]" };
        text += &format!(
            "/// The user's function `{function}`: what it is given, and what it returns. SI units, vectors \\{}\\] in absolute axes.\n",
            vectors.trim_end_matches(']')
        );
        if self.user.function.source.is_some() {
            // documentation in the user's text follows
            text += "#[allow(clippy::mixed_attributes_style)]\n";
        }
        text += &format!("pub mod {name} {{\n");
        if let Some(source) = &self.user.function.source {
            text += &pasted(source);
            text += "\n";
        }
        let file: File = {
            let items = self.items();
            parse_quote!(#items)
        };
        for line in super::comment::splice(&prettyplease::unparse(&file)).lines() {
            if !line.is_empty() {
                text += "    ";
                text += line;
            }
            text += "\n";
        }
        text + "}\n"
    }

    fn items(&self) -> TokenStream {
        let glob = self.user.function.source.as_ref().map(|_| {
            quote!(
                #[allow(unused_imports)]
                use bryant_runtime::real::*;
            )
        });
        let (input, output) = (self.input(), self.output());
        let (given, returned) = (self.given(), self.returned());
        let adapter = self.adapter();
        quote! {
            #glob
            #input
            #output
            #adapter
            #given
            #returned
        }
    }

    /// The text of a file for the user to begin with.
    fn skeleton(&self, model: &str, force: &str) -> String {
        let function = self
            .user
            .function
            .name
            .rsplit("::")
            .next()
            .unwrap_or_default();
        let vectors = if self.planar() { "[x, z]" } else { "[x, y, z]" };
        let mut text = format!(
            "// The user force {force} of the model {model}: SI units, vectors {vectors} in absolute axes.\n\n"
        );
        if self.user.function.source.is_none() {
            let module = snake(model);
            let inner = snake(function);
            text += "// the module that `include_model!` is written in\n";
            text += &format!(
                "use crate::{module}::{inner}::{{Input, Output}};\nuse bryant_runtime::Real;\n\n"
            );
        }
        text += "/// (the law as a formula, and where it comes from)\n///\n";
        text += "/// Numbers are `T::from_f64(0.5)`. There is no `if` on a value, because a `T` may be several scenarios side by side:\n";
        text += "/// write `T::select(a.lt(b), then, otherwise)`, `a.max(b)`, `a.min(b)`.\n";
        text += &format!(
            "pub fn {function}<T: Real>(input: &Input<T>) -> Output<T> {{\n    let time = input.time; // [s]\n"
        );
        let mut acts = String::new();
        for kind in self.kinds() {
            for name in &kind.names {
                let given = kind.given.iter();
                let given: Vec<String> = given
                    .map(|(what, shape, _)| format!("{name}.{what}: {}", shape.of()))
                    .collect();
                let given = given.join(", ").replace(" ; ", "; ");
                let field = kind.field;
                text += &format!("    let {name} = input.{field}.{name}; // {given}\n");
                let (what, shape, meaning) = &kind.returned;
                let zero = match shape {
                    Shape::Vector(length) => format!("[T::from_f64(0.0); {length}]"),
                    _ => "T::from_f64(0.0)".to_owned(),
                };
                acts += &format!("    // {meaning}\n    output.{field}.{name}.{what} = {zero};\n");
            }
        }
        for port in &self.user.function.parameters {
            let name = snake(&port.name);
            let unit = match port.value.unit.as_str() {
                "" => String::new(),
                unit => format!(" // [{}]", plain(unit)),
            };
            text += &format!("    let {name} = input.parameters.{name};{unit}\n");
        }
        for name in names(&self.user.function.curves) {
            text += &format!("    let {name} = input.curves.{name}(time); // at any argument\n");
        }
        for name in names(&self.user.states) {
            text += &format!("    let {name} = input.states.{name};\n");
            acts += &format!(
                "    // Its rate, per second.\n    output.states.{name}.rate = T::from_f64(0.0);\n"
            );
        }
        text += "\n    let mut output = Output::zero();\n";
        text + &acts + "    output\n}\n"
    }

    /// The struct `Input`.
    fn input(&self) -> TokenStream {
        let mut fields = vec![field("time", quote!(T), "Time [s].")];
        for kind in self.kinds() {
            let of: Path = path("input", kind.all);
            fields.push(field(kind.field, quote!(#of<T>), kind.text));
        }
        for (name, of, text, used) in [
            (
                "parameters",
                "Parameters",
                "Numbers, and curves of time at this time.",
                !self.user.function.parameters.is_empty(),
            ),
            (
                "curves",
                "Curves",
                "Curves: each a function of one number.",
                !self.user.function.curves.is_empty(),
            ),
            (
                "states",
                "States",
                "State variables.",
                !self.user.states.is_empty(),
            ),
        ] {
            if used {
                let of = path("input", of);
                fields.push(field(name, quote!(#of<T>), text));
            }
        }
        structure("Input", "What the function is given.", &fields)
    }

    /// The struct `Output`, with its function `zero`.
    fn output(&self) -> TokenStream {
        let (mut fields, mut zeros) = (Vec::new(), Vec::new());
        for kind in self.kinds() {
            let (all, one) = (path("output", kind.all), path("output", kind.one));
            fields.push(field(kind.field, quote!(#all<T>), kind.text));
            let (name, (what, shape, _)) = (ident(kind.field), &kind.returned);
            let (what, zero) = (ident(what), shape.zero());
            let ports = kind.names.iter().map(|name| ident(name));
            zeros.push(quote!(#name: #all { #(#ports: #one { #what: #zero }),* }));
        }
        if !self.user.states.is_empty() {
            let (all, one) = (path("output", "States"), path("output", "State"));
            fields.push(field("states", quote!(#all<T>), "State variables."));
            let states = names(&self.user.states);
            let states = states.iter().map(|name| ident(name));
            zeros.push(quote!(states: #all { #(#states: #one { rate: zero }),* }));
        }
        let output = structure("Output", "What the function returns.", &fields);
        quote! {
            #output

            impl<T: bryant_runtime::Real> Output<T> {
                /// No force, no moment, no tension, no torque, no rate.
                #[must_use]
                pub fn zero() -> Self {
                    let zero = T::from_f64(0.0);
                    Self { #(#zeros),* }
                }
            }
        }
    }

    /// The module `input`, with the structs of the ports.
    fn given(&self) -> TokenStream {
        let mut items = TokenStream::new();
        for kind in self.kinds() {
            items.extend(kind.all_of());
            let fields = kind.given.iter();
            let fields: Vec<_> = fields
                .map(|(name, shape, text)| field(name, shape.of(), text))
                .collect();
            items.extend(structure(kind.one, "What is known of one.", &fields));
        }
        let user = self.user;
        if !user.function.parameters.is_empty() {
            let fields: Vec<_> = user
                .function
                .parameters
                .iter()
                .map(|port| {
                    let unit = match port.value.unit.as_str() {
                        "" => String::new(),
                        unit => format!(" [{}]", plain(unit)),
                    };
                    let text = format!("{}{unit}.", plain(&port.name));
                    field(&snake(&port.name), quote!(T), &text)
                })
                .collect();
            items.extend(structure("Parameters", "Parameters.", &fields));
        }
        if !user.function.curves.is_empty() {
            items.extend(self.curves());
        }
        if !user.states.is_empty() {
            let fields = user.states.iter().map(|port| {
                let unit = match port.value.unit {
                    "" => String::new(),
                    unit => format!(" [{unit}]"),
                };
                let text = format!("{}{unit}.", plain(&port.name));
                field(&snake(&port.name), quote!(T), &text)
            });
            let fields: Vec<_> = fields.collect();
            items.extend(structure("States", "Values of the states.", &fields));
        }
        quote! {
            /// What the input is made of.
            pub mod input { #items }
        }
    }

    /// The struct of the curves. Each field is the factor of a curve.
    fn curves(&self) -> TokenStream {
        let (mut fields, mut methods) = (Vec::new(), Vec::new());
        for port in &self.user.function.curves {
            let name = snake(&port.name);
            let text = format!("Scale of the curve {}.", plain(&port.name));
            fields.push(field(&name, quote!(Scale<T>), &text));
            let (name, text) = (
                ident(&name),
                format!(" The curve {} at `x`.", plain(&port.name)),
            );
            let constant = port.value.as_ref().and_then(|c| self.curves.get(c.curve));
            methods.push(match constant {
                Some(constant) => {
                    let constant = ident(constant);
                    quote! {
                        #[doc = #text]
                        #[inline(always)]
                        pub fn #name(&self, x: T) -> T {
                            self.#name.times * super::super::#constant.value(x / self.#name.stretch)
                        }
                    }
                }
                None => quote! {
                    #[doc = #text]
                    #[inline(always)]
                    pub fn #name(&self, _x: T) -> T {
                        self.#name.times
                    }
                },
            });
        }
        let curves = structure("Curves", "Curves, to be looked up.", &fields);
        let scale = structure(
            "Scale",
            "Factors on the ordinate and on the abscissa of a curve.",
            &[
                field("times", quote!(T), "On the ordinate."),
                field("stretch", quote!(T), "On the abscissa."),
            ],
        );
        quote! {
            #curves
            #scale
            impl<T: bryant_runtime::Real> Curves<T> { #(#methods)* }
        }
    }

    /// The module `output`, with the structs of the ports.
    fn returned(&self) -> TokenStream {
        let mut items = TokenStream::new();
        for kind in self.kinds() {
            items.extend(kind.all_of());
            let (name, shape, text) = &kind.returned;
            let fields = [field(name, shape.of(), text)];
            items.extend(structure(kind.one, "What acts on one.", &fields));
        }
        if !self.user.states.is_empty() {
            let fields = self.user.states.iter().map(|port| {
                let text = format!("{}.", plain(&port.name));
                field(&snake(&port.name), quote!(State<T>), &text)
            });
            let fields: Vec<_> = fields.collect();
            items.extend(structure("States", "Rates of the states.", &fields));
            let rate = [field(
                "rate",
                quote!(T),
                "Rate, in the unit of the state per second.",
            )];
            items.extend(structure("State", "Of one state.", &rate));
        }
        quote! {
            /// What the output is made of.
            pub mod output { #items }
        }
    }

    /// Number of arguments of the adapter, and number of its results.
    fn lengths(&self) -> (usize, usize) {
        let function = &self.user.function;
        let states = self.user.states.len();
        let mut arguments = 1 + states + function.parameters.len() + 2 * function.curves.len();
        let mut results = states;
        for kind in self.kinds() {
            let one: usize = kind.given.iter().map(|(_, shape, _)| shape.length()).sum();
            arguments += kind.names.len() * one;
            results += kind.names.len() * kind.returned.1.length();
        }
        (arguments, results)
    }

    /// The adapter: it makes `Input` from scalars, calls the user's function, and returns the scalars of `Output`.
    // Long: a part for each kind of argument and of result, in one order.
    fn adapter(&self) -> TokenStream {
        let mut count = 0;
        let mut next = || {
            let index = Literal::usize_unsuffixed(count);
            count += 1;
            quote!(a[#index])
        };
        let user = self.user;
        let time = next();
        let mut structs = vec![quote!(time: #time)];
        let group = |all: &str, names: &[String], next: &mut dyn FnMut() -> TokenStream| {
            let all = path("input", all);
            let fields = names.iter().map(|name| {
                let (name, value) = (ident(name), next());
                quote!(#name: #value)
            });
            let fields: Vec<_> = fields.collect();
            quote!(#all { #(#fields),* })
        };
        if !user.states.is_empty() {
            let states = group("States", &names(&user.states), &mut next);
            structs.push(quote!(states: #states));
        }
        for kind in self.kinds() {
            let (name, all, one) = (
                ident(kind.field),
                path("input", kind.all),
                path("input", kind.one),
            );
            let mut ports = Vec::new();
            for port in &kind.names {
                let fields = kind.given.iter().map(|(name, shape, _)| {
                    let (name, value) = (ident(name), shape.from(&mut next));
                    quote!(#name: #value)
                });
                let (port, fields): (_, Vec<_>) = (ident(port), fields.collect());
                ports.push(quote!(#port: #one { #(#fields),* }));
            }
            structs.push(quote!(#name: #all { #(#ports),* }));
        }
        if !user.function.parameters.is_empty() {
            let parameters = group("Parameters", &names(&user.function.parameters), &mut next);
            structs.push(quote!(parameters: #parameters));
        }
        if !user.function.curves.is_empty() {
            let scale = path("input", "Scale");
            let mut next = || {
                let (times, stretch) = (next(), next());
                quote!(#scale { times: #times, stretch: #stretch })
            };
            let curves = group("Curves", &names(&user.function.curves), &mut next);
            structs.push(quote!(curves: #curves));
        }

        let mut results = Vec::new();
        for kind in self.kinds() {
            let (field, (what, shape, _)) = (ident(kind.field), &kind.returned);
            let what = ident(what);
            for port in kind.names.iter().map(|name| ident(name)) {
                let value = quote!(output.#field.#port.#what);
                match shape {
                    Shape::Vector(length) => results.extend((0..*length).map(|i| {
                        let i = Literal::usize_unsuffixed(i);
                        quote!(#value[#i])
                    })),
                    _ => results.push(value),
                }
            }
        }
        for state in names(&user.states) {
            let state = ident(&state);
            results.push(quote!(output.states.#state.rate));
        }
        let function: Path = match &user.function.source {
            Some(_) => {
                let function = ident(&user.function.name);
                parse_quote!(self::#function)
            }
            None => super::syntax::path(&user.function.name),
        };
        debug_assert_eq!((count, results.len()), self.lengths());
        let (given, returned) = (
            Literal::usize_unsuffixed(count),
            Literal::usize_unsuffixed(results.len()),
        );
        let adapter = ident(ADAPTER);
        quote! {
            /// Scalars of the equations in, scalars out.
            #[allow(dead_code)]
            #[inline(always)]
            pub fn #adapter<T: bryant_runtime::Real>(a: [T; #given]) -> [T; #returned] {
                let input = Input { #(#structs),* };
                let output: Output<T> = #function(&input);
                [#(#results),*]
            }
        }
    }
}

impl PortKind {
    /// The struct with a field for each port of this kind.
    fn all_of(&self) -> TokenStream {
        let one = ident(self.one);
        let fields = self.names.iter().map(|name| {
            let text = format!("`{name}` of the model.");
            field(name, quote!(#one<T>), &text)
        });
        structure(self.all, self.text, &fields.collect::<Vec<_>>())
    }
}

fn path(module: &str, name: &str) -> Path {
    super::syntax::path(&format!("{module}::{name}"))
}

fn field(name: &str, of: TokenStream, text: &str) -> TokenStream {
    let (name, text) = (ident(name), documented(text));
    quote!(#[doc = #text] pub #name: #of)
}

/// A documentation text with its square brackets escaped, so that they are no links.
fn documented(text: &str) -> String {
    format!(" {}", text.replace('[', "\\[").replace(']', "\\]"))
}

fn structure(name: &str, text: &str, fields: &[TokenStream]) -> TokenStream {
    let (name, text) = (ident(name), documented(text));
    quote! {
        #[doc = #text]
        #[allow(dead_code)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name<T> { #(#fields),* }
    }
}
