#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canparse 0.1.4 (Rust): by a .dbc, a position of one axis is read with the bits of another's, and -5 N·m as 650.36 N·m.
#
# Two drives send their positions with the identifiers 0x181 and 0x182, one behind a torque of 16 bits, the other at its
# first bit. Expected: a definition for each message, or an error. What happens: messages are put together if their
# identifiers only differ in the last byte, as the source addresses of J1939 do, also where the .dbc has standard
# identifiers. Of two signals of one name, the last one counts: 20 rad of the first axis are read as 22236.3 rad.
# Expected of a signal whose sign in the .dbc is "-": -5 N·m. What happens: the sign is read, but not used: 650.36 N·m.
# Expected of a torque of 10 N·m in the byte order of Motorola, "@0": 10 N·m. What happens: 532.48 N·m, as its start
# bit is counted from the other end. A speed without a sign, in the byte order of Intel, is right.
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
name = "axes"
version = "0.1.0"
edition = "2021"
[dependencies]
canparse = "=0.1.4"
TOML
cat > axes.dbc <<'DBC'
VERSION ""

NS_ :

BS_:

BU_: Drive1 Drive2 Master

BO_ 385 Axis1: 8 Drive1
 SG_ Torque : 0|16@1- (0.01,0) [-327.68|327.67] "Nm" Master
 SG_ Position : 16|32@1- (0.0001,0) [-214748|214748] "rad" Master

BO_ 386 Axis2: 8 Drive2
 SG_ Position : 0|32@1- (0.0001,0) [-214748|214748] "rad" Master

BO_ 641 Axis1Load: 8 Drive1
 SG_ Speed : 0|16@1+ (0.1,0) [0|6553.5] "rpm" Master
 SG_ Load : 23|16@0+ (0.01,0) [0|655.35] "Nm" Master
DBC
cat > src/main.rs <<'RUST'
use canparse::pgn::{ParseMessage, PgnLibrary};

fn main() {
    let library = PgnLibrary::from_dbc_file("axes.dbc").unwrap();
    let read = |name: &str, bytes: &[u8; 8]| library.get_spn(name).unwrap().parse_message(bytes).unwrap();

    // Axis1 with -5 N·m and 20 rad.
    let mut axis = [0; 8];
    axis[..2].copy_from_slice(&(-500i16).to_le_bytes());
    axis[2..6].copy_from_slice(&200_000i32.to_le_bytes());
    let (torque, position) = (read("Torque", &axis), read("Position", &axis));
    println!("-5 N·m: {torque} N·m; 20 rad of the first axis: {position} rad");
    assert!((torque - 650.36).abs() < 1e-3 && (position - 22236.314).abs() < 0.1);

    // Axis1Load with 100 rpm and 10 N·m.
    let mut load = [0; 8];
    load[..2].copy_from_slice(&1000u16.to_le_bytes());
    load[2..4].copy_from_slice(&1000u16.to_be_bytes());
    let (speed, torque) = (read("Speed", &load), read("Load", &load));
    println!("100 rpm: {speed} rpm; 10 N·m in Motorola's byte order: {torque} N·m");
    assert!(speed == 100.0 && (torque - 532.48).abs() < 1e-3);
}
RUST
timeout 280 cargo run --quiet
