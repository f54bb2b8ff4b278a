#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nalgebra 0.35.0 (Rust): the angles of a flange that points straight down depend on how they are asked for: 60° away,
# 11° away, or right.
#
# A flange at a roll of 20°, a pitch of -90° and a yaw of 10°, of which only the sum of roll and yaw is defined.
# Expected: a roll and a yaw with the sum of 30°, as Rotation3::euler_angles() gives. What happens:
# UnitQuaternion::euler_angles() of the same pose gives 10.8° and 8.4°, a pose that is 10.8° away, as it has no case for
# ±90°. Rotation3::euler_angles_ordered() about the same axes gives -30° and 0°, a pose that is 60° away, with the flag
# that the angles are not unique, as documented; at 90° it is right, with the same flag. At -89.9° all three are exact.
# For us: take the angles of a flange by to_rotation_matrix() and Rotation3::euler_angles().
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "down"
version = "0.1.0"
edition = "2021"
[dependencies]
nalgebra = "=0.35.0"
TOML
cat > src/main.rs <<'RUST'
use nalgebra::{Rotation3, UnitQuaternion, Vector3};

/// By how many degrees the poses are away whose angles were read in three ways.
fn away(pitch: f64) -> [f64; 3] {
    let (roll, pitch, yaw) = (20f64.to_radians(), pitch.to_radians(), 10f64.to_radians());
    let matrix = Rotation3::from_euler_angles(roll, pitch, yaw);
    let distance = |angles: (f64, f64, f64), way: &str| {
        let other = Rotation3::from_euler_angles(angles.0, angles.1, angles.2);
        let distance = matrix.angle_to(&other).to_degrees();
        let read = [angles.0, angles.1, angles.2].map(|angle| (angle.to_degrees() * 100.0).round() / 100.0);
        println!("pitch {:.1}° by {way}: {read:?}, {distance:.2}° away", pitch.to_degrees());
        distance
    };
    let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    let (ordered, unique) = matrix.euler_angles_ordered(axes, true);
    assert_eq!(unique, pitch.abs() < 1.5707);
    [
        distance(matrix.euler_angles(), "Rotation3::euler_angles"),
        distance(UnitQuaternion::from_euler_angles(roll, pitch, yaw).euler_angles(), "UnitQuaternion::euler_angles"),
        distance((ordered[0], ordered[1], ordered[2]), "euler_angles_ordered"),
    ]
}

fn main() {
    assert!(away(-89.9).iter().all(|&distance| distance < 0.001));
    let [matrix, quaternion, ordered] = away(-90.0);
    assert!(matrix < 0.001 && quaternion > 5.0 && (ordered - 60.0).abs() < 0.01);
    let [matrix, quaternion, ordered] = away(90.0);
    assert!(matrix < 0.001 && quaternion > 2.0 && ordered < 0.01);
}
RUST
timeout 280 cargo run --quiet
