#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vesc-api 0.1.1 (Rust): a VESC whose motor is too hot has no fault, and its position is always 0°.
#
# Expected: fault_code, pid_pos and vesc_id of get_values() are those that a VESC sends behind its tachometers. What
# happens: the decoder stops there, and leaves the fault at None, the position at 0 and the identifier at 0, also
# where the motor was switched off for OverTempMotor (6) at 123.5°. The values before are right. A pseudo-terminal
# answers here as COMM_GET_VALUES of the VESC firmware does.
# For us: a fault of None from this library is no statement; compare temp_motor and current_motor with their limits.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "fault"
version = "0.1.0"
edition = "2021"
[dependencies]
vesc-api = "=0.1.1"
TOML
cat > src/main.rs <<'RUST'
use vesc_api::{BaudRate, PacketData, Vesc};

fn main() {
    let mut vesc = Vesc::new(&std::env::args().nth(1).unwrap(), BaudRate::Baud115200).unwrap();
    let PacketData::Values(values) = vesc.get_values().unwrap();
    println!("decoded {values}");
    assert_eq!((values.temp_motor, values.rpm, values.tachometer), (120.5, -49000.0, -6));
    assert_eq!((format!("{:?}", values.fault_code), values.pid_pos, values.vesc_id), ("None".into(), 0.0, 0));
}
RUST
timeout 280 cargo build --quiet
timeout 60 python3 - <<'PYTHON'
import binascii
import os
import pty
import struct
import subprocess
import threading
import tty

device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)
values = struct.pack('>hhiiiihihiiiiii', 405, 1205, 3000, 2000, 0, 3000, 250, -49000, 241, 0, 0, 0, 0, -6, 6)
payload = b'\x04' + values + struct.pack('>BiB', 6, 123500000, 7)


def answer():
    request = b''
    while len(request) < 6:
        request += os.read(device, 64)
    os.write(device, bytes([2, len(payload)]) + payload + struct.pack('>HB', binascii.crc_hqx(payload, 0), 3))


threading.Thread(target=answer, daemon=True).start()
subprocess.run(['target/debug/fault', os.ttyname(host)], check=True, timeout=50)
PYTHON
