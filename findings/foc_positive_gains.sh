#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# foc 0.3.0 (Rust): with positive gains, a motor that is to take 1 A takes -16 A, as much as its supply can give.
#
# Expected of Foc with two PIControllers of positive gains: a torque current of 1 A. What happens: the controllers take
# the measured value minus the desired one as the error, so that a current that is too small lowers the voltage, and the
# loop runs away to its limit; nothing says that gains have to be negative. With the gains negated it settles at 1 A.
# The PIDController has the same sign. The motor is a phase of 1 Ω and 1 mH at 24 V whose rotor is held, 20 ms long.
# For us: give negative gains, and try them with the current of the supply limited.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "gains"
version = "0.1.0"
edition = "2021"
[dependencies]
foc = "=0.3.0"
fixed = "1"
TOML
cat > src/main.rs <<'RUST'
use fixed::types::I16F16;
use foc::{pid::PIController, pwm::SpaceVector, Foc};

const RESOLUTION: u16 = 1000;

/// The torque current in A after 20 ms, where 1 A is desired.
fn settled(k_p: f64, k_i: f64) -> f64 {
    let value = I16F16::from_num::<f64>;
    let controller = || PIController::new(value(k_p), value(k_i));
    let mut drive = Foc::<SpaceVector, RESOLUTION>::new(controller(), controller());
    let (angle, step) = (0.5_f64, 1e-4);
    let mut phase = [0.0_f64; 2];
    for _ in 0..200 {
        let compare = drive.update(phase.map(value), value(angle), value(1.0), value(step));
        let volts = compare.map(|count| 24.0 * (f64::from(count) / f64::from(RESOLUTION) - 0.5));
        let star = volts.iter().sum::<f64>() / 3.0;
        for k in 0..2 {
            phase[k] += step * (volts[k] - star - phase[k]) / 1e-3;
        }
    }
    let beta = (phase[0] + 2.0 * phase[1]) / 3_f64.sqrt();
    beta * angle.cos() - phase[0] * angle.sin()
}

fn main() {
    let (positive, negative) = (settled(0.02, 20.0), settled(-0.02, -20.0));
    println!("torque current with positive gains {positive:.2} A, with negative ones {negative:.2} A");
    assert!(positive < -15.0 && (negative - 1.0).abs() < 0.02);
}
RUST
timeout 280 cargo run --quiet
