#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# as5048a 0.2.1 (Rust): an answer that the encoder marks as an error, or that was disturbed on its way, is read as an
# angle.
#
# Each answer of an AS5048A has a parity bit in bit 15, and in bit 14 a flag that the last transfer had an error.
# Expected: angle() returns an error for both. What happens: both bits are cut off and the rest is returned as the
# angle. A line that is torn off and reads all ones is the angle 16383, and one bit that flipped turns the shaft by up
# to half a turn. A bus answers here as an encoder does.
# For us: leave out readings that jump by more than the shaft can turn.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "flag"
version = "0.1.0"
edition = "2021"
[dependencies]
as5048a = "=0.2.1"
embedded-hal = "=0.2.7"
TOML
cat > src/main.rs <<'RUST'
use as5048a::AS5048A;
use embedded_hal::blocking::spi::Transfer;
use embedded_hal::digital::v2::OutputPin;
use std::convert::Infallible;

struct Answer(u16);
impl Transfer<u8> for Answer {
    type Error = Infallible;
    fn transfer<'w>(&mut self, words: &'w mut [u8]) -> Result<&'w [u8], Infallible> {
        words.copy_from_slice(&self.0.to_be_bytes());
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

fn with_parity(word: u16) -> u16 {
    word | ((word.count_ones() as u16 & 1) << 15)
}

fn main() {
    let right = with_parity(1000);
    let answers = [
        ("right", right, 1000),
        ("with the error flag", with_parity(1000 | 0x4000), 1000),
        ("with wrong parity, as bit 13 flipped", right ^ 0x2000, 9192),
        ("of a line torn off", 0xFFFF, 16383),
    ];
    for (name, answer, expected) in answers {
        let angle = AS5048A::new(Answer(answer), Select).angle().unwrap();
        println!("an answer {name}: Ok({angle})");
        assert_eq!(angle, expected);
    }
}
RUST
timeout 280 cargo run --quiet
