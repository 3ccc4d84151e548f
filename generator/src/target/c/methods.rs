//! The functions of a model: their declarations for the header, their definitions for the source.

use super::body::{Body, body};
use super::support::Support;
use super::{comment, number};
use crate::model::Rule;
use crate::program::{self, Lists, Method, Start};
use std::fmt::Write as _;

/// A function that the header declares.
pub(super) struct Function {
    /// A comment that says what the function does. It ends in a newline.
    pub about: String,
    /// The declaration without a semicolon.
    pub head: String,
    /// Functions that only this function calls. They stand before it; `body` is the body of this function with braces.
    pub before: String,
    pub body: String,
}

impl Function {
    /// True if the text of the function contains this word.
    pub fn mentions(&self, word: &str) -> bool {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        [&self.before, &self.body].iter().any(|text| {
            let mut found = text.match_indices(word);
            found.any(|(at, _)| !text[at + word.len()..].starts_with(is_word))
        })
    }
}

/// Writes the C functions of one model.
pub(super) struct Methods<'a> {
    pub lists: &'a Lists,
    /// The prefix of all names.
    pub name: &'a str,
    pub support: &'a mut Support,
}

impl Methods<'_> {
    /// All functions, in the order in which the header declares them.
    pub fn all(&mut self) -> Vec<Function> {
        let mut functions = vec![self.new_model()];
        for method in Method::ALL {
            match method {
                Method::InitialState => functions.push(self.initial_state()),
                Method::KineticEnergy => functions.extend(self.kinetic_energy()),
                Method::MassMatrix => functions.extend(self.mass_matrix()),
                Method::Renewed => functions.extend(self.renew()),
                Method::Pivots => functions.extend(self.smallest_pivot()),
                Method::Conditions => functions.extend(self.violated()),
                Method::KinkRates => functions.push(self.kink_after()),
                Method::Derived => {}
                _ => functions.extend(self.plain(method)),
            }
        }
        functions.push(self.normalize());
        for function in &self.lists.functions {
            let method = Method::named(&function.identifier);
            if !method.is_some_and(|method| self.exists(method)) {
                functions.push(self.function(function));
            }
        }
        functions
    }

    /// A function that was asked for.
    fn function(&mut self, function: &program::Function) -> Function {
        let (name, short) = (self.name, &function.identifier);
        let curve = |index: u32| format!("{name}_curve_{index}");
        let statements = body(&function.list, &curve, self.support);
        let given = match function.accelerations {
            true => ", const double accelerations[]",
            false => "",
        };
        let mut silent = silent(&statements, Start::State);
        if function.accelerations && !statements.uses_accelerations {
            silent.push_str("    (void)accelerations;\n");
        }
        if function.list.results.is_empty() {
            silent.push_str("    (void)results;\n");
        }
        let shape = match (function.rows.len(), function.columns.len()) {
            (1, 1) => "One number.".to_owned(),
            (rows, 1) => format!("{rows} numbers."),
            (rows, columns) => format!("{rows} rows of {columns} numbers."),
        };
        Function {
            about: comment_of(&comment(&format!(
                "{}: {} {shape}",
                function.name, function.sentence
            ))),
            head: format!(
                "void {name}_{short}(const {name}_model *m, double t, const double y[]{given}, double results[])"
            ),
            before: String::new(),
            body: format!("{{\n{}{silent}}}\n", statements.text),
        }
    }

    fn exists(&self, method: Method) -> bool {
        !self.lists.list(method).results.is_empty()
    }

    fn body(&mut self, method: Method) -> Body {
        let name = self.name;
        let curve = |index: u32| format!("{name}_curve_{index}");
        body(self.lists.list(method), &curve, self.support)
    }

    /// Writes the statements of a method as a static function `NAME_…_at`, for methods that need more than these
    /// statements. Returns this function, and a call of it at (m, t, y) that writes the results to `results`.
    fn inner(&mut self, method: Method, short: &str, results: &str) -> [String; 2] {
        let (name, upper) = (self.name, self.name.to_ascii_uppercase());
        let start = self.lists.routine(method).start;
        let statements = self.body(method);
        let (more, before, given) = match start {
            Start::State => ("", String::new(), String::new()),
            Start::Accelerations => (
                ", const double accelerations[]",
                format!("    double rate[{upper}_STATE];\n    {name}_derivative(m, t, y, rate);\n"),
                format!(", rate + {upper}_COORDINATES"),
            ),
            Start::EventFunctions => (
                ", const double event_functions[]",
                format!(
                    "    double event_functions[{upper}_EVENT_FUNCTIONS];\n    {name}_event_functions(m, t, y, event_functions);\n"
                ),
                ", event_functions".to_owned(),
            ),
        };
        let silent = silent(&statements, start);
        let text = &statements.text;
        let function = format!(
            "static void {name}_{short}_at(const {name}_model *m, double t, const double y[]{more}, double results[])\n{{\n{text}{silent}}}\n\n"
        );
        let call = format!("{before}    {name}_{short}_at(m, t, y{given}, {results});\n");
        [function, call]
    }

    fn new_model(&mut self) -> Function {
        let name = self.name;
        let parameters = &self.lists.facts.parameters;
        let mut text = String::from("{\n");
        if !parameters.is_empty() {
            let defaults: Vec<String> = parameters.iter().map(|p| number(p.default)).collect();
            let defaults = defaults.join(", ");
            let count = parameters.len();
            let _ = write!(
                text,
                "    static const double defaults[{count}] = {{{defaults}}};\n    int i;\n    for (i = 0; i < {count}; i++)\n        \
                 m->parameters[i] = parameters ? parameters[i] : defaults[i];\n"
            );
        } else {
            text.push_str("    (void)parameters;\n");
        }
        let mut before = String::new();
        if self.exists(Method::Derived) {
            let statements = self.body(Method::Derived);
            let silent = if statements.uses_model {
                ""
            } else {
                "    (void)m;\n"
            };
            before = format!(
                "static void {name}_derive(const {name}_model *m, double results[])\n{{\n{}{silent}}}\n\n",
                statements.text
            );
            let _ = writeln!(text, "    {name}_derive(m, m->derived);");
        } else if parameters.is_empty() {
            text.push_str("    m->nothing = 0;\n");
        }
        text.push_str("}\n");
        Function {
            about: comment_of(
                "Makes a model with these parameters, in SI units, or with the defaults where `parameters` is NULL.",
            ),
            head: format!("void {name}_new({name}_model *m, const double *parameters)"),
            before,
            body: text,
        }
    }

    fn initial_state(&mut self) -> Function {
        let name = self.name;
        let statements = self.body(Method::InitialState);
        let silent = if statements.uses_model {
            ""
        } else {
            "    (void)m;\n"
        };
        Function {
            about: comment_of(Method::InitialState.sentence()),
            head: format!("void {name}_initial_state(const {name}_model *m, double y[])"),
            before: String::new(),
            body: format!(
                "{{\n    double *const results = y;\n{}{silent}}}\n",
                statements.text
            ),
        }
    }

    /// A method whose results are written to an array unchanged.
    fn plain(&mut self, method: Method) -> Option<Function> {
        if !self.exists(method) {
            return None;
        }
        let (name, short) = (self.name, method.name());
        let [function, call] = self.inner(method, short, short);
        let time = match method {
            Method::CoordinateRates => "",
            _ => "double t, ",
        };
        let mut text = String::from("{\n");
        if time.is_empty() {
            text.push_str("    const double t = 0.0;\n");
        }
        text.push_str(&call);
        let facts = &self.lists.facts;
        if method == Method::Derivative && !facts.memory.is_empty() {
            let (state, memory) = (facts.kinds.len(), facts.memory.len());
            let varying = state - memory;
            let _ = write!(
                text,
                "    {{\n        int i;\n        for (i = {varying}; i < {state}; i++)\n            {short}[i] = 0.0;\n    }}\n"
            );
        }
        text.push_str("}\n");
        Some(Function {
            about: comment_of(method.sentence()),
            head: format!(
                "void {name}_{short}(const {name}_model *m, {time}const double y[], double {short}[])"
            ),
            before: function,
            body: text,
        })
    }

    fn kinetic_energy(&mut self) -> Option<Function> {
        if !self.exists(Method::KineticEnergy) {
            return None;
        }
        let name = self.name;
        let [before, call] = self.inner(Method::KineticEnergy, "kinetic_energy", "&energy");
        Some(Function {
            about: comment_of(Method::KineticEnergy.sentence()),
            head: format!(
                "double {name}_kinetic_energy(const {name}_model *m, double t, const double y[])"
            ),
            before,
            body: format!("{{\n    double energy;\n{call}    return energy;\n}}\n"),
        })
    }

    fn mass_matrix(&mut self) -> Option<Function> {
        if !self.exists(Method::MassMatrix) {
            return None;
        }
        let name = self.name;
        let n = self.lists.facts.velocities.len();
        let entries = self.lists.list(Method::MassMatrix).results.len();
        let [before, call] = self.inner(Method::MassMatrix, "mass_matrix", "upper");
        Some(Function {
            about: comment_of("S, the mass matrix, symmetric, by rows: S dv/dt = r_s + r_k."),
            head: format!(
                "void {name}_mass_matrix(const {name}_model *m, double t, const double y[], double matrix[])"
            ),
            before,
            body: format!(
                "{{\n    double upper[{entries}];\n    int i, j, k = 0;\n{call}    for (i = 0; i < {n}; i++)\n        \
                 for (j = i; j < {n}; j++, k++) {{\n            matrix[{n} * i + j] = upper[k];\n            \
                 matrix[{n} * j + i] = upper[k];\n        }}\n}}\n"
            ),
        })
    }

    fn renew(&mut self) -> Option<Function> {
        if !self.exists(Method::Renewed) {
            return None;
        }
        let name = self.name;
        let places = &self.lists.renewed;
        let count = places.len();
        let [before, call] = self.inner(Method::Renewed, "renewed", "renewed");
        let places: Vec<String> = places.iter().map(u32::to_string).collect();
        let places = places.join(", ");
        Some(Function {
            about: comment_of(
                "Renews what laws remember, and charts of angles. To be called where a run begins and after each step, until it changes nothing.",
            ),
            head: format!("void {name}_renew(const {name}_model *m, double t, double y[])"),
            before,
            body: format!(
                "{{\n    static const int place[{count}] = {{{places}}};\n    double renewed[{count}];\n    int i;\n{call}    \
                 for (i = 0; i < {count}; i++)\n        y[place[i]] = renewed[i];\n}}\n"
            ),
        })
    }

    fn normalize(&mut self) -> Function {
        let name = self.name;
        let mut text = String::from("{\n");
        for range in &self.lists.quaternions {
            let (start, end) = (range.start, range.end);
            let _ = write!(
                text,
                "    for (double *q = y + {start}; q < y + {end}; q += 4) {{\n        \
                 const double ww = q[0] * q[0], xx = q[1] * q[1], yy = q[2] * q[2], zz = q[3] * q[3];\n        \
                 const double scale = 1.0 / sqrt(ww + xx + yy + zz);\n        \
                 q[0] *= scale;\n        q[1] *= scale;\n        q[2] *= scale;\n        q[3] *= scale;\n    }}\n"
            );
        }
        if self.lists.quaternions.is_empty() {
            text.push_str("    (void)y;\n");
        }
        text.push_str("}\n");
        Function {
            about: comment_of("Scales quaternions to length 1. To be called after each step."),
            head: format!("void {name}_normalize(double y[])"),
            before: String::new(),
            body: text,
        }
    }

    fn smallest_pivot(&mut self) -> Option<Function> {
        if !self.exists(Method::Pivots) {
            return None;
        }
        let name = self.name;
        let count = self.lists.list(Method::Pivots).results.len();
        let [before, call] = self.inner(Method::Pivots, "pivots", "pivots");
        Some(Function {
            about: comment_of(
                "Which inertia is the smallest part of what stood in its place before elimination, and which part that is: near 0 the \
                 accelerations have no digits.",
            ),
            head: format!(
                "int {name}_smallest_pivot(const {name}_model *m, double t, const double y[], double *share)"
            ),
            before,
            body: format!(
                "{{\n    double pivots[{count}];\n    int i, smallest = 0;\n{call}    for (i = 1; i < {count}; i++)\n        \
                 if (pivots[i] < pivots[smallest])\n            smallest = i;\n    *share = pivots[smallest];\n    return smallest;\n}}\n"
            ),
        })
    }

    fn violated(&mut self) -> Option<Function> {
        if !self.exists(Method::Conditions) {
            return None;
        }
        let name = self.name;
        let statements = self.body(Method::Conditions);
        let count = self.lists.rules.len();
        let mut text = format!("{{\n    double results[{count}];\n{}", statements.text);
        for (k, rule) in self.lists.rules.iter().enumerate() {
            let keeps = match rule {
                Rule::Finite => String::new(),
                Rule::NotZero => format!(" && results[{k}] != 0.0"),
                Rule::NotNegative => format!(" && results[{k}] >= 0.0"),
                Rule::Positive => format!(" && results[{k}] > 0.0"),
            };
            let _ = write!(
                text,
                "    if (!(isfinite(results[{k}]){keeps}))\n        return {k};\n"
            );
        }
        if !statements.uses_model {
            text.push_str("    (void)m;\n");
        }
        text.push_str("    return -1;\n}\n");
        Some(Function {
            about: comment_of(&format!(
                "The first condition that the parameters break, in the order of {name}_condition_names; -1 where they keep all."
            )),
            head: format!("int {name}_violated(const {name}_model *m)"),
            before: String::new(),
            body: text,
        })
    }

    fn kink_after(&mut self) -> Function {
        let name = self.name;
        let mut text = String::from("{\n    double next = INFINITY;\n");
        let breakpoints = &self.lists.facts.breakpoints;
        if !breakpoints.is_empty() {
            let values: Vec<String> = breakpoints.iter().map(|t| number(*t)).collect();
            let (count, values) = (values.len(), values.join(", "));
            let _ = write!(
                text,
                "    static const double fixed[{count}] = {{{values}}};\n    int i;\n    for (i = {count} - 1; i >= 0 && fixed[i] > t; i--)\n        \
                 next = fixed[i];\n"
            );
        }
        let mut before = String::new();
        if self.exists(Method::KinkRates) {
            self.support.want("kink_after");
            let statements = self.body(Method::KinkRates);
            let silent = if statements.uses_model {
                ""
            } else {
                "    (void)m;\n"
            };
            before = format!(
                "static void {name}_kink_rates(const {name}_model *m, double results[])\n{{\n{}{silent}}}\n\n",
                statements.text
            );
            let count = self.lists.stretched.len();
            let _ = write!(
                text,
                "    double rates[{count}];\n    {name}_kink_rates(m, rates);\n"
            );
            for (k, curve) in self.lists.stretched.iter().enumerate() {
                let _ = write!(
                    text,
                    "    {{\n        const double kink = bryant_kink_after(&{name}_curve_{curve}, rates[{k}], t);\n        \
                     next = kink < next ? kink : next;\n    }}\n"
                );
            }
        } else {
            text.push_str("    (void)m;\n");
        }
        if breakpoints.is_empty() && before.is_empty() {
            text.push_str("    (void)t;\n");
        }
        text.push_str("    return next;\n}\n");
        Function {
            about: comment_of(
                "The first time after t at which a curve of time is not smooth; INFINITY where there is none. A step should end there.",
            ),
            head: format!("double {name}_kink_after(const {name}_model *m, double t)"),
            before,
            body: text,
        }
    }
}

/// Statements `(void)x;` for the unused arguments of a function, so that no compiler warns.
fn silent(body: &Body, start: Start) -> String {
    let unused = [
        (body.uses_model, "m"),
        (body.uses_time, "t"),
        (body.uses_state, "y"),
        (start != Start::Accelerations, "accelerations"),
        (start != Start::EventFunctions, "event_functions"),
    ];
    let unused = unused.iter().filter(|(used, _)| !used);
    unused
        .map(|(_, name)| format!("    (void){name};\n"))
        .collect()
}

fn comment_of(words: &str) -> String {
    format!("/* {words} */\n")
}
