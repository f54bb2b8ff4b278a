#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# as5048a-async 0.1.0 (Rust): an invalid angle is reported as valid, a weak magnet as good, and a sound encoder as never
# ready.
#
# The AS5048A has its four flags in the bits 8 to 11 of its register 0x3FFD: offset compensation finished, CORDIC
# overflow, field too high, field too weak. What happens: they are looked for two bits higher up, in 10 to 13. A sound
# encoder, 0x0180, has not finished its compensation. At a CORDIC overflow, 0x0380, where the datasheet says that angle
# and magnitude are not valid, is_valid() is true. A magnet that is too weak, 0x0980, is reported as a CORDIC overflow,
# and magnetic_field_ok() is true; one that is too strong, 0x0580, as a sound encoder that has finished its
# compensation. agc_value() is right.
# For us: take raw() and its bits 8 to 11; let no angle through while bit 9 is set.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "diagnostics"
version = "0.1.0"
edition = "2021"
[dependencies]
as5048a-async = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use as5048a_async::Diagnostics;

const FINISHED: u16 = 1 << 8;
const OVERFLOW: u16 = 1 << 9;
const STRONG: u16 = 1 << 10;
const WEAK: u16 = 1 << 11;
const GAIN: u16 = 0x80;

fn told(name: &str, flags: u16) -> [bool; 4] {
    let found = Diagnostics::new(flags | GAIN);
    let told = [found.offset_comp_finished(), found.cordic_overflow(), found.magnetic_field_ok(), found.is_valid()];
    println!("{name}: finished, overflow, field good, valid: {told:?}, gain {}", found.agc_value());
    assert_eq!(found.agc_value(), 0x80);
    told
}

fn main() {
    assert_eq!(told("sound", FINISHED), [false, false, true, true]);
    assert_eq!(told("overflow", FINISHED | OVERFLOW), [false, false, true, true]);
    assert_eq!(told("weak magnet", FINISHED | WEAK), [false, true, true, false]);
    assert_eq!(told("strong magnet", FINISHED | STRONG), [true, false, true, true]);
}
RUST
timeout 280 cargo run --quiet
