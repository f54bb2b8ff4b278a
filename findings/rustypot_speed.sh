#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rustypot 1.13.1 (Rust): a Dynamixel MX or XL-320 that turns clockwise is read as if it turned the other way.
#
# By the manuals the present speed of these servos is 0 to 1023 counterclockwise and 1024 to 2047 clockwise: bit 10 is
# the direction. Expected of dxl_oriented_speed_to_rad_per_sec(), documented for present_speed: values of opposite sign
# for 300 and 1024 + 300. What happens: the direction is looked for in bit 11, which is never set, so that both are
# -3.58 rad/s, and 3.59 rad/s becomes 2348, which is out of the range. xl320_oriented_speed_to_rad_per_sec() gives one
# sign to both too, while the load of an MX is read by bit 10.
# For a Feetech SCS0009 the library itself defines the speed as a magnitude with the sign in bit 15, in steps of
# 300°/1024 per second. Expected: 1500 steps/s are 7.67 rad/s, and -1 rad/s is sent with that bit. What happens: only
# the lower ten bits are read, so that it is 2.43 rad/s (1024 steps/s are 0), and -1 rad/s is sent as 0.
# For us: read the raw register and take the speed yourself, or from two positions and their times.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "speed"
version = "0.1.0"
edition = "2021"
[dependencies]
rustypot = "=1.13.1"
[profile.dev]
debug = false
TOML
cat > src/main.rs <<'RUST'
use rustypot::servo::conversion::Conversion;
use rustypot::servo::dynamixel::{mx::conv as mx, xl320::conv as xl320};
use rustypot::servo::feetech::scs0009::Velocity;

fn main() {
    let round = |value: f64| (value * 100.0).round() / 100.0;
    let speeds = [300, 1024 + 300].map(|raw| round(mx::dxl_oriented_speed_to_rad_per_sec(raw)));
    let small = [300, 1024 + 300].map(|raw| round(xl320::xl320_oriented_speed_to_rad_per_sec(raw)));
    let loads = [300, 1024 + 300].map(|raw| round(mx::dxl_load_to_oriented_torque(raw)));
    let sent = mx::rad_per_sec_to_dxl_oriented_speed(3.59);
    println!("MX: 300 and 1324 are {speeds:?} rad/s, loads of {loads:?} %; 3.59 rad/s is sent as {sent}");
    println!("XL-320: 300 and 1324 are {small:?} rad/s");
    // The register of an SCS0009 has its upper byte first.
    let read = [500_u16, 1024, 1500, 0x8000 + 500].map(|steps| round(Velocity::from_raw(steps.swap_bytes())));
    let written = [1.0, -1.0].map(|speed| Velocity::to_raw(speed).swap_bytes());
    println!("SCS0009: 500, 1024, 1500 and -500 steps/s are {read:?} rad/s; 1 and -1 rad/s are sent as {written:?}");
    assert_eq!((speeds, small), ([-3.58, -3.58], [-3.49, -3.49]));
    assert!(loads[0] == -loads[1] && (2348..2352).contains(&sent));
    assert_eq!(read, [2.56, 0.0, 2.43, -2.56]);
    assert_eq!(written, [195, 0]);
}
RUST
timeout 280 cargo run --quiet --ignore-rust-version
