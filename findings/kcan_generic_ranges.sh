#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kcan 0.3.0 (Rust): a torque of 6 N·m is sent to an AK80-64 as 72 N·m, and to an AK10-9 as 32 N·m.
#
# In MIT mode an actuator takes a torque as a fraction of its range, which each model has its own of: by the manual of
# the AK series ±144 N·m and ±8 rad/s for an AK80-64, ±65 N·m and ±50 rad/s for an AK10-9, ±18 N·m for an AK80-9. Here
# MotorModel names them all, and the documentation says that models other than the AK60 and the AK80-6 have conservative
# defaults, ±12 N·m and ±60 rad/s. Expected of conservative limits: at most the torque that was commanded. What happens:
# the limits are the scale as well, so that a smaller one makes the torque greater, by up to 12 times, and a speed of 5
# rad/s is sent to an AK80-64 as 0.67. Torques that such a motor answers are too small by the same factor.
# For us: give torques times 12 and speeds times 60, divided by the range of the motor.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "ranges"
version = "0.1.0"
edition = "2021"
[dependencies]
kcan = { version = "=0.3.0", default-features = false }
TOML
cat > src/main.rs <<'RUST'
use kcan::protocol::{MitCommand, MotorModel};

fn main() {
    // The greatest speed in rad/s and the greatest torque in N·m, by the manual.
    let models = [
        (MotorModel::Ak80_64, 8.0, 144.0),
        (MotorModel::Ak10_9, 50.0, 65.0),
        (MotorModel::Ak80_9, 50.0, 18.0),
        (MotorModel::Ak80_6, 76.0, 12.0),
    ];
    let taken = models.map(|(model, speed, torque)| {
        let data = model
            .pack_mit(MitCommand { position_rad: 0.0, velocity_rad_s: 5.0, kp: 0.0, kd: 1.0, torque_nm: 6.0 })
            .unwrap();
        let words = [
            u16::from(data[2]) << 4 | u16::from(data[3] >> 4),
            u16::from(data[6] & 15) << 8 | u16::from(data[7]),
        ];
        let physical = |word: u16, most: f64| ((f64::from(word) / 4095.0 * 2.0 - 1.0) * most * 10.0).round() / 10.0;
        let taken = (physical(words[0], speed), physical(words[1], torque));
        println!("{model}: 5 rad/s and 6 N·m are taken as {} rad/s and {} N·m", taken.0, taken.1);
        taken
    });
    assert_eq!(taken, [(0.7, 72.0), (4.2, 32.5), (4.2, 9.0), (5.0, 6.0)]);
}
RUST
timeout 280 cargo run --quiet
