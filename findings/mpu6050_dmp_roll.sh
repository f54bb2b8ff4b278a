#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mpu6050-dmp 0.6.1 (Rust): an arm turned by 30° about x has a roll of 30° by one of its types and of -30° by another.
#
# YawPitchRoll and Euler are both documented as rotations about z, y and x, in radians, and are both made of the
# quaternion that the sensor computes. Expected: the same three angles of the same quaternion, as a turn by 30° about
# one axis is 30° about it in any order. What happens: about x it is a roll of 30° in YawPitchRoll and of -30° in Euler;
# about y and z it is -30° in both. So Euler has all signs reversed, YawPitchRoll those of pitch and yaw alone, which no
# text says: code that takes one in place of the other tilts to the opposite side.
# For us: turn the quaternion into a matrix, or check the sign of each angle by hand.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "roll"
version = "0.1.0"
edition = "2021"
[dependencies]
mpu6050-dmp = "=0.6.1"
TOML
cat > src/main.rs <<'RUST'
use mpu6050_dmp::{euler::Euler, quaternion::Quaternion, yaw_pitch_roll::YawPitchRoll};

fn turn(axis: usize, degrees: f32) -> Quaternion {
    let half = degrees.to_radians() / 2.0;
    let mut vector = [0.0; 3];
    vector[axis] = half.sin();
    Quaternion { w: half.cos(), x: vector[0], y: vector[1], z: vector[2] }
}

/// Roll, pitch and yaw in degrees, of YawPitchRoll and of Euler.
fn angles(turned: Quaternion) -> ([f32; 3], [f32; 3]) {
    let (first, second) = (YawPitchRoll::from(turned), Euler::from(turned));
    (
        [first.roll, first.pitch, first.yaw].map(|angle| angle.to_degrees()),
        [second.phi, second.theta, second.psi].map(|angle| angle.to_degrees() as f32),
    )
}

fn near(found: [f32; 3], expected: [f32; 3]) -> bool {
    found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01)
}

fn main() {
    for (axis, first, second) in [
        (0, [30.0, 0.0, 0.0], [-30.0, 0.0, 0.0]),
        (1, [0.0, -30.0, 0.0], [0.0, -30.0, 0.0]),
        (2, [0.0, 0.0, -30.0], [0.0, 0.0, -30.0]),
    ] {
        let found = angles(turn(axis, 30.0));
        println!("30° about {}: YawPitchRoll {:.2?}, Euler {:.2?}", ["x", "y", "z"][axis], found.0, found.1);
        assert!(near(found.0, first) && near(found.1, second));
    }
}
RUST
timeout 280 cargo run --quiet
