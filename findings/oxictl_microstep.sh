#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oxictl 0.1.1 (Rust): in microsteps, a stepper turns by 1/50 of what its position says.
#
# By its documentation, the angle of MicroStepDriver's currents advances by 2π / (4 N) per microstep. A motor of 200
# steps per turn has 50 periods per turn, so expected after 3200 microsteps of 1/16: 50 periods, and after 64, four full
# steps, one period. What happens: the angle is that of the shaft, so that 3200 microsteps make one period, which turns
# the motor by four steps, 7.2°. position_rad() is 2π. FullStepDriver has its period of four steps.
# For us: the output of a driver that reports such a position turns by a fiftieth of it, which looks like another gear
# ratio.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "microstep"
version = "0.1.0"
edition = "2021"
[dependencies]
oxictl = { version = "=0.1.1", features = ["motor"] }
TOML
cat > src/main.rs <<'RUST'
use oxictl::motor::stepper::{full_step::FullStepDriver, micro_step::MicroStepDriver};
use std::f64::consts::TAU;

fn main() {
    let mut motor = MicroStepDriver::<f64>::new(200, 16, 1.0);
    let (mut periods, mut before) = (0.0, 0.0);
    for microstep in 1..=3200 {
        motor.step(1);
        let (a, b) = motor.coil_currents();
        let turned: f64 = b.atan2(a) - before;
        periods += (turned - TAU * (turned / TAU).round()) / TAU;
        before = b.atan2(a);
        if microstep == 64 {
            println!("after 64 microsteps: {periods:.3} periods");
            assert!((periods - 0.02_f64).abs() < 1e-9);
        }
    }
    println!("after 3200 microsteps: {periods:.3} periods, reported {:.3} turns", motor.position_rad() / TAU);
    assert!((periods - 1.0).abs() < 1e-9 && (motor.position_rad() / TAU - 1.0).abs() < 1e-9);

    let mut full = FullStepDriver::<f64>::new(200);
    let first = full.phase_pattern();
    full.step(4);
    assert_eq!(full.phase_pattern(), first);
}
RUST
timeout 280 cargo run --quiet
