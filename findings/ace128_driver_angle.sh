#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ace128_driver 0.1.2 (Rust): position 127 of 128 of an absolute encoder is 360°, and a contact that fails makes it 0°.
#
# Its documentation gives angles in steps of 2 pi / 128. Expected of read_angle() at position 64, half a turn: 180°, and
# at 127, the last one: 357.19°. What happens: a step is 2 pi / 127, so that 64 is at 181.42°, and 127 at 360°, where
# position 0 is 0° and the same place of the shaft: within one turn, the angle gains 2.81°. Expected of a pattern that
# none of the 128 positions has, as of a dirty contact or a torn wire: an error. What happens: Ok(0.0), which is also
# the angle of position 0. read() gives None for it. Pins stand here at the levels of the library's table ACE128_MAP.
# For us: take read(), leave out None, and multiply by 2 pi / 128 yourself; or a joint jumps to 0° now and then.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "angle"
version = "0.1.0"
edition = "2021"
[dependencies]
ace128_driver = "=0.1.2"
embedded-hal = "=0.2.7"
TOML
cat > src/main.rs <<'RUST'
use ace128_driver::{Ace128, ACE128_MAP};
use embedded_hal::digital::v2::InputPin;
use std::convert::Infallible;

struct Pin(bool);
impl InputPin for Pin {
    type Error = Infallible;
    fn is_high(&self) -> Result<bool, Infallible> {
        Ok(self.0)
    }
    fn is_low(&self) -> Result<bool, Infallible> {
        Ok(!self.0)
    }
}

fn encoder(levels: usize) -> Ace128<Pin> {
    let pin = |bit: usize| Pin(levels >> bit & 1 == 1);
    Ace128::new(pin(0), pin(1), pin(2), pin(3), pin(4), pin(5), pin(6), pin(7))
}

fn main() {
    for (position, expected) in [(0, 0.0), (1, 2.8346), (64, 181.4173), (127, 360.0)] {
        let levels = ACE128_MAP.iter().position(|entry| *entry == Some(position)).unwrap();
        let angle = encoder(levels).read_angle().unwrap().to_degrees();
        println!("position {position}: {angle:.2}° instead of {:.2}°", f64::from(position) * 360.0 / 128.0);
        assert_eq!(encoder(levels).read(), Ok(Some(position)));
        assert!((angle - expected).abs() < 1e-3);
    }
    // At position 64 the contact of pin 8 is open, where it should be closed, or the other way round.
    let levels = ACE128_MAP.iter().position(|entry| *entry == Some(64)).unwrap() ^ 0x80;
    println!("with one wrong contact at 64: read() {:?}, read_angle() {:?}", encoder(levels).read(), encoder(levels).read_angle());
    assert_eq!((encoder(levels).read(), encoder(levels).read_angle()), (Ok(None), Ok(0.0)));
}
RUST
timeout 280 cargo run --quiet
