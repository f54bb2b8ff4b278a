#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tmc2209 0.3.0 (Rust): VACTUAL::ENABLED_STOPPED, "in a stopped state", turns a motor on and on, by 18° an hour.
#
# A TMC2209 ignores its step input while the register VACTUAL is not 0, and turns the motor by VACTUAL times fclk / 2^24
# microsteps a second. ENABLED_STOPPED is 1, so that at 12 MHz the motor makes 0.715 microsteps a second: 2575 an hour,
# which are 10 of its 200 full steps at 256 microsteps, and 161 full steps, 290°, at 16. Expected of a stopped motor: 0.
# By the datasheet 0 is the normal operation, in which the step input counts.
# For us: an output that creeps at a rate that no load changes is such a motor; disable the driver to stop it.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "stopped"
version = "0.1.0"
edition = "2021"
[dependencies]
tmc2209 = "=0.3.0"
TOML
cat > src/main.rs <<'RUST'
use tmc2209::{reg::VACTUAL, write_request};

fn main() {
    let request = write_request(0, VACTUAL::ENABLED_STOPPED);
    let bytes = request.bytes();
    let sent = i32::from_be_bytes(bytes[3..7].try_into().unwrap());
    let microsteps = f64::from(sent) * 12e6 / f64::from(1 << 24) * 3600.0;
    println!("register {:#x} is set to {sent}: {microsteps:.0} microsteps an hour", bytes[2] & 0x7F);
    for resolution in [256.0, 16.0] {
        println!("at {resolution} microsteps: {:.1}° an hour", microsteps / resolution * 1.8);
    }
    assert_eq!((bytes[2], sent), (0x80 | 0x22, 1));
}
RUST
timeout 280 cargo run --quiet
