#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# hx711 0.7.0 (Rust): each reading is below its MIN_VALUE, which is 8388608 instead of -8388608.
#
# An HX711 gives 24 bits, from -8388608 to 8388607, and stays at these ends when it is overloaded. Expected: MIN_VALUE
# is -8388608, so that value <= MIN_VALUE finds an overload. What happens: MIN_VALUE is 8388608, greater than MAX_VALUE;
# the comparison is true for each reading, value == MIN_VALUE is never, and clamp(MIN_VALUE, MAX_VALUE) ends the
# program. Readings themselves have the right sign. Pins answer here as the amplifier does.
# For us: an overloaded torque sensor reads exactly -8388608 or 8388607; leave such samples out.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "overload"
version = "0.1.0"
edition = "2021"
[dependencies]
hx711 = "=0.7.0"
embedded-hal = "=1.0.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use hx711::{Hx711, MAX_VALUE, MIN_VALUE};
use std::cell::Cell;
use std::convert::Infallible;

struct NoDelay;
impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _nanoseconds: u32) {}
}

struct Clock<'a>(&'a Cell<u32>);
impl ErrorType for Clock<'_> {
    type Error = Infallible;
}
impl OutputPin for Clock<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(self.0.get() + 1);
        Ok(())
    }
}

/// Is low before the first clock, as a sign that a reading is there, and then gives the bits of the load.
struct Data<'a>(&'a Cell<u32>, &'a Cell<i32>);
impl ErrorType for Data<'_> {
    type Error = Infallible;
}
impl InputPin for Data<'_> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let clocks = self.0.get();
        Ok((1..=24).contains(&clocks) && self.1.get() >> (24 - clocks) & 1 == 1)
    }
    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

fn read(load: i32) -> i32 {
    let (clocks, value) = (Cell::new(0), Cell::new(0)); // at first 0, as the driver itself reads once
    let mut amplifier = Hx711::new(NoDelay, Data(&clocks, &value), Clock(&clocks)).ok().unwrap();
    clocks.set(0);
    value.set(load);
    amplifier.retrieve().ok().unwrap()
}

fn main() {
    println!("limits {MIN_VALUE} to {MAX_VALUE}");
    assert_eq!((MIN_VALUE, MAX_VALUE), (8388608, 8388607));
    for load in [-8388608, -1000, 0, 1000, 8388607] {
        let value = read(load);
        println!("{value}: overloaded {} or {}", value <= MIN_VALUE, value == MIN_VALUE);
        assert_eq!(value, load);
        assert!(value <= MIN_VALUE && value != MIN_VALUE);
    }
}
RUST
timeout 280 cargo run --quiet
