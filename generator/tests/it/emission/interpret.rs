//! Evaluates the emitted text without a compiler. It reads the Rust text itself, so a missing bracket is an error.

use quote::ToTokens;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use syn::{Expr, ImplItem, ImplItemFn, Item, Lit, Pat, Stmt, UnOp};

/// The functions that the text calls outside of itself: "WEBBING.value", "force::power::power".
pub type Library<'a> = &'a dyn Fn(&str, &[f64]) -> f64;

/// A value of the interpreted text.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A scalar or an integer.
    Number(f64),
    /// An array or a tuple.
    List(Vec<Value>),
    /// A struct by its fields.
    Struct(BTreeMap<String, Value>),
    /// The output writer: numbers by their index, each written once.
    OutputWriter(Rc<RefCell<BTreeMap<usize, f64>>>),
    /// An output writer with an offset: its index 0 is a later index of the other.
    TailView(Rc<RefCell<BTreeMap<usize, f64>>>, usize),
}

impl Value {
    pub fn numbers(values: &[f64]) -> Value {
        Value::List(values.iter().map(|&value| Value::Number(value)).collect())
    }

    pub fn number(&self) -> f64 {
        match self {
            Value::Number(value) => *value,
            other => panic!("{other:?} is no number"),
        }
    }

    pub fn list(&self) -> &[Value] {
        match self {
            Value::List(values) => values,
            other => panic!("{other:?} is no list"),
        }
    }

    pub fn flat(&self) -> Vec<f64> {
        match self {
            Value::Number(value) => vec![*value],
            Value::List(values) => values.iter().flat_map(Value::flat).collect(),
            Value::Struct(fields) => fields.values().flat_map(Value::flat).collect(),
            Value::OutputWriter(found) => {
                let found = found.borrow();
                assert!(found.keys().copied().eq(0..found.len()), "one is missing");
                found.values().copied().collect()
            }
            Value::TailView(..) => panic!("a part of a writer is no list"),
        }
    }

    fn field(&self, name: &str) -> Value {
        match self {
            Value::Struct(fields) => fields[name].clone(),
            other => panic!("{other:?} has no field {name}"),
        }
    }
}

/// A module that can be called.
pub struct Module<'a> {
    methods: HashMap<String, ImplItemFn>,
    /// The constants of lengths, such as `const COORDINATES: usize = 4;`.
    lengths: HashMap<String, usize>,
    library: Library<'a>,
}

type Scope = HashMap<String, Value>;

impl<'a> Module<'a> {
    pub fn new(text: &str, library: Library<'a>) -> Self {
        let file = syn::parse_file(text).expect("the emitted text is Rust");
        let (mut methods, mut lengths) = (HashMap::new(), HashMap::new());
        for item in file.items {
            if let Item::Const(constant) = &item
                && let Expr::Lit(literal) = &*constant.expr
                && let Lit::Int(length) = &literal.lit
            {
                let length = length.base10_parse().expect("a length");
                lengths.insert(constant.ident.to_string(), length);
            }
            let Item::Impl(item) = item else { continue };
            if item.trait_.is_some() {
                continue;
            }
            for item in item.items {
                if let ImplItem::Fn(method) = item {
                    methods.insert(method.sig.ident.to_string(), method);
                }
            }
        }
        Self {
            methods,
            lengths,
            library,
        }
    }

    /// The constant that is the last argument in `Function::<_, LENGTH>`.
    fn length(&self, function: &Expr) -> usize {
        let Expr::Path(path) = function else {
            panic!("{} is no path", function.to_token_stream())
        };
        let last = path.path.segments.last().map(|segment| &segment.arguments);
        let Some(syn::PathArguments::AngleBracketed(arguments)) = last else {
            panic!("{} has no arguments", function.to_token_stream())
        };
        let length = arguments.args.last().to_token_stream().to_string();
        self.lengths[&length]
    }

    /// Number of statements of the longest method.
    pub fn longest(&self) -> usize {
        self.methods
            .values()
            .map(|method| method.block.stmts.len())
            .max()
            .unwrap_or(0)
    }

    pub fn methods(&self) -> usize {
        self.methods.len()
    }

