#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-rs 0.10.0 (Rust): a motor without limits has an effort and a speed of 0 once its URDF is saved, and its gear is
# lost.
#
# A continuous joint needs no <limit>, and a link without <inertial> is a frame. Expected of read_from_string() and
# write_to_string(): the same robot. What happens: what the file does not have is written with zeros. The motor gets a
# limit of effort 0 and velocity 0, with which a simulator holds it still, and the frame an <inertial> of mass 0, which
# others refuse or take as a massless body. The <transmission> with its reduction of 20 is missing. The mimic stays.
# For us: keep the file that was read, or give each motor limits and each link an inertia before it is read.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "saved"
version = "0.1.0"
edition = "2021"
[dependencies]
urdf-rs = "=0.10.0"
TOML
cat > src/main.rs <<'RUST'
const URDF: &str = r#"<robot name="gear"><link name="frame"/>
  <link name="rotor"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="output"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="frame"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="shaft" type="continuous"><parent link="frame"/><child link="output"/><axis xyz="0 0 1"/>
    <mimic joint="motor" multiplier="0.05"/></joint>
  <transmission name="gear"><type>transmission_interface/SimpleTransmission</type><joint name="motor"/>
    <actuator name="drive"><mechanicalReduction>20</mechanicalReduction></actuator></transmission></robot>"#;

fn main() {
    let saved = urdf_rs::write_to_string(&urdf_rs::read_from_string(URDF).unwrap()).unwrap();
    println!("{saved}");
    assert!(!URDF.contains("<limit") && saved.matches(r#"<limit lower="0" upper="0" effort="0" velocity="0"/>"#).count() == 2);
    assert!(saved.matches("<inertial>").count() == 3 && saved.contains(r#"<mass value="0"/>"#));
    assert!(!saved.contains("mechanicalReduction") && !saved.contains("transmission"));
    assert!(saved.contains(r#"<mimic joint="motor" multiplier="0.05"/>"#));
}
RUST
timeout 280 cargo run --quiet
