#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tmc2209-uart 0.1.0 (Rust): a motor that is to turn at 200 steps/s turns at 100, and a current of 1000 mA is 829 mA.
#
# By the data sheet a TMC2209 turns at VACTUAL times (fclk / 2) / 2^23 microsteps a second. Expected of
# velocity_to_vactual(200, 16, 12 MHz), whose first argument is in full steps a second: 4474, which turns a motor of 200
# steps once a second. What happens: 2237, as the formula in its documentation leaves out the division by 2; the motor
# turns once in two seconds. By the data sheet, 20 mOhm of the chip are in series with the sense resistor. Expected of
# current_to_cs() for 1000 mA at 110 mOhm: 17, with which the motor gets 994 mA. What happens: 14, as its formula has
# the sense resistor alone; with it the motor gets 829 mA, which cs_to_current() gives as 979 mA. The speeds and
# currents of the motor are calculated here by the formulas of the data sheet.
# For us: multiply microsteps a second by 2^24 / fclk for VACTUAL, and add 0.02 to the resistance; or a gear ratio that
# is found from the speed that was set is wrong by a factor of 2.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "speed"
version = "0.1.0"
edition = "2021"
[dependencies]
tmc2209-uart = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use tmc2209_uart::util::{cs_to_current, current_to_cs, velocity_to_vactual};

const CLOCK: u32 = 12_000_000;

/// The RMS current in mA that the data sheet gives for a scale at a sense resistor of 110 mOhm.
fn current(scale: u8) -> f64 {
    1000.0 * (f64::from(scale) + 1.0) / 32.0 * 0.325 / (0.11 + 0.02) / 2f64.sqrt()
}

fn main() {
    for (resolution, expected) in [(1, 140), (16, 2237), (256, 35791)] {
        let sent = velocity_to_vactual(200.0, resolution, CLOCK);
        let speed = f64::from(sent) * f64::from(CLOCK / 2) / f64::from(1 << 23) / f64::from(resolution);
        println!("200 steps/s in {resolution} microsteps: VACTUAL = {sent}, which are {speed:.1} steps/s");
        assert_eq!(sent, expected);
    }
    let scale = current_to_cs(1000, 0.11, false).unwrap();
    println!("1000 mA: scale {scale}, given back as {} mA", cs_to_current(scale, 0.11, false));
    for scale in [scale, 16, 17] {
        println!("scale {scale}: {:.0} mA", current(scale));
    }
    assert_eq!((scale, cs_to_current(scale, 0.11, false)), (14, 979));
    assert_eq!([scale, 16, 17].map(|scale| current(scale).round()), [829.0, 939.0, 994.0]);
}
RUST
timeout 280 cargo run --quiet
