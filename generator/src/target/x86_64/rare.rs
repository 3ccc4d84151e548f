//! The branch that rare numbers take.
//!
//! Sine and cosine are written out for angles that are not large, the angle of a point for points that are neither far nor near. Where a number in any lane is
//! outside, code jumps behind its end. There all registers are stored, the function is called that serves all numbers, and the registers are
//! loaded again, but for those that hold the results. So the code that is jumped back to need not know of it.

use super::abi::Base;
use super::emit::Emitter;
use super::encode::{Comparison, Jump, Length, Memory, Operand, Place, Vector};
use super::registers::Set;
use super::slots::Slots;
use super::steps::{Kind, Steps};

/// Scalars that a function is given at most, and that it gives.
const MOST: u32 = 2;

/// Branches of a function, and what they need.
pub(super) struct Rare {
    /// How many vector registers there are.
    registers: u32,
    /// Slots of a scalar: two, where it has a slope.
    parts: u32,
    /// Slots of the frame: what is given, the results, all registers.
    first_slot: u32,
    branches: Vec<Branch>,
}

struct Branch {
    jump: Jump,
    /// Of the function, in the table.
    callee: u32,
    given: Vec<Vector>,
    results: Vec<Vector>,
    back: Place,
}

impl Rare {
    /// Takes room for branches, where there are any.
    pub fn new(steps: &Steps, registers: u32, slopes: bool, slots: &mut Slots) -> Option<Rare> {
        let branches = |kind: Kind| matches!(kind, Kind::Rare { .. });
        if !steps.steps.iter().any(|step| branches(step.kind)) {
            return None;
        }
        let parts = 1 + u32::from(slopes);
        Some(Rare {
            registers,
            parts,
            first_slot: slots.take_several(2 * MOST * parts + registers),
            branches: Vec::new(),
        })
    }

    fn given(&self, index: u32) -> u32 {
        self.first_slot + index * self.parts
    }

    fn result(&self, index: u32) -> u32 {
        self.given(MOST + index)
    }

    /// Slots with the registers that they keep.
    fn kept(&self) -> impl Iterator<Item = (u32, Vector)> + use<> {
        (self.given(2 * MOST)..).zip((0..self.registers as u8).map(Vector))
    }
}

impl Emitter<'_> {
    /// Branches where a size is not below its limit in all lanes, and goes on with the results in the registers where they are. Operands are
    /// the size, its limit, so many numbers to be given, and the results.
    pub fn rare(&mut self, callee: u32, limit: u32, given: usize, operands: &[u32], defines: u32) {
        let mut keep = Set::default();
        for register in operands
            .iter()
            .filter_map(|value| self.registers.of(*value))
        {
            keep = keep.with(register);
        }
        let mut registers = Vec::with_capacity(operands.len());
        for value in operands {
            let register = self.loaded(*value, keep);
            keep = keep.with(register);
            registers.push(register);
        }
        let jump = self.jump_if_rare(registers[0], limit, keep);
        let back = self.encoder.here();
        self.used();
        let results = registers.split_off(1 + given);
        for (value, register) in (defines..).zip(&results) {
            self.define(value, *register);
        }
        if let Some(rare) = &mut self.rare {
            rare.branches.push(Branch {
                jump,
                callee,
                given: registers.split_off(1),
                results,
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
            for (index, register) in (0..).zip(branch.given) {
                self.store_to(Base::Frame, rare.given(index), register);
            }
            for (callee, place) in &shared {
                if *callee == branch.callee {
                    self.encoder.call_place(*place);
                }
            }
            for (index, register) in (0..).zip(branch.results) {
                self.load_from(Base::Frame, rare.result(index), register);
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
            [rare.given(0), rare.result(0)].map(|slot| (Base::Frame, self.offset(slot)));
        self.bases.call(&mut self.encoder, callee, given, results);
        self.encoder.lower_stack(-8);
        for (slot, register) in rare.kept() {
            self.load_from(Base::Frame, slot, register);
        }
        self.encoder.ret();
    }
}
