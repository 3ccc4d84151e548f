//! The nodes of a graph: the inputs of the equations, the functions that are called, and the operations.

use serde::{Deserialize, Serialize};

/// Index of a node in its graph, in order of creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub u32);

/// An input of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Symbol {
    /// t \[s\]
    Time,
    /// q\[i\]
    Coordinate(u32),
    /// v\[i\]
    Velocity(u32),
    /// A parameter, by its index in the model.
    Parameter(u32),
    /// z\[i\], a continuous state of a force law, which is integrated with the rest.
    Auxiliary(u32),
    /// m\[i\], a discrete state of a force law: constant during a step, updated after an accepted step.
    Memory(u32),
    /// a\[i\], an acceleration that is given: for functions that start from accelerations, and methods that repeat
    /// none of the work of the accelerations.
    Acceleration(u32),
}

/// A function that is not algebra. Generated code calls it in the runtime by these names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Function {
    /// Value of the curve with this index in the model, at one argument.
    Curve(u32),
    /// Slope of the curve at one argument.
    CurveSlope(u32),
    /// Second derivative of the curve at one argument.
    CurveSecondDerivative(u32),
    /// Argument at which the curve takes a value.
    CurveInverse(u32),
    /// ∫ of the curve from 0 to one argument.
    CurveIntegral(u32),
    /// ∬ of the curve from 0 to one argument.
    CurveDoubleIntegral(u32),
    /// The breakpoint indicator of the curve at one argument: its sign changes where the curve is not smooth.
    CurveBreakpoints(u32),
    /// Stop of a motion, as a function of velocity and factor: the first argument above 0 at which velocity + factor ·
    /// ∫ of the curve from 0 reaches 0, or 0 if there is none.
    CurveStop(u32),
    /// `force::power::power(base, exponent)`, the base not negative
    Power,
    /// `force::switch::choose(a, b, then, otherwise)`: `then` if a < b, else `otherwise`
    Choose,
    /// One of the four results of `force::ellipsoid::support(x, y, z, power)`
    Support(u8),
    /// One result of the search for the direction of least overlap of two ellipsoids, given as two symmetric matrices
    /// and a vector
    Approach(ApproachCall),
    /// One result of a function of the user: `module::scalars(arguments)`
    User(UserCall),
}

/// One result of a call of a function of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct UserCall {
    /// Index of the force in the model.
    pub force: u16,
    /// Number of arguments.
    pub arguments: u16,
    /// Index of this result.
    pub part: u16,
    /// Number of results.
    pub parts: u16,
}

/// One result of the approach of two ellipsoids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ApproachCall {
    /// True in the plane, where matrices are given as xx, zz, xz and vectors as x, z. In space, matrices are given as
    /// xx, yy, zz, yz, xz, xy and vectors as x, y, z.
    pub planar: bool,
    /// True if any separating plane is accepted for bodies that do not touch, instead of the one with the largest
    /// distance. Forces use this, because they are 0 then.
    pub early: bool,
    /// Index of this result: first come the components of the direction, then the overlap, then the components of the
    /// vector from the first centre to the midpoint between the two furthest points.
    pub part: u8,
}

impl ApproachCall {
    /// Number of components of a vector.
    pub fn components(self) -> usize {
        if self.planar { 2 } else { 3 }
    }

    /// Number of arguments.
    pub fn arity(self) -> usize {
        if self.planar { 8 } else { 15 }
    }

    /// Number of results.
    pub fn parts(self) -> usize {
        2 * self.components() + 1
    }

    /// The function's path in the runtime.
    pub fn path(self) -> &'static str {
        match (self.planar, self.early) {
            (false, false) => "force::approach::space::approach",
            (false, true) => "force::approach::space::touch",
            (true, false) => "force::approach::plane::approach",
            (true, true) => "force::approach::plane::touch",
        }
    }
}

impl Function {
    /// Number of arguments.
    pub fn arity(self) -> usize {
        match self {
            Function::Curve(_)
            | Function::CurveSlope(_)
            | Function::CurveSecondDerivative(_)
            | Function::CurveInverse(_)
            | Function::CurveIntegral(_)
            | Function::CurveDoubleIntegral(_)
            | Function::CurveBreakpoints(_) => 1,
            Function::CurveStop(_) | Function::Power => 2,
            Function::Choose | Function::Support(_) => 4,
            Function::Approach(call) => call.arity(),
            Function::User(call) => call.arguments.into(),
        }
    }

