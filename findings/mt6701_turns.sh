#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mt6701 0.2.5 (Rust): an encoder that turns by a quarter turn between two readings loses a turn.
#
# Expected: get_position() counts turns as long as the shaft moves by less than half a turn between two updates. What
# happens: a wrap is seen only if the angle jumps by more than 0.8 turns, so that a step of 0.2 to 0.8 turns over the
# zero is taken as a motion back: from 0.9 to 0.15 turns is -0.75 instead of +0.25. The first reading is compared with
# 0: a shaft that stands at 0.9 turns begins at -0.1. The position, an f64, is computed in f32: after 5000 turns it has
# steps of 5 counts of the encoder. A bus answers here as an encoder does.
# For us: unwrap the raw angle yourself, in whole counts, and read at least every 0.2 turns.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "turns"
version = "0.1.0"
edition = "2021"
[dependencies]
mt6701 = "=0.2.5"
embedded-hal = "=0.2.7"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::blocking::spi::Transfer;
use embedded_hal::digital::v2::OutputPin;
use mt6701::{AngleSensorTrait, MT6701Spi};
use std::cell::Cell;
use std::convert::Infallible;
use std::rc::Rc;

const COUNTS: f64 = 16384.0;
const TURN: f64 = 2.0 * std::f64::consts::PI;

struct Encoder(Rc<Cell<u16>>);
impl Transfer<u16> for Encoder {
    type Error = Infallible;
    fn transfer<'w>(&mut self, words: &'w mut [u16]) -> Result<&'w [u16], Infallible> {
        words[0] = self.0.get() << 1;
        Ok(words)
    }
}

struct Select;
impl OutputPin for Select {
    type Error = Infallible;
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// The positions, in turns, that are read where the shaft stands at these turns.
fn read(shaft: impl Iterator<Item = f64>) -> Vec<f64> {
    let angle = Rc::new(Cell::new(0));
    let mut encoder = MT6701Spi::new(Encoder(angle.clone()), Select);
    shaft
        .enumerate()
        .map(|(sample, turns)| {
            angle.set((turns * COUNTS).round().rem_euclid(COUNTS) as u16);
            encoder.update(1000 * (sample as u64 + 1)).unwrap();
            encoder.get_position() / TURN
        })
        .collect()
}

fn main() {
    for (step, expected) in [(0.125, 4.875), (0.25, 0.75)] {
        let positions = read((0..40).map(|sample| sample as f64 * step));
        println!("39 steps of {step} turns: {:.4} turns", positions[39]);
        assert!((positions[39] - expected).abs() < 1e-3);
    }
    let first = read(std::iter::once(0.9))[0];
    println!("first reading of a shaft at 0.9 turns: {first:.4}");
    assert!((first + 0.1).abs() < 1e-3);
    let (counts, start) = (16, 5000.0);
    let far = read((0..=(8.0 * start) as usize).map(|s| s as f64 / 8.0).chain((1..=counts).map(|c| start + c as f64 / COUNTS)));
    let mut last: Vec<i64> = far[far.len() - counts..].iter().map(|turns| ((turns - start) * COUNTS).round() as i64).collect();
    last.dedup();
    println!("positions of 16 successive counts after 5000 turns: {last:?}");
    assert!(last.len() <= 5);
}
RUST
timeout 280 cargo run --quiet
