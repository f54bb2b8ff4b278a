#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nabled-kinematics 0.0.11 (Rust): by modified DH parameters, a shoulder that bears 4.5 N·m has 0 N·m by the Jacobian.
#
# An arm with a vertical joint, a shoulder, an elbow and a wrist is given by standard and by modified DH parameters,
# with the same angles and the same tip. Expected of jacobian() in both: each column is how the tip moves if its joint
# turns, as fk() tells, so that a mass of 1 kg at the tip loads the shoulder with 4.51 N·m and the elbow with 1.92 N·m.
# What happens: by standard parameters it is so; by modified ones the column of each joint is that of the joint before
# it, as the axis of a joint is taken from the frame before its link for both conventions: the shoulder has 0 N·m, the
# elbow 4.51 N·m and the wrist, at the tip, 1.92 N·m.
# Output: Standard: tip at 0.439 0.136 0.604
#           load of 1 kg in N·m: by jacobian() 0.00 4.51 1.92 0.00, by fk() 0.00 4.51 1.92 0.00
#         Modified: tip at 0.439 0.136 0.604
#           load of 1 kg in N·m: by jacobian() 0.00 0.00 4.51 1.92, by fk() 0.00 4.51 1.92 0.00
# For us: give an arm by standard parameters.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "arm"
version = "0.1.0"
edition = "2021"
[dependencies]
nabled-kinematics = "=0.0.11"
ndarray = "=0.17.2"
TOML
cat > src/main.rs <<'RUST'
use nabled_kinematics::{fk::fk, jacobian::jacobian, ChainSpec, DhConvention, JointType};
use ndarray::{arr1, Array1};
use std::f64::consts::FRAC_PI_2;

fn arm(convention: DhConvention) -> ChainSpec<f64> {
    let (a, alpha) = match convention {
        DhConvention::Standard => ([0.0, 0.3, 0.2, 0.0], [FRAC_PI_2, 0.0, 0.0, 0.0]),
        DhConvention::Modified => ([0.0, 0.0, 0.3, 0.2], [0.0, FRAC_PI_2, 0.0, 0.0]),
    };
    let (joints, d) = (vec![JointType::Revolute; 4], arr1(&[0.5, 0.0, 0.0, 0.0]));
    ChainSpec::from_dh(convention, joints, arr1(&a), arr1(&alpha), d, Array1::zeros(4)).unwrap()
}

fn text(values: impl Iterator<Item = f64>, digits: usize) -> String {
    values.map(|value| format!("{:.digits$}", value + 1e-9)).collect::<Vec<_>>().join(" ")
}

fn main() {
    let angles = arr1(&[0.3, 0.5, -0.7, 0.4]);
    for (convention, expected) in [
        (DhConvention::Standard, "0.00 4.51 1.92 0.00"),
        (DhConvention::Modified, "0.00 0.00 4.51 1.92"),
    ] {
        let arm = arm(convention);
        let tip = fk(&arm, &angles).unwrap().translation;
        let load = text(jacobian(&arm, &angles).unwrap().row(2).iter().map(|lever| 9.81 * lever), 2);
        let moved = (0..4).map(|joint| {
            let mut turned = angles.clone();
            turned[joint] += 1e-7;
            9.81 * (fk(&arm, &turned).unwrap().translation[2] - tip[2]) / 1e-7
        });
        let by_fk = text(moved, 2);
        println!("{convention:?}: tip at {}", text(tip.iter().copied(), 3));
        println!("  load of 1 kg in N·m: by jacobian() {load}, by fk() {by_fk}");
        assert_eq!((load.as_str(), by_fk.as_str()), (expected, "0.00 4.51 1.92 0.00"));
    }
}
RUST
timeout 170 cargo run --quiet
