#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mpu6050-dmp 0.6.1 (Rust): a forearm at a yaw of 20°, a pitch of 40° and a roll of 30° is read at a yaw of 0°, and one
# that is only tilted at 23°.
#
# Expected of YawPitchRoll: angles from which the orientation follows, whatever their order and signs are. What happens:
# the pitch and the roll are taken from the direction of gravity, but the yaw is the one of the inverse rotation, so
# that it changes with the tilt: at a yaw of 0°, a pitch of 40° and a roll of 30° make 23° of it. A turn by 30° about z
# alone has a yaw of -30°, one about y a pitch of -30°, one about x a roll of 30°. Euler, for the same quaternion, gives
# the angles of the inverse rotation, here 0°, -44° and -23°. Nothing tells which turns are meant.
# For us: take the quaternion, normalized, and compute the angles yourself.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir src
cat > Cargo.toml <<'TOML'
[package]
name = "angles"
version = "0.1.0"
edition = "2021"

[dependencies]
mpu6050-dmp = "=0.6.1"
TOML
cat > src/main.rs <<'RUST'
use mpu6050_dmp::{euler::Euler, quaternion::Quaternion, yaw_pitch_roll::YawPitchRoll};

/// Return the quaternion of a turn about z, then about the turned y, then about the turned x, in degrees.
fn quaternion(yaw: f32, pitch: f32, roll: f32) -> Quaternion {
    let [(sz, cz), (sy, cy), (sx, cx)] = [yaw, pitch, roll].map(|angle| (angle.to_radians() / 2.0).sin_cos());
    Quaternion {
        w: cx * cy * cz + sx * sy * sz,
        x: sx * cy * cz - cx * sy * sz,
        y: cx * sy * cz + sx * cy * sz,
        z: cx * cy * sz - sx * sy * cz,
    }
}

fn main() {
    let cases = [
        ([30, 0, 0], [-30, 0, 0], [-30, 0, 0]),
        ([0, 30, 0], [0, -30, 0], [0, -30, 0]),
        ([0, 0, 30], [0, 0, 30], [0, 0, -30]),
        ([0, 40, 30], [23, -40, 30], [23, -34, -37]),
        ([20, 40, 30], [0, -40, 30], [0, -44, -23]),
    ];
    for (turns, angles, euler) in cases {
        let q = quaternion(turns[0] as f32, turns[1] as f32, turns[2] as f32);
        let (a, e) = (YawPitchRoll::from(q), Euler::from(q));
        let read = [a.yaw, a.pitch, a.roll].map(|angle| angle.to_degrees().round() as i32);
        let also = [e.psi, e.theta, e.phi].map(|angle| angle.to_degrees().round() as i32);
        println!("turned by {turns:?}: yaw, pitch and roll {read:?}; psi, theta and phi {also:?}");
        assert_eq!((read, also), (angles, euler));
    }
}
RUST
cargo build --quiet 2> build.log || { cat build.log; exit 1; }
timeout 60 target/debug/angles
