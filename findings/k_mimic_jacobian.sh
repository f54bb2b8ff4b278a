#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# k 0.32.0 (Rust): a mimic follows its motor, but the Jacobian takes it as an independent joint.
#
# A tip mimics its motor by -0.5. Expected: one degree of freedom, and a tip that turns by 1 - 0.5 = 0.5 rad for each
# rad of the motor. What happens: dof() is 2. set_joint_positions([0.4, 0]) rightly puts the tip at -0.2 and ignores the
# second value; but jacobian() has a column for each of the two, and that of the motor is 1 rad for each rad. A speed or
# a torque that is computed with it is wrong by a factor of 2 here.
# For us: multiply the Jacobian by the derivatives of all joints with respect to the motor, here (1, -0.5).
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "mimic"
version = "0.1.0"
edition = "2021"
[dependencies]
k = "=0.32.0"
urdf-rs = "=0.9.1"
TOML
cat > src/main.rs <<'RUST'
const URDF: &str = r#"<robot name="gear"><link name="stator"/><link name="rotor"/><link name="hand"/>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="tip" type="revolute"><parent link="rotor"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="motor" multiplier="-0.5"/></joint></robot>"#;

fn turn(arm: &k::SerialChain<f64>, motor: f64) -> f64 {
    arm.set_joint_positions(&[motor, 0.0]).unwrap();
    arm.update_transforms();
    arm.end_transform().rotation.euler_angles().2
}

fn main() {
    let chain = k::Chain::<f64>::from(&urdf_rs::read_from_string(URDF).unwrap());
    let arm = k::SerialChain::from_end(chain.find("tip").unwrap());
    let turned = (turn(&arm, 0.6) - turn(&arm, 0.4)) / 0.2;
    let columns: Vec<f64> = k::jacobian(&arm).row(5).iter().cloned().collect();
    println!("dof {}, measured {turned}, Jacobian {columns:?}, positions {:?}", arm.dof(), arm.joint_positions());
    assert!((turned - 0.5).abs() < 1e-9 && arm.dof() == 2);
    assert!(columns.iter().all(|column| (column - 1.0).abs() < 1e-9));
    assert_eq!(arm.joint_positions(), [0.4, -0.2]);
}
RUST
timeout 280 cargo run --quiet
