#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# l298n 0.2.0 (Rust): stop(), to let a motor run out, brakes it, and forward() and reverse() are exchanged.
#
# By the data sheet of an L298, two equal inputs are a fast stop while the enable input is high: they brake the motor by
# its own current. With the enable input low, the motor runs out freely. Expected of stop(), by its comment the "Free
# Running Motor Stop" with "Ven = L": the enable input or the duty is low. What happens: both inputs are high, and the
# duty stays as it is, exactly as by brake(). The comments of forward() and reverse() have the data sheet's names of the
# two inputs: C high and D low is forward. Expected of forward(), with C as the first input and D as the second: first
# high, second low. What happens: first low, second high, and the opposite by reverse(). Pins that keep their levels
# stand here for those of a board.
# For us: set_duty(0) lets the motor run out; a friction that is measured with stop() is that of the short circuit.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "stop"
version = "0.1.0"
edition = "2021"
[dependencies]
embedded-hal = { version = "=0.2.7", features = ["unproven"] }
l298n = "=0.2.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::{digital::v2::OutputPin, PwmPin};
use l298n::Motor;
use std::{cell::Cell, convert::Infallible, rc::Rc};

#[derive(Clone, Default)]
struct Pin(Rc<Cell<bool>>);
impl OutputPin for Pin {
    type Error = Infallible;
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.set(false);
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(true);
        Ok(())
    }
}

#[derive(Clone, Default)]
struct Enable(Rc<Cell<(bool, u16)>>);
impl PwmPin for Enable {
    type Duty = u16;
    fn disable(&mut self) {
        self.0.set((false, self.0.get().1));
    }
    fn enable(&mut self) {
        self.0.set((true, self.0.get().1));
    }
    fn get_duty(&self) -> u16 {
        self.0.get().1
    }
    fn get_max_duty(&self) -> u16 {
        100
    }
    fn set_duty(&mut self, duty: u16) {
        self.0.set((self.0.get().0, duty));
    }
}

fn main() {
    let (first, second, enable) = (Pin::default(), Pin::default(), Enable::default());
    let mut motor = Motor::new(first.clone(), second.clone(), enable.clone());
    motor.set_duty(100);
    // What the data sheet of the L298 says of the levels, with C as the first input and D as the second.
    let state = || match (enable.0.get(), first.0.get(), second.0.get()) {
        ((false, _) | (true, 0), _, _) => "runs out freely",
        (_, true, false) => "forward",
        (_, false, true) => "reverse",
        _ => "brakes",
    };
    let mut found = Vec::new();
    motor.forward();
    found.push(("forward()", state()));
    motor.reverse();
    found.push(("reverse()", state()));
    motor.stop();
    found.push(("stop()", state()));
    motor.brake();
    found.push(("brake()", state()));
    for (name, state) in &found {
        println!("{name}: the motor {state}");
    }
    let expected = ["reverse", "forward", "brakes", "brakes"];
    assert!(found.iter().map(|(_, state)| *state).eq(expected));
}
RUST
timeout 280 cargo run --quiet
