#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# quadrature-encoder 0.2.1 (Rust): the first reading of a shaft that stands still is a step, or an error.
#
# Expected: new() reads both signals for its start, so that the position is 0 until the shaft turns. What happens:
# what it reads is not given to its decoder, which always begins with both signals high. In steps of a quarter period
# (QuadStep), a disc that begins with one signal high is counted once, forwards or backwards, and one with both
# signals low is the error E11_00. So the zero of an axis depends on where its disc stood at the start.
# For us: call poll() once, ignore what it gives, and then set_position(0).
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "start"
version = "0.1.0"
edition = "2021"
[dependencies]
quadrature-encoder = "=0.2.1"
embedded-hal = "=1.0.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::digital::{ErrorType, InputPin};
use quadrature_encoder::{QuadStep, RotaryEncoder};
use std::cell::Cell;
use std::convert::Infallible;
use std::rc::Rc;

struct Pin(Rc<Cell<bool>>);

impl ErrorType for Pin {
    type Error = Infallible;
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get())
    }
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.get())
    }
}

const PERIOD: [(bool, bool); 4] = [(false, false), (true, false), (true, true), (false, true)];

fn main() {
    let mut found = Vec::new();
    for start in 0..4 {
        let (a, b) = (Rc::new(Cell::new(PERIOD[start].0)), Rc::new(Cell::new(PERIOD[start].1)));
        let mut encoder: RotaryEncoder<_, _, QuadStep> = RotaryEncoder::new(Pin(a.clone()), Pin(b.clone()));
        let first = encoder.poll();
        let still = encoder.position();
        for step in 1..=40 {
            a.set(PERIOD[(start + step) % 4].0);
            b.set(PERIOD[(start + step) % 4].1);
            encoder.poll().unwrap();
        }
        println!("{:?}: {first:?}, at rest {still}, after ten periods {}", PERIOD[start], encoder.position());
        found.push((first.is_err(), still, encoder.position()));
    }
    assert_eq!(found, [(true, 0, 40), (false, -1, 39), (false, 0, 40), (false, 1, 41)]);
}
RUST
timeout 280 cargo run --quiet
