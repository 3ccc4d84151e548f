//! The branches for rare numbers.
//!
//! Some functions are written out only for usual numbers: sine and cosine for angles that are not large, `atan2` for
//! points that are neither very far from nor very near to the origin, contacts of two ellipsoids for pairs that are far
//! apart. If a number in any lane is outside of this range, the code jumps to a part behind its end. This part stores
//! all registers, calls the function that handles all numbers, and loads all registers again, except those that hold
//! the results. So the code to which it jumps back need not know of the branch.

use super::base::Base;
use super::emit::{Emitter, Home, Processor};
use super::operation::{CodePosition, Jump, Vector};
use super::registers::Set;
use super::slots::Slots;
use super::steps::{Step, StepKind, Steps};

/// The branches of a function, and the slots of the frame that they need.
pub(crate) struct Rare {
    /// The number of vector registers.
    registers: u32,
    /// First slots in the frame: of the arguments of the called function, of its results, and of the stored registers.
    given: u32,
    results: u32,
    kept: u32,
    branches: Vec<Branch>,
}

struct Branch {
    jump: Jump,
    /// Index of the function in the table.
    callee: u32,
    /// Number of slots of each number that is passed.
    slots: u32,
    given: Vec<Somewhere>,
    results: Vec<Vector>,
    back: CodePosition,
}

/// The place of a number that is passed to a function.
#[derive(Clone, Copy)]
enum Somewhere {
    Register(Vector),
    Memory(Home),
}

impl Rare {
    /// Reserves slots for the branches of these steps; `None` if there are no branches.
    pub fn new(steps: &Steps, registers: u32, slots: &mut Slots) -> Option<Rare> {
        let needs = steps.steps.iter().filter_map(|step| match step.kind {
            StepKind::Rare {
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

    /// The slots in which registers are stored, each with its register.
    fn kept(&self) -> impl Iterator<Item = (u32, Vector)> + use<> {
        (self.kept..).zip((0..self.registers as u8).map(Vector))
    }
}

impl<P: Processor> Emitter<'_, P> {
    /// Emits a branch that is taken unless a size is below its limit in all lanes. The code continues with the results
    /// in their registers.
    pub fn rare(&mut self, step: &Step) {
        let StepKind::Rare {
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
        let jump = P::jump_if_rare(self, size, limit, keep);
        let back = self.processor.here();
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

    /// Emits the code behind the end of the function: first the parts that the branches of one callee share, then a
    /// part for each branch.
    pub fn rare_ways(&mut self) {
        let Some(mut rare) = self.rare.take() else {
            return;
        };
        let branches = std::mem::take(&mut rare.branches);
        let mut shared: Vec<(u32, CodePosition)> = Vec::new();
        for branch in &branches {
            if shared.iter().all(|(callee, _)| *callee != branch.callee) {
                shared.push((branch.callee, self.processor.here()));
                self.call_with_all_kept(&rare, branch.callee);
            }
        }
        for branch in branches {
            self.processor.land(branch.jump);
            let slot = |first: u32| (first..).step_by(branch.slots as usize);
            for (slot, number) in slot(rare.given).zip(branch.given) {
                let register = match number {
                    Somewhere::Register(register) => register,
                    Somewhere::Memory(home) => {
                        // results[0] is free for this: the result is loaded into it after the call
                        self.load_home(branch.results[0], home);
                        branch.results[0]
                    }
                };
                self.store_to(Base::Frame, slot, register);
            }
            for (callee, place) in &shared {
                if *callee == branch.callee {
                    self.processor.call_place(*place);
                }
            }
            for (slot, register) in slot(rare.results).zip(branch.results) {
                self.load_from(Base::Frame, slot, register);
            }
            self.processor.jump_to(branch.back);
        }
    }

    /// Emits a call of a function that leaves all vector registers as they were.
    fn call_with_all_kept(&mut self, rare: &Rare, callee: u32) {
        let kept: Vec<(u32, Vector)> = rare
            .kept()
            .filter(|(_, register)| self.processor.changed(*register))
            .collect();
        for (slot, register) in &kept {
            self.store_to(Base::Frame, *slot, *register);
        }
        let [given, results] =
            [rare.given, rare.results].map(|slot| (Base::Frame, self.offset(slot)));
        self.processor
            .call_from_part(self.shape, callee, given, results);
        for (slot, register) in kept {
            self.load_from(Base::Frame, slot, register);
        }
        self.processor.leave_part();
    }
}
