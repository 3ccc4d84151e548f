//! The branch that rare numbers take.
//!
//! Sine and cosine are written out for angles that are not large, the angle of a point for points that are neither far nor near, two ellipsoids for those that
//! are far from each other. Where a number in any lane is outside, code jumps behind its end. There all registers are stored, the function is called that serves all numbers, and the registers are
//! loaded again, but for those that hold the results. So the code that is jumped back to need not know of it.

use super::abi::Base;
use super::emit::{Emitter, Home};
use super::encode::{Comparison, Jump, Length, Memory, Operand, Place, Vector};
use super::registers::Set;
use super::slots::Slots;
use super::steps::{Kind, Step, Steps};

/// Branches, and what they need.
pub(super) struct Rare {
    /// How many vector registers there are.
    registers: u32,
    /// Slots of the frame: what a function is given, its results, all registers.
    given: u32,
    results: u32,
    kept: u32,
    branches: Vec<Branch>,
}

struct Branch {
    jump: Jump,
    /// Of the function, in the table.
    callee: u32,
    /// So many slots a number takes.
    slots: u32,
    given: Vec<Somewhere>,
    results: Vec<Vector>,
    back: Place,
}

/// Where a number is.
#[derive(Clone, Copy)]
enum Somewhere {
    Register(Vector),
    Memory(Home),
}

impl Rare {
    /// Takes room for branches, where there are any.
    pub fn new(steps: &Steps, registers: u32, slots: &mut Slots) -> Option<Rare> {
        let needs = steps.steps.iter().filter_map(|step| match step.kind {
            Kind::Rare {
                given,
                results,
                slots,
                ..
            } => Some([given * slots, results * slots]),
            _ => None,
        });
        let [given, results] = needs.reduce(|[a, b], [c, d]| [a.max(c), b.max(d)])?;
        let first = slots.take_several(given + results + registers);
        Some(Rare {
            registers,
            given: first,
            results: first + given,
            kept: first + given + results,
            branches: Vec::new(),
        })
    }

    /// Slots with the registers that they keep.
    fn kept(&self) -> impl Iterator<Item = (u32, Vector)> + use<> {
        (self.kept..).zip((0..self.registers as u8).map(Vector))
    }
}

impl Emitter<'_> {
    /// Branches where a size is not below its limit in all lanes, and goes on with the results in the registers where they are.
    pub fn rare(&mut self, step: &Step) {
        let Kind::Rare {
            callee,
            limit,
            given,
            slots,
            ..
        } = step.kind
        else {
            unreachable!("the caller has asked");
        };
        let steps = self.steps;
        let values = &steps.arguments[step.arguments()];
        let (size, rest) = (values[0], &values[1..]);
        let (given, results) = rest.split_at(given as usize);
        let mut keep = Set::default();
        for value in std::iter::once(&size).chain(results) {
            if let Some(register) = self.registers.of(*value) {
                keep = keep.with(register);
            }
        }
        let size = self.loaded(size, keep);
        keep = keep.with(size);
        let mut registers = Vec::with_capacity(results.len());
        for value in results {
            let register = self.loaded(*value, keep);
            keep = keep.with(register);
            registers.push(register);
        }
        let jump = self.jump_if_rare(size, limit, keep);
        let back = self.encoder.here();
        let somewhere = |value: &u32| match self.registers.of(*value) {
            Some(register) => Somewhere::Register(register),
            None => Somewhere::Memory(self.home(*value)),
        };
        let given = given.iter().map(somewhere).collect();
        for (argument, value) in step.arguments().zip(values) {
            self.use_up(*value, self.after_argument(argument));
        }
        for (value, register) in (step.defines..).zip(&registers) {
            self.define(value, *register);
        }
        if let Some(rare) = &mut self.rare {
            rare.branches.push(Branch {
                jump,
                callee,
                slots,
                given,
                results: registers,
                back,
            });
        }
    }

    fn jump_if_rare(&mut self, size: Vector, limit: u32, keep: Set) -> Jump {
        let limit = Memory::Constant(self.constant(limit));
        let limit = match self.shape.length {
            Length::SixtyFour => Operand::Broadcast(limit),
            _ => Operand::Memory(limit),
        };
        if self.masks {
            self.encoder
                .compare_to_mask(self.shape, Comparison::NotLess, size, limit);
            self.encoder.jump_if_masked()
        } else {
            let scratch = self.make_room(keep);
            self.encoder
                .compare(self.shape, Comparison::NotLess, [scratch, size], limit);
            self.encoder.jump_if_signed(self.shape, scratch)
        }
    }

    /// What stands behind the end of the code: a way for each branch, and before them what those of one function share.
    pub fn rare_ways(&mut self) {
        let Some(mut rare) = self.rare.take() else {
            return;
        };
        let branches = std::mem::take(&mut rare.branches);
        let mut shared: Vec<(u32, Place)> = Vec::new();
        for branch in &branches {
            if shared.iter().all(|(callee, _)| *callee != branch.callee) {
                shared.push((branch.callee, self.encoder.here()));
                self.call_with_all_kept(&rare, branch.callee);
            }
        }
        for branch in branches {
            self.encoder.land(branch.jump);
            let slot = |first: u32| (first..).step_by(branch.slots as usize);
            for (slot, number) in slot(rare.given).zip(branch.given) {
                let register = match number {
                    Somewhere::Register(register) => register,
                    Somewhere::Memory(home) => {
                        // a result is to come here
                        self.load_home(branch.results[0], home);
                        branch.results[0]
                    }
                };
                self.store_to(Base::Frame, slot, register);
            }
            for (callee, place) in &shared {
                if *callee == branch.callee {
                    self.encoder.call_place(*place);
                }
            }
            for (slot, register) in slot(rare.results).zip(branch.results) {
                self.load_from(Base::Frame, slot, register);
            }
            self.encoder.jump_to(branch.back);
        }
    }

    /// Calls a function, and returns with all vector registers as they were.
    fn call_with_all_kept(&mut self, rare: &Rare, callee: u32) {
        for (slot, register) in rare.kept() {
            self.store_to(Base::Frame, slot, register);
        }
        if self.shape.length.is_wide() {
            self.encoder.zero_upper();
        }
        // what is called finds the stack at a multiple of 16, and this has been called
        self.encoder.lower_stack(8);
        let [given, results] =
            [rare.given, rare.results].map(|slot| (Base::Frame, self.offset(slot)));
        self.bases.call(&mut self.encoder, callee, given, results);
        self.encoder.lower_stack(-8);
        for (slot, register) in rare.kept() {
            self.load_from(Base::Frame, slot, register);
        }
        self.encoder.ret();
    }
}
