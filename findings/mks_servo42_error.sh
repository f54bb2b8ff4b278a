#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mks-servo42-rs 1.0.4 (Rust): a closed-loop stepper that is 1° from its goal is read as 0.5° from it.
#
# By the protocol of the MKS SERVO42C, an error of 1° is sent as e0 00 b7 97, which is 183 of 65536 units a turn; the
# crate documents it as "1° error ≈ 182 encoder units (65536/360)". Expected of to_degrees() of the parsed answer: 1°.
# What happens: the units are divided by 360 alone, so that each error is 0.506 times as large: 90° is 45.5°. The angle
# of the shaft and that of the encoder are right. Expected of angle_to_steps(-90.0, 16.0), whose result has no sign: 800
# steps for the direction that the caller gives, or an error. What happens: 0 steps, so that the motor stands still.
# For us: multiply the error's `value` by 360/65536 yourself, and give angle_to_steps() the size of the angle.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "error"
version = "0.1.0"
edition = "2021"
[dependencies]
mks-servo42-rs = "=1.0.4"
TOML
cat > src/main.rs <<'RUST'
use mks_servo42_rs::{
    angle_to_steps, encoder_val_to_degrees, parse_motor_shaft_angle_error, parse_motor_shaft_angle_response,
};

/// The answer of a motor with the address e0: its data and the low byte of the sum.
fn answer(data: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0xE0];
    bytes.extend(data);
    bytes.push(bytes.iter().fold(0, |sum, &byte| u8::wrapping_add(sum, byte)));
    bytes
}

fn main() {
    assert_eq!(answer(&[0x00, 0xB7]), [0xE0, 0x00, 0xB7, 0x97]);
    for (units, degrees, expected) in [(183, 1.005, 0.508), (-183, -1.005, -0.508), (16384, 90.0, 45.51)] {
        let error = parse_motor_shaft_angle_error(&answer(&i16::to_be_bytes(units))).unwrap().to_degrees();
        let angle = parse_motor_shaft_angle_response(&answer(&i32::to_be_bytes(units.into()))).unwrap().to_degrees();
        println!("{units} units: an error of {error:.3}°, as an angle {angle:.3}°");
        assert!((angle - degrees).abs() < 0.001 && (error - expected).abs() < 0.005);
    }
    assert_eq!(encoder_val_to_degrees(16384), 90.0);
    let steps = [90.0, -90.0].map(|angle| angle_to_steps(angle, 16.0));
    println!("90° and -90° at 16 microsteps: {steps:?} steps");
    assert_eq!(steps, [800, 0]);
}
RUST
timeout 280 cargo run --quiet
