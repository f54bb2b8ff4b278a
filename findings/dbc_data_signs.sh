#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dbc-data 0.1.13 (Rust): a torque of 8 is read as -8, and the lowest speed in a .dbc is 0 instead of -3000.
#
# By a .dbc a drive sends a torque of 8 bits with a sign, that begins in the middle of a byte, and a speed of 16 bits
# with the range -3000 to 3000; a second torque lies in the same way in Motorola's byte order.
# Expected: what is encoded is decoded again, as cantools 45.1.0 does, and SPEED_MIN is -3000.
# What happens: the byte with the lower four bits of the torque is shifted as one with a sign, so that its upper bits
# are filled wherever bit 3 of the torque is set. 8 is read as -8, 31 as -1, 120 as -8; 7, 16 and -1 are right, as is a
# torque of 12 bits. Half of all values from 0 to 127 are wrong. Each lower limit below zero of a signal without a
# factor becomes 0, so that a speed which is kept within SPEED_MIN and SPEED_MAX never goes backward.
# For us: decode a signal with a sign and up to 8 bits that crosses bytes by hand, and write its limits down yourself.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "signs"
version = "0.1.0"
edition = "2021"
[dependencies]
dbc-data = "=0.1.13"
[profile.dev]
debug = false
TOML
cat > drive.dbc <<'DBC'
VERSION ""

NS_ :

BS_:

BU_: Drive

BO_ 256 Joint: 8 Drive
 SG_ Torque : 4|8@1- (1,0) [-128|127] "" Vector__XXX
 SG_ Speed : 16|16@1- (1,0) [-3000|3000] "" Vector__XXX
 SG_ Motorola : 35|8@0- (1,0) [-128|127] "" Vector__XXX
 SG_ Wide : 52|12@1- (1,0) [-2048|2047] "" Vector__XXX
DBC
cat > src/main.rs <<'RUST'
#![allow(non_snake_case, dead_code)]
use dbc_data::DbcData;

#[derive(DbcData)]
#[dbc_file = "drive.dbc"]
enum Messages {
    Joint,
}

fn main() {
    // The bytes of one value for Torque, Motorola and Wide, and a speed of 0.
    let decoded = |value: i8| {
        let bits = (value as u8 as u16) << 4;
        let wide = (value as i16 as u16) << 4;
        let mut joint = Joint::default();
        let [low, high] = bits.to_le_bytes();
        let [wide_low, wide_high] = wide.to_le_bytes();
        assert!(joint.decode(&[low, high, 0, 0, high, low, wide_low, wide_high]));
        (joint.Torque, joint.Motorola, joint.Wide)
    };
    let mut wrong = 0;
    for value in i8::MIN..=i8::MAX {
        let (torque, motorola, wide) = decoded(value);
        assert_eq!((torque, wide), (motorola, value.into()));
        if value >= 0 && torque != value {
            wrong += 1;
        }
        let mut joint = Joint::default();
        joint.Torque = value;
        let mut bytes = [0; 8];
        joint.encode(&mut bytes);
        assert_eq!(u16::from_le_bytes([bytes[0], bytes[1]]), (value as u8 as u16) << 4);
    }
    let some: Vec<_> = [7, 8, 16, 31, 120, -1].iter().map(|&value| decoded(value).0).collect();
    println!("7, 8, 16, 31, 120 and -1 are read as {some:?}, {wrong} of 128 are wrong;");
    println!("the speed is from {} to {}", Joint::SPEED_MIN, Joint::SPEED_MAX);
    assert_eq!(some, [7, -8, 16, -1, -8, -1]);
    assert_eq!((wrong, Joint::SPEED_MIN, Joint::SPEED_MAX), (64, 0, 3000));
}
RUST
timeout 280 cargo run --quiet --ignore-rust-version
