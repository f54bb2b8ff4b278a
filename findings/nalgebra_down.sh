#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nalgebra 0.35.0 (Rust): the angles of a flange that points straight down are up to 49° off if its pose is a
# quaternion.
#
# A flange at a roll of 20°, a pitch of -90° and a yaw of 10°, of which only the sum of roll and yaw is defined.
# Expected of euler_angles(): a roll and a yaw with the sum of 30°, as it gives for the Rotation3 of these angles. What
# happens for their UnitQuaternion: 10.8° and 8.4°, a pose 10.8° away, as a pitch of ±90° is seen only where an element
# of the matrix is exactly ±1, and rounding makes it a little less. At a pitch of 90°, 59 of 180 poses are more than 1°
# away, up to 49°. to_rotation_matrix() before it is no help. euler_angles_ordered() of the Rotation3 gives -30° and 0°
# for the first pose, which is 60° away, with the documented flag that the angles are not unique; at 90° it is right,
# with the same flag. At -89.9° all are exact.
# For us: keep the orientation of a flange as a quaternion, and make the pose from its angles again to check them.
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

const WAYS: [&str; 4] = ["a Rotation3", "a UnitQuaternion", "to_rotation_matrix()", "euler_angles_ordered()"];

/// By how many degrees the poses are away whose angles were read in four ways.
fn away(roll: f64, pitch: f64, shown: bool) -> [f64; 4] {
    let (roll, tilt, yaw) = (roll.to_radians(), pitch.to_radians(), 10f64.to_radians());
    let matrix = Rotation3::from_euler_angles(roll, tilt, yaw);
    let quaternion = UnitQuaternion::from_euler_angles(roll, tilt, yaw);
    let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    let (ordered, unique) = matrix.euler_angles_ordered(axes, true);
    assert_eq!(unique, pitch.abs() < 89.99);
    let read = [
        matrix.euler_angles(),
        quaternion.euler_angles(),
        quaternion.to_rotation_matrix().euler_angles(),
        (ordered[0], ordered[1], ordered[2]),
    ];
    std::array::from_fn(|way| {
        let (x, y, z) = read[way];
        let distance = matrix.angle_to(&Rotation3::from_euler_angles(x, y, z)).to_degrees();
        if shown {
            let angles = [x, y, z].map(|angle| (angle.to_degrees() * 100.0).round() / 100.0);
            println!("pitch {pitch}° by {}: {angles:?}, {distance:.2}° away", WAYS[way]);
        }
        distance
    })
}

fn main() {
    assert!(away(20.0, -89.9, true).iter().all(|&distance| distance < 0.001));
    let [matrix, quaternion, converted, ordered] = away(20.0, -90.0, true);
    assert!(matrix < 0.001 && quaternion > 5.0 && converted == quaternion && (ordered - 60.0).abs() < 0.01);
    let [matrix, quaternion, _, ordered] = away(20.0, 90.0, true);
    assert!(matrix < 0.001 && quaternion > 2.0 && ordered < 0.01);
    let distances: Vec<f64> = (0..180).map(|roll| away(roll as f64, 90.0, false)[1]).collect();
    let wrong = distances.iter().filter(|&&distance| distance > 1.0).count();
    let worst = distances.iter().copied().fold(0.0, f64::max);
    println!("at 90°, {wrong} of 180 are more than 1° away, up to {worst:.1}°");
    assert!(wrong > 20);
}
RUST
timeout 280 cargo run --quiet
