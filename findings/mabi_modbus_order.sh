#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mabi-modbus 1.7.1 (Rust): the byte orders DC BA and BA DC of its simulated drives are CD AB and AB CD.
#
# A float or a 32-bit position is in two registers, and drives differ in the order of its four bytes. By the table in
# the documentation of WordOrder, 0x12345678 is 0x7856 and 0x3412 in the order DC BA, and 0x3412 and 0x7856 in BA DC.
# What happens: DC BA gives 0x5678 and 0x1234, which is CD AB, and BA DC gives 0x1234 and 0x5678, which is AB CD: the
# bytes are swapped twice. A driver that is tested against such a drive, and made to read 1.5 rad there, reads -2.98 rad
# from a drive that really is in the order DC BA, without an error.
# For us: test drivers with AB CD and CD AB alone, or with written-out registers.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "order"
version = "0.1.0"
edition = "2021"
[dependencies]
mabi-modbus = "=1.7.1"
TOML
cat > src/main.rs <<'RUST'
use mabi_modbus::types::{RegisterConverter, WordOrder};

fn main() {
    let found: Vec<[u16; 2]> = WordOrder::all()
        .iter()
        .map(|&order| {
            let registers = RegisterConverter::new(order).u32_to_registers(0x12345678);
            println!("{}: {:04x} {:04x}", order.short_code(), registers[0], registers[1]);
            registers
        })
        .collect();
    // AB CD, DC BA, CD AB, BA DC.
    assert_eq!(found, [[0x1234, 0x5678], [0x5678, 0x1234], [0x5678, 0x1234], [0x1234, 0x5678]]);
    // A driver that fits the simulated order, and a drive that really answers 1.5 rad in the order DC BA.
    let driver = RegisterConverter::new(WordOrder::LittleEndian);
    let bytes = 1.5_f32.to_le_bytes();
    let answer = [u16::from_be_bytes([bytes[0], bytes[1]]), u16::from_be_bytes([bytes[2], bytes[3]])];
    let simulated = driver.registers_to_f32(&driver.f32_to_registers(1.5));
    let real = driver.registers_to_f32(&answer);
    println!("1.5 rad: {simulated} from the simulated drive, {real} from a real one");
    assert_eq!((simulated, real), (1.5, -2.984375));
}
RUST
timeout 580 cargo run --quiet
