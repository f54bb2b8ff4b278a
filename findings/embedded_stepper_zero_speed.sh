#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# embedded-stepper 0.1.2 (Rust): a stepper whose speed is set to 0 makes all its steps at once.
#
# By its documentation set_speed(0) sets the speed to 0. Expected: step() then makes no step. What happens: a speed of 0
# is stored as a pause of 0 between the steps, so that 200 steps are made without any pause, where they take 1 s at 60
# rpm and 60 s at 1 rpm. It is so before the first set_speed() too. The slower the speed, the longer the pause, and at 0
# it is the fastest.
# For us: a stepper cannot follow that, so that it stands or loses steps, which looks like a slipped coupling.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "zero"
version = "0.1.0"
edition = "2021"
[dependencies]
embedded-stepper = "=0.1.2"
embedded-hal = "=1.0.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::delay::DelayNs;
use embedded_stepper::{driver::StepperMotor, stepper::Stepper};
use std::cell::Cell;
use std::convert::Infallible;

struct Clock<'a>(&'a Cell<u64>);
impl DelayNs for Clock<'_> {
    fn delay_ns(&mut self, nanoseconds: u32) {
        self.0.set(self.0.get() + u64::from(nanoseconds));
    }
}

struct Coils<'a>(&'a Cell<u32>);
impl StepperMotor for Coils<'_> {
    type Error = Infallible;
    fn step(&mut self, _step: u32) -> Result<(), Infallible> {
        self.0.set(self.0.get() + 1);
        Ok(())
    }
    fn clear(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// The steps that are made, and the seconds that they take.
fn turn(rpm: Option<u32>) -> (u32, f64) {
    let (steps, time) = (Cell::new(0), Cell::new(0));
    let mut stepper = Stepper::new(200, Coils(&steps), Clock(&time));
    if let Some(rpm) = rpm {
        stepper.set_speed(rpm);
    }
    stepper.step(200).unwrap();
    (steps.get(), time.get() as f64 / 1e9)
}

fn main() {
    for (rpm, seconds) in [(Some(60), 1.0), (Some(1), 60.0), (Some(0), 0.0), (None, 0.0)] {
        let turned = turn(rpm);
        println!("{rpm:?} rpm: {} steps in {} s", turned.0, turned.1);
        assert_eq!(turned, (200, seconds));
    }
}
RUST
timeout 280 cargo run --quiet
