#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cgmath 0.18.0 (Rust): a flange that is tilted by 87° is read as tilted by 90°, and its other two angles as 0° and
# 29.5° instead of 20° and 10°.
#
# Expected of Euler::from(Quaternion) of an Euler { x: 20°, y: 87°, z: 10° }: the same angles, and the one case without
# a unique answer at y = 90°. What happens: from 86.4° on, where the sine is above 0.998, y is 90°, x is 0 and z is the
# rest, a pose that is up to 3.6° away. A joint that moves slowly through 86.4° jumps by 3.6°, and its angles by 20°. At
# 86° it is exact.
# For us: keep the orientation of a flange as a quaternion, and show its angles only up to a tilt of 86°.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "pitch"
version = "0.1.0"
edition = "2021"
[dependencies]
cgmath = "=0.18.0"
TOML
cat > src/main.rs <<'RUST'
use cgmath::{Deg, Euler, InnerSpace, Quaternion, Rad};

/// The Euler angles, °, that are read back, and by how many degrees their pose is away.
fn read(y: f64) -> (f64, f64, f64, f64) {
    let pose = Quaternion::from(Euler { x: Deg(20.0), y: Deg(y), z: Deg(10.0) });
    let angles: Euler<Rad<f64>> = Euler::from(pose);
    let away = 2.0 * pose.dot(Quaternion::from(angles)).abs().min(1.0).acos().to_degrees();
    let (x, tilt, z) = (angles.x.0.to_degrees(), angles.y.0.to_degrees(), angles.z.0.to_degrees());
    println!("20°, {y}°, 10° are read as {x:.2}°, {tilt:.2}°, {z:.2}°, {away:.3}° away");
    (x, tilt, z, away)
}

fn main() {
    for exact in [0.0, 80.0, 86.0] {
        let (x, tilt, z, _) = read(exact);
        assert!((x - 20.0).abs() < 1e-6 && (tilt - exact).abs() < 1e-6 && (z - 10.0).abs() < 1e-6);
    }
    for (tilted, expected) in [(86.5, 3.5), (87.0, 3.0), (89.0, 1.0)] {
        let (x, tilt, z, away) = read(tilted);
        assert!(x == 0.0 && (tilt - 90.0).abs() < 1e-9 && (z - 29.7).abs() < 0.5);
        assert!((away - expected).abs() < 0.1);
    }
}
RUST
timeout 280 cargo run --quiet
