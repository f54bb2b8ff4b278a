#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# j1939 0.3.0 (Rust): a torque of -40 % is read as 0 %, a speed whose sensor has failed as 8031 rpm, a pedal at half
# way as at 0 %.
#
# By SAE J1939-71 a torque is a byte in percent from -125 % on, a speed two bytes in steps of 1/8 rpm of which 0xFE00 to
# 0xFEFF tell an error of the sensor, and the first accelerator pedal a byte in steps of 0.4 % from 0 % on. Expected of
# EEC1 with 85 as the actual torque: -40 %. What happens: it is given as an unsigned number, so that each braking torque
# is 0 %, with Some(0), and a retarder looks idle. Only 0xFFFF is taken as a speed that is not there: the error of the
# sensor is the greatest speed, 8031 rpm, that of a torque 125 %, and of 1500.875 rpm 1500 are left. In EEC2 the pedal
# is decoded as if it were a torque: 50 % is read as 0 %, and 100 % as 125 %. Nothing warns.
# For us: decode these bytes yourself; pdu() of a Frame gives them.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir src
cat > Cargo.toml <<'TOML'
[package]
name = "torque"
version = "0.1.0"
edition = "2021"

[dependencies]
j1939 = "=0.3.0"
TOML
cat > src/main.rs <<'RUST'
use j1939::spn::{ElectronicEngineController1Message as Eec1, ElectronicEngineController2Message as Eec2};

/// Return the actual torque in percent and the speed in rpm of an EEC1 with these raw values.
fn read(torque: u8, speed: u16) -> (Option<u8>, Option<u16>) {
    let [low, high] = speed.to_le_bytes();
    let message = Eec1::from_pdu(&[0xF0, torque, torque, low, high, 0x00, 0xFF, 0xFF]);
    (message.actual_engine, message.rpm)
}

fn pedal(raw: u8) -> Option<u8> {
    Eec2::from_pdu(&[0xFF, raw, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]).accelerator_pedal_position1
}

fn main() {
    let driving = read(125 + 40, 1500 * 8);
    let braking = read(125 - 40, 1500 * 8 + 7);
    let failed = read(0xFE, 0xFE00);
    let absent = read(0xFF, 0xFFFF);
    let pedals = [0, 50, 100].map(|percent| pedal((percent as f32 / 0.4) as u8));
    println!("40 % at 1500 rpm: {driving:?}; -40 % at 1500.875 rpm: {braking:?}");
    println!("both sensors failed: {failed:?}; not there: {absent:?}; the pedal at 0, 50 and 100 %: {pedals:?}");
    assert_eq!(driving, (Some(40), Some(1500)));
    assert_eq!(braking, (Some(0), Some(1500)));
    assert_eq!(failed, (Some(125), Some(8031)));
    assert_eq!(absent, (None, None));
    assert_eq!(pedals, [Some(0), Some(0), Some(125)]);
}
RUST
cargo build --quiet 2> build.log || { cat build.log; exit 1; }
timeout 60 target/debug/torque