    /// A method with its receiver first, if it has one.
    pub fn call(&self, name: &str, arguments: &[Value]) -> Value {
        let method = &self.methods[name];
        let mut scope = Scope::new();
        assert_eq!(
            arguments.len(),
            method.sig.inputs.len(),
            "arguments of {name}"
        );
        for (input, value) in method.sig.inputs.iter().zip(arguments) {
            match input {
                syn::FnArg::Receiver(_) => drop(scope.insert("self".into(), value.clone())),
                syn::FnArg::Typed(typed) => bind(&typed.pat, value, &mut scope),
            }
        }
        let mut result = None;
        for statement in &method.block.stmts {
            match statement {
                Stmt::Local(local) => {
                    let init = local.init.as_ref().expect("a value");
                    // `let num = T::from_f64;` needs no evaluation.
                    if matches!(&*init.expr, Expr::Path(path) if path.path.segments.len() == 2) {
                        continue;
                    }
                    let value = self.eval(&init.expr, &scope);
                    bind(&local.pat, &value, &mut scope);
                }
                Stmt::Expr(Expr::Assign(assign), Some(_)) => self.assign(assign, &mut scope),
                // the end of a method that writes everything into an output writer
                Stmt::Expr(Expr::MethodCall(call), Some(_)) => drop(self.method(call, &scope)),
                Stmt::Expr(expression, None) => {
                    result = Some(match self.eval(expression, &scope) {
                        full @ Value::OutputWriter(_) => Value::numbers(&full.flat()),
                        other => other,
                    });
                }
                other => panic!("statement {}", other.to_token_stream()),
            }
        }
        let returns = matches!(method.sig.output, syn::ReturnType::Type(..));
        result.unwrap_or_else(|| {
            assert!(!returns, "{name}: a result");
            Value::List(Vec::new())
        })
    }

    /// `s[(i, j)] = x;`
    fn assign(&self, assign: &syn::ExprAssign, scope: &mut Scope) {
        let Expr::Index(index) = &*assign.left else {
            panic!("assignment to an entry")
        };
        let value = self.eval(&assign.right, scope).number();
        let place = self.eval(&index.index, scope).flat();
        let Some(Value::Struct(matrix)) = scope.get_mut(&path(&index.expr)) else {
            panic!("a matrix")
        };
        matrix.insert(format!("{},{}", place[0], place[1]), Value::Number(value));
    }

    fn all<'e>(
        &self,
        expressions: impl IntoIterator<Item = &'e Expr>,
        scope: &Scope,
    ) -> Vec<Value> {
        expressions
            .into_iter()
            .map(|expression| self.eval(expression, scope))
            .collect()
    }

    fn eval(&self, expression: &Expr, scope: &Scope) -> Value {
        let number = |expression: &Expr| self.eval(expression, scope).number();
        match expression {
            Expr::Path(_) => scope[&path(expression)].clone(),
            Expr::Paren(inner) => self.eval(&inner.expr, scope),
            Expr::Reference(inner) => self.eval(&inner.expr, scope),
            Expr::Unary(inner) => match inner.op {
                UnOp::Deref(_) => self.eval(&inner.expr, scope),
                _ => Value::Number(-number(&inner.expr)),
            },
            Expr::Lit(literal) => Value::Number(match &literal.lit {
                Lit::Float(float) => float.base10_parse().expect("a number"),
                Lit::Int(int) => int.base10_parse::<u32>().expect("an index").into(),
                other => panic!("literal {}", other.to_token_stream()),
            }),
            Expr::Field(field) => match &field.member {
                syn::Member::Named(name) => self.eval(&field.base, scope).field(&name.to_string()),
                syn::Member::Unnamed(index) => {
                    self.eval(&field.base, scope).list()[index.index as usize].clone()
                }
            },
            Expr::Binary(binary) => {
                let (a, b) = (number(&binary.left), number(&binary.right));
                Value::Number(match binary.op {
                    syn::BinOp::Add(_) => a + b,
                    syn::BinOp::Sub(_) => a - b,
                    syn::BinOp::Mul(_) => a * b,
                    syn::BinOp::Div(_) => a / b,
                    ref other => panic!("operator {}", other.to_token_stream()),
                })
            }
            Expr::Repeat(_) => Value::OutputWriter(Rc::default()),
            Expr::Array(array) => Value::List(self.all(&array.elems, scope)),
            Expr::Tuple(tuple) => Value::List(self.all(&tuple.elems, scope)),
            Expr::Struct(literal) => {
                let fields = literal.fields.iter().map(|field| {
                    let syn::Member::Named(name) = &field.member else {
                        panic!("a field with a name")
                    };
                    (name.to_string(), self.eval(&field.expr, scope))
                });
                Value::Struct(fields.collect())
            }
            Expr::Index(index) => {
                let at = number(&index.index) as usize;
                self.eval(&index.expr, scope).list()[at].clone()
            }
            Expr::Call(call) => match &path(&call.func)[..] {
                "bryant_runtime::TailView" => match self.eval(&call.args[0], scope) {
                    Value::OutputWriter(found) => Value::TailView(found, self.length(&call.func)),
                    other => panic!("{other:?} is no writer"),
                },
                name => self.function(name, self.all(&call.args, scope)),
            },
            Expr::MethodCall(call) => self.method(call, scope),
            other => panic!("expression {}", other.to_token_stream()),
        }
    }

    fn function(&self, name: &str, arguments: Vec<Value>) -> Value {
        match name {
            "num" | "SVector::from" | "SMatrix::from" => arguments[0].clone(),
            "SMatrix::from_element" => Value::Struct(BTreeMap::new()),
            _ => match name.strip_prefix("Self::") {
                Some(method) => self.call(method, &arguments),
                None => match results(name) {
                    Some(count) => {
                        let part = |i| (self.library)(&format!("{name} {i}"), &numbers(&arguments));
                        Value::numbers(&(0..count).map(part).collect::<Vec<f64>>())
                    }
                    None => Value::Number((self.library)(name, &numbers(&arguments))),
                },
            },
        }
    }

    fn method(&self, call: &syn::ExprMethodCall, scope: &Scope) -> Value {
        let (name, mut arguments) = (call.method.to_string(), self.all(&call.args, scope));
        if let Expr::Path(_) = &*call.receiver {
            let receiver = path(&call.receiver);
            if receiver == "self" {
                arguments.insert(0, scope["self"].clone());
                return self.call(&name, &arguments);
            }
            if !scope.contains_key(&receiver) {
                return Value::Number((self.library)(
                    &format!("{receiver}.{name}"),
                    &numbers(&arguments),
                ));
            }
        }
        let receiver = self.eval(&call.receiver, scope);
        let taken = match &receiver {
            Value::OutputWriter(found) => Some((found, 0)),
            Value::TailView(found, from) => Some((found, *from)),
            _ => None,
        };
        if let (Some((found, from)), "put") = (taken, name.as_str()) {
            let place = arguments[0].number() as usize;
            let Some(place) = place.checked_sub(from) else {
                return Value::List(Vec::new());
            };
            let before = found.borrow_mut().insert(place, arguments[1].number());
            assert_eq!(before, None, "{place} a second time");
            return Value::List(Vec::new());
        }
        let x = receiver.number();
        let of = |i: usize| arguments[i].number();
        Value::Number(match name.as_str() {
            "mul_add" => x.mul_add(of(0), of(1)),
            "sqrt" => x.sqrt(),
            "atan2" => x.atan2(of(0)),
            "max" => x.max(of(0)),
            "min" => x.min(of(0)),
            "sin_cos" => return Value::numbers(&[x.sin(), x.cos()]),
            other => panic!("method {other}"),
        })
    }
}

