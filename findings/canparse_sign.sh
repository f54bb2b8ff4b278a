#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canparse 0.1.4 (Rust): by a .dbc, a torque of -5 N·m is read as 650.36 N·m, and 10 N·m of Motorola's order as 532.48.
#
# Two drives send parameter groups of their own over J1939. Expected of a torque whose sign in the .dbc is "-": -5 N·m.
# What happens: the sign of the .dbc is kept in the definition, but not used: -5 N·m is read as 650.36 N·m, and -20 rad
# as 429476.7 rad. Expected of a torque of 10 N·m in the byte order of Motorola, "@0", whose start bit in a .dbc is the
# highest bit of the signal: 10 N·m. What happens: 532.48 N·m, as the start bit is counted as that of a number of 64
# bits, from its lowest bit. A speed without a sign, in the byte order of Intel, is right.
# For us: decode with another library, as cantools, unless all signals are without signs and of Intel's byte order.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "sign"
version = "0.1.0"
edition = "2021"
[dependencies]
canparse = "=0.1.4"
TOML
cat > drives.dbc <<'DBC'
VERSION ""

NS_ :

BS_:

BU_: Drive1 Drive2 Master

BO_ 2566848513 Axis: 8 Drive1
 SG_ Torque : 0|16@1- (0.01,0) [-327.68|327.67] "Nm" Master
 SG_ Position : 16|32@1- (0.0001,0) [-214748|214748] "rad" Master

BO_ 2566848770 Load: 8 Drive2
 SG_ Speed : 0|16@1+ (0.1,0) [0|6553.5] "rpm" Master
 SG_ Load : 23|16@0+ (0.01,0) [0|655.35] "Nm" Master
DBC
cat > src/main.rs <<'RUST'
use canparse::pgn::{ParseMessage, PgnLibrary};

fn main() {
    let library = PgnLibrary::from_dbc_file("drives.dbc").unwrap();
    let read = |name: &str, bytes: &[u8; 8]| library.get_spn(name).unwrap().parse_message(bytes).unwrap();

    // Axis with -5 N·m and -20 rad.
    let mut axis = [0; 8];
    axis[..2].copy_from_slice(&(-500i16).to_le_bytes());
    axis[2..6].copy_from_slice(&(-200_000i32).to_le_bytes());
    let (torque, position) = (read("Torque", &axis), read("Position", &axis));
    println!("-5 N·m: {torque} N·m; -20 rad: {position} rad");
    assert!((torque - 650.36).abs() < 1e-3 && (position - 429476.7).abs() < 0.1);

    // Load with 100 rpm and 10 N·m.
    let mut load = [0; 8];
    load[..2].copy_from_slice(&1000u16.to_le_bytes());
    load[2..4].copy_from_slice(&1000u16.to_be_bytes());
    let (speed, torque) = (read("Speed", &load), read("Load", &load));
    println!("100 rpm: {speed} rpm; 10 N·m in Motorola's byte order: {torque} N·m");
    assert!(speed == 100.0 && (torque - 532.48).abs() < 1e-3);
}
RUST
timeout 280 cargo run --quiet
