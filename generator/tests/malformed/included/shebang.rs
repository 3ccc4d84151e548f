#!/usr/bin/env rust
fn drag<T: Real>(input: &Input<T>) -> Output<T> { Output::zero() }
