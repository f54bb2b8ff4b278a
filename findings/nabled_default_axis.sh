#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nabled-model 0.0.11 (Rust): a joint of a URDF without an axis turns about z instead of x, and a turned inertia is not.
#
# By the specification of URDF, the axis of a joint is (1, 0, 0) if the element is left out. A tip 0.3 m along y of a
# shoulder without an axis is turned by 90°. Expected: (0, 0, 0.3), as it is found where the URDF has the axis. What
# happens: (-0.3, 0, 0), as of an axis along z. The same arm has an inertia of 0.01, 0.02 and 0.03 kg·m², given in axes
# that an rpy of 90° turns about z. Expected in the axes of the link: 0.02, 0.01 and 0.03. What happens: 0.01, 0.02 and
# 0.03, as the rpy of an inertial is not read.
# For us: write each axis, also (1, 0, 0), and give inertias in the axes of the link, with an rpy of 0.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "axis"
version = "0.1.0"
edition = "2021"
[dependencies]
nabled-kinematics = "=0.0.11"
nabled-model = "=0.0.11"
ndarray = "0.17"
TOML
cat > src/main.rs <<'RUST'
use nabled_kinematics::tree::end_effector_pose_tree;
use nabled_model::urdf::from_urdf_str;
use ndarray::arr1;

/// An arm whose shoulder has this element as its axis.
fn arm(axis: &str) -> String {
    format!(
        r#"<robot name="arm"><link name="base"/>
             <link name="upper"><inertial><origin xyz="0 0 0" rpy="0 0 1.57079632679"/><mass value="1"/>
               <inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
             <link name="tip"/>
             <joint name="shoulder" type="continuous">
               <origin xyz="0 0 0"/><parent link="base"/><child link="upper"/>{axis}</joint>
             <joint name="end" type="fixed">
               <origin xyz="0 0.3 0"/><parent link="upper"/><child link="tip"/></joint></robot>"#
    )
}

/// The position of the tip in m where the shoulder stands at 90°, rounded to 1 mm.
fn tip(axis: &str) -> [f64; 3] {
    let model = from_urdf_str::<f64>(&arm(axis)).unwrap();
    let quarter = arr1(&[std::f64::consts::FRAC_PI_2]);
    let pose = end_effector_pose_tree(&model, "base", "tip", &quarter).unwrap();
    [0, 1, 2].map(|row| (pose.translation[row] * 1000.0).round() / 1000.0 + 0.0)
}

fn main() {
    let (given, left_out) = (tip(r#"<axis xyz="1 0 0"/>"#), tip(""));
    println!("tip with the axis {given:?}, without it {left_out:?}");
    assert!(given == [0.0, 0.0, 0.3] && left_out == [-0.3, 0.0, 0.0]);
    let model = from_urdf_str::<f64>(&arm("")).unwrap();
    let inertia = model.joint(0).unwrap().inertial.clone().unwrap().inertia.diag().to_vec();
    println!("inertia {inertia:?} kg·m², expected [0.02, 0.01, 0.03] kg·m²");
    assert_eq!(inertia, [0.01, 0.02, 0.03]);
}
RUST
timeout 580 cargo run --quiet
