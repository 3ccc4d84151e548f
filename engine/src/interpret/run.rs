//! The loops that execute runs of chains, one for each shape.

use super::chain::Kind;
use super::encode::{Code, Group};
use super::frame::Frame;
use crate::call::{self, Library};
use bryant_runtime::{Real, Task};

/// Kinds of operations as numbers, because the loops have kinds as constant parameters.
const NONE: u8 = u8::MAX;
const ADD: u8 = Kind::Add as u8;
const SUB: u8 = Kind::Sub as u8;
const MUL: u8 = Kind::Mul as u8;
const FMA: u8 = Kind::MulAdd as u8;
const FMS: u8 = Kind::MulSub as u8;
const FNA: u8 = Kind::NegMulAdd as u8;
const FNS: u8 = Kind::NegMulSub as u8;
const NEG: u8 = Kind::Neg as u8;
const DIV: u8 = Kind::Div as u8;
const SQRT: u8 = Kind::Sqrt as u8;
const ATAN2: u8 = Kind::Atan2 as u8;
const MAX: u8 = Kind::Max as u8;
const MIN: u8 = Kind::Min as u8;

/// Defines all shapes, and the function that executes a run of one shape.
macro_rules! shapes {
    ($($number:literal: $first:ident $second:ident $third:ident;)*) => {
        /// The kinds of the operations of each shape. The last two shapes, sines and calls, are not in this table.
        const SHAPES: &[[u8; 3]] = &[$([$first, $second, $third]),*];

        /// Executes a run of a shape.
        #[inline(always)]
        fn run_of<T: Real>(
            shape: u16,
            groups: &[Group],
            code: &Code,
            library: &Library,
            frame: &mut Frame<'_, T>,
        ) {
            match shape {
                $($number => chains::<T, $first, $second, $third>(groups, frame),)*
                SINES => sines(groups, frame),
                _ => calls(groups, code, library, frame),
            }
        }
    };
}

shapes! {
    0: NEG NONE NONE;
    1: DIV NONE NONE;
    2: SQRT NONE NONE;
    3: ATAN2 NONE NONE;
    4: MAX NONE NONE;
    5: MIN NONE NONE;
    6: ADD NONE NONE;
    7: SUB NONE NONE;
    8: MUL NONE NONE;
    9: FMA NONE NONE;
    10: FMS NONE NONE;
    11: FNA NONE NONE;
    12: FNS NONE NONE;
    13: ADD FMA NONE;
    14: ADD FNA NONE;
    15: SUB FMA NONE;
    16: SUB FNA NONE;
    17: MUL FMA NONE;
    18: MUL FNA NONE;
    19: FMA FMA NONE;
    20: FMA FNA NONE;
    21: FMS FMA NONE;
    22: FMS FNA NONE;
    23: FNA FMA NONE;
    24: FNA FNA NONE;
    25: FNS FMA NONE;
    26: FNS FNA NONE;
    27: MUL FMA FMA;
    28: MUL FMA FNA;
    29: MUL FNA FMA;
    30: MUL FNA FNA;
    31: FMA FMA FMA;
    32: FMA FMA FNA;
    33: FMA FNA FMA;
    34: FMA FNA FNA;
    35: FNA FMA FMA;
    36: FNA FMA FNA;
    37: FNA FNA FMA;
    38: FNA FNA FNA;
}

/// The shape of a sine with its cosine.
pub const SINES: u16 = SHAPES.len() as u16;
/// The shape of a call.
const CALLS: u16 = SINES + 1;

/// True if a shape is that of calls; their groups hold the index of a call instead of places.
pub fn is_call(shape: u16) -> bool {
    shape == CALLS
}

/// The shape of a chain with these kinds; `None` if there is no loop for it. Each single operation has a loop.
pub fn shape_of(kinds: &[Kind]) -> Option<usize> {
    match kinds {
        [Kind::SinCos] => return Some(SINES.into()),
        [Kind::Call] => return Some(CALLS.into()),
        _ => {}
    }
    let at = |place: usize| kinds.get(place).map_or(NONE, |&kind| kind as u8);
    let wanted = [at(0), at(1), at(2)];
    SHAPES.iter().position(|shape| *shape == wanted)
}

/// The runs of a list as a task, compiled for the instructions of the scalar.
pub struct Runs<'a, T> {
    pub code: &'a Code,
    pub library: &'a Library,
    pub frame: Frame<'a, T>,
}

impl<T: Real> Task for Runs<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Runs {
            code,
            library,
            mut frame,
        } = self;
        let mut rest = &code.groups[..];
        for run in &code.runs {
            let (groups, after) = rest.split_at(run.count as usize);
            run_of(run.shape, groups, code, library, &mut frame);
            rest = after;
        }
    }
}

/// Executes chains of up to three operations.
#[inline(always)]
fn chains<T: Real, const FIRST: u8, const SECOND: u8, const THIRD: u8>(
    groups: &[Group],
    frame: &mut Frame<'_, T>,
) {
    for Group([to, a, b, c, d, e, f, g]) in groups {
        let mut value = first::<T, FIRST>(frame, *a, *b, *c);
        value = next::<T, SECOND>(frame, *d, *e, value);
        value = next::<T, THIRD>(frame, *f, *g, value);
        frame.set(*to, value);
    }
}

#[inline(always)]
fn first<T: Real, const KIND: u8>(frame: &Frame<'_, T>, a: u16, b: u16, c: u16) -> T {
    match KIND {
        NEG => -frame.get(a),
        ADD => frame.get(a) + frame.get(b),
        SUB => frame.get(a) - frame.get(b),
        MUL => frame.get(a) * frame.get(b),
        DIV => frame.get(a) / frame.get(b),
        FMA => frame.get(a).mul_add(frame.get(b), frame.get(c)),
        FMS => frame.get(a).mul_add(frame.get(b), -frame.get(c)),
        FNA => (-frame.get(a)).mul_add(frame.get(b), frame.get(c)),
        FNS => (-frame.get(a)).mul_add(frame.get(b), -frame.get(c)),
        SQRT => frame.get(a).sqrt(),
        ATAN2 => call::atan2(frame.get(a), frame.get(b)),
        MAX => frame.get(a).max(frame.get(b)),
        MIN => frame.get(a).min(frame.get(b)),
        _ => unreachable!("sines and calls have loops of their own"),
    }
}

#[inline(always)]
fn next<T: Real, const KIND: u8>(frame: &Frame<'_, T>, a: u16, b: u16, value: T) -> T {
    match KIND {
        NONE => value,
        FMA => frame.get(a).mul_add(frame.get(b), value),
        FMS => frame.get(a).mul_add(frame.get(b), -value),
        FNA => (-frame.get(a)).mul_add(frame.get(b), value),
        FNS => (-frame.get(a)).mul_add(frame.get(b), -value),
        _ => unreachable!("no shape goes on with it"),
    }
}

#[inline(always)]
fn sines<T: Real>(groups: &[Group], frame: &mut Frame<'_, T>) {
    for Group([to, a, ..]) in groups {
        let (sin, cos) = call::sin_cos(frame.get(*a));
        frame.set(*to, sin);
        frame.set(*to + 1, cos);
    }
}

#[inline(always)]
fn calls<T: Real>(groups: &[Group], code: &Code, library: &Library, frame: &mut Frame<'_, T>) {
    for Group([call, ..]) in groups {
        let site = &code.calls[usize::from(*call)];
        let places = site.arguments.0 as usize..site.arguments.1 as usize;
        frame.call(
            library,
            site.function,
            &code.arguments[places],
            site.results,
        );
    }
}