/// The number of results of a function with several results.
fn results(name: &str) -> Option<usize> {
    match name {
        "force::ellipsoid::support" => Some(4),
        "force::approach::plane::approach" | "force::approach::plane::touch" => Some(5),
        "force::approach::space::approach" | "force::approach::space::touch" => Some(7),
        _ => None,
    }
}

fn numbers(values: &[Value]) -> Vec<f64> {
    values.iter().map(Value::number).collect()
}

fn path(expression: &Expr) -> String {
    let Expr::Path(path) = expression else {
        panic!("{} is no path", expression.to_token_stream())
    };
    let names: Vec<String> = path
        .path
        .segments
        .iter()
        .map(|segment| segment.ident.to_string())
        .collect();
    names.join("::")
}

/// Binds the names of a pattern.
fn bind(pattern: &Pat, value: &Value, scope: &mut Scope) {
    match pattern {
        Pat::Ident(name) => drop(scope.insert(name.ident.to_string(), value.clone())),
        Pat::Wild(_) => {}
        Pat::Reference(inner) => bind(&inner.pat, value, scope),
        Pat::Tuple(tuple) => bind_list(tuple.elems.iter().collect(), value, scope),
        Pat::Slice(slice) => bind_list(slice.elems.iter().collect(), value, scope),
        Pat::Struct(fields) => {
            for field in &fields.fields {
                let syn::Member::Named(name) = &field.member else {
                    panic!("a field with a name")
                };
                bind(&field.pat, &value.field(&name.to_string()), scope);
            }
        }
        other => panic!("pattern {}", other.to_token_stream()),
    }
}

fn bind_list(patterns: Vec<&Pat>, value: &Value, scope: &mut Scope) {
    let values = value.list();
    let rest = patterns
        .iter()
        .position(|pattern| matches!(pattern, Pat::Rest(_)));
    let after = patterns.len() - rest.map_or(patterns.len(), |rest| rest + 1);
    assert!(
        patterns.len() - usize::from(rest.is_some()) <= values.len(),
        "a pattern that is too long"
    );
    if rest.is_none() {
        assert_eq!(
            patterns.len(),
            values.len(),
            "a pattern without `..` has the length of the array"
        );
    }
    for (i, pattern) in patterns.iter().enumerate() {
        match rest {
            Some(rest) if i == rest => {}
            Some(rest) if i > rest => bind(
                pattern,
                &values[values.len() - after + (i - rest - 1)],
                scope,
            ),
            _ => bind(pattern, &values[i], scope),
        }
    }
}