    /// The same call with the first of its results.
    pub fn first_part(self) -> Function {
        match self {
            Function::Support(_) => Function::Support(0),
            Function::Approach(call) => Function::Approach(ApproachCall { part: 0, ..call }),
            Function::User(call) => Function::User(UserCall { part: 0, ..call }),
            function => function,
        }
    }

    /// Index of this result and number of results of the call; `None` for a function with one result.
    ///
    /// Calls that differ only in this index are one call in the emitted text.
    pub fn part(self) -> Option<(usize, usize)> {
        match self {
            Function::Curve(_)
            | Function::CurveSlope(_)
            | Function::CurveSecondDerivative(_)
            | Function::CurveInverse(_)
            | Function::CurveIntegral(_)
            | Function::CurveDoubleIntegral(_)
            | Function::CurveBreakpoints(_)
            | Function::CurveStop(_)
            | Function::Choose
            | Function::Power => None,
            Function::User(call) => Some((call.part.into(), call.parts.into())),
            Function::Support(part) => Some((part.into(), 4)),
            Function::Approach(call) => Some((call.part.into(), call.parts())),
        }
    }
}

/// One operation. Operands are older nodes of the same graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number, by its bits. Zero has no sign.
    Constant(u64),
    /// An input.
    Symbol(Symbol),
    /// −a
    Neg(NodeId),
    /// a + b
    Add(NodeId, NodeId),
    /// a − b
    Sub(NodeId, NodeId),
    /// a · b
    Mul(NodeId, NodeId),
    /// a / b
    Div(NodeId, NodeId),
    /// a · b + c with one rounding. Only the pass [`fuse`](super::passes::fuse()) makes it.
    MulAdd(NodeId, NodeId, NodeId),
    /// √a
    Sqrt(NodeId),
    /// sin a
    Sin(NodeId),
    /// cos a
    Cos(NodeId),
    /// Angle of the point x = second operand, y = first operand.
    Atan2(NodeId, NodeId),
    /// The larger of the two.
    Max(NodeId, NodeId),
    /// The smaller of the two.
    Min(NodeId, NodeId),
    /// A call. If the function has fewer than three arguments, the remaining operands repeat the first. If it has more
    /// than three, the operands are [`Node::Arguments`].
    Call(Function, [NodeId; 3]),
    /// Up to three arguments of a call, or lists of them, one after the other. It has no value of its own. Missing
    /// entries repeat the last.
    Arguments([NodeId; 3]),
}

impl Node {
    /// True for a constant or an input, which are no operations.
    #[inline]
    pub fn is_leaf(&self) -> bool {
        matches!(self, Node::Constant(_) | Node::Symbol(_))
    }

    /// The operands, in order.
    #[inline]
    pub fn operands(&self) -> impl Iterator<Item = NodeId> + use<> {
        let (ids, count) = match *self {
            Node::Constant(_) | Node::Symbol(_) => ([NodeId(0); 3], 0),
            Node::Neg(a) | Node::Sqrt(a) | Node::Sin(a) | Node::Cos(a) => ([a; 3], 1),
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Atan2(a, b)
            | Node::Max(a, b)
            | Node::Min(a, b) => ([a, b, a], 2),
            Node::MulAdd(a, b, c) => ([a, b, c], 3),
            Node::Call(function, arguments) => (arguments, function.arity().min(3)),
            Node::Arguments(arguments) => (arguments, 3),
        };
        ids.into_iter().take(count)
    }

    /// The same operation with its operands mapped, without folding.
    #[inline]
    pub fn map_operands(self, mut map: impl FnMut(NodeId) -> NodeId) -> Node {
        match self {
            Node::Constant(_) | Node::Symbol(_) => self,
            Node::Neg(a) => Node::Neg(map(a)),
            Node::Add(a, b) => Node::Add(map(a), map(b)),
            Node::Sub(a, b) => Node::Sub(map(a), map(b)),
            Node::Mul(a, b) => Node::Mul(map(a), map(b)),
            Node::Div(a, b) => Node::Div(map(a), map(b)),
            Node::MulAdd(a, b, c) => Node::MulAdd(map(a), map(b), map(c)),
            Node::Sqrt(a) => Node::Sqrt(map(a)),
            Node::Sin(a) => Node::Sin(map(a)),
            Node::Cos(a) => Node::Cos(map(a)),
            Node::Atan2(a, b) => Node::Atan2(map(a), map(b)),
            Node::Max(a, b) => Node::Max(map(a), map(b)),
            Node::Min(a, b) => Node::Min(map(a), map(b)),
            Node::Call(function, arguments) => Node::Call(function, arguments.map(map)),
            Node::Arguments(arguments) => Node::Arguments(arguments.map(map)),
        }
    }
}
