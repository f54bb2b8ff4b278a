#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oze-canopen 0.1.0 (Rust): the emergency of a drive that is too hot (0x4210) is read as "GenericError", 0x5441 as heat.
#
# An emergency message of CANopen begins with the error code in 16 bits, of which the low byte comes first, as all
# numbers of CiA 301; its high byte is the class: 0x23 current, 0x32 voltage, 0x42 temperature. Expected of Emcy: its
# "code", a field whose values are these classes, is the high byte. What happens: it is the low byte, the class is in
# "vendor_code". An over-current (0x2310) and a temperature (0x4210) are generic errors, an undervoltage (0x3220) is a
# current, a lost heartbeat (0x8130) is a voltage, a contact in the power section (0x5441) is an ambient temperature,
# and the fault of an encoder (0x7305) cannot be read at all: Emcy::read() gives an error.
# For us: take vendor_code as the class, or read the first two bytes as a little-endian number yourself.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "emergency"
version = "0.1.0"
edition = "2021"
[dependencies]
binrw = "=0.14.2"
oze-canopen = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use binrw::BinRead;
use oze_canopen::proto::emcy::{Emcy, EmcyCode};
use std::io::Cursor;

fn main() {
    let expected = [
        (0x0000, Some(EmcyCode::NoError)),
        (0x2310, Some(EmcyCode::GenericError)),
        (0x4210, Some(EmcyCode::GenericError)),
        (0x3220, Some(EmcyCode::Current)),
        (0x8130, Some(EmcyCode::Voltage)),
        (0x5441, Some(EmcyCode::TemperatureAmbient)),
        (0x7305, None),
    ];
    for (code, expected) in expected {
        let [low, high] = u16::to_le_bytes(code);
        let read = Emcy::read(&mut Cursor::new([low, high, 1, 0, 0, 0, 0, 0])).ok();
        println!("{code:#06x}: {read:?}");
        assert_eq!(read.map(|read| read.code), expected);
        assert!(read.is_none_or(|read| read.vendor_code == high && read.error_register == 1));
    }
}
RUST
timeout 400 cargo run --quiet
