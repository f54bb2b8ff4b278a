#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tdms-rs 2.0.0 (Rust): of 3000 angles that were appended to a TDMS file, 1000 are read, and interleaved ones are mixed.
#
# By NI's description of the format, writing once more with the same channels appends raw data to the last segment, so
# that it holds several chunks, and a flag says that the channels are interleaved. The crate is to have "full format
# support". Expected, as npTDMS reads both files: 3000 angles of a motor and 3000 of its output. What happens: of each
# segment the first chunk alone is read, without an error, and len() is 1000. Of an interleaved segment, the motor is
# given the first half of all values and the output the second, so that the motor jumps to and fro between the two.
# timestamps() is None although wf_start_time is there, as it wants it as a number, not as a time stamp.
# For us: use npTDMS; a record that ends early, or an output as far as its motor, has no mark of it.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check npTDMS==1.13.0 numpy==2.3.5
mkdir "$folder/src"
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import struct

import numpy as np
from nptdms import TdmsFile

motor = 0.01 * np.arange(3000)
output = motor / 20


def text(value):
    return struct.pack('<I', len(value)) + value.encode()


def channel(name):
    index = struct.pack('<IIIQ', 20, 10, 1, 1000)  # 1000 doubles in a chunk
    start = text('wf_start_time') + struct.pack('<IQq', 68, 0, 3_800_000_000)
    step = text('wf_increment') + struct.pack('<Id', 10, 0.001)
    return text(f"/'Drive'/'{name}'") + index + struct.pack('<I', 2) + start + step


nothing = struct.pack('<II', 0xFFFFFFFF, 0)
metadata = struct.pack('<I', 4) + text('/') + nothing + text("/'Drive'") + nothing + channel('motor') + channel('output')
chunks = b''.join(
    motor[at : at + 1000].tobytes() + output[at : at + 1000].tobytes() for at in (0, 1000, 2000)
)
mixed = np.column_stack((motor, output)).tobytes()
for name, flags, raw in (('appended.tdms', 0b1110, chunks), ('interleaved.tdms', 0b101110, mixed)):
    lead = b'TDSm' + struct.pack('<IIQQ', flags, 4713, len(metadata) + len(raw), len(metadata))
    with open(name, 'wb') as file:
        file.write(lead + metadata + raw)
    drive = TdmsFile.read(name)['Drive']
    assert np.array_equal(drive['motor'][:], motor) and np.array_equal(drive['output'][:], output)
    print(name, 'by npTDMS:', len(drive['motor']), 'angles')
PYTHON
cat > Cargo.toml <<'TOML'
[package]
name = "angles"
version = "0.1.0"
edition = "2021"
[dependencies]
tdms-rs = "=2.0.0"
TOML
cat > src/main.rs <<'RUST'
use tdms_rs::TdmsFile;

fn angles(file: &str, name: &str) -> Vec<f64> {
    let file = TdmsFile::open(file).unwrap();
    let channel = file.group("Drive").unwrap().channel(name).unwrap();
    let mut values = vec![0.0; channel.len()];
    channel.read(0..channel.len(), &mut values).unwrap();
    assert!(channel.timestamps().is_none() && channel.property("wf_start_time").is_some());
    values
}

fn main() {
    let motor = angles("appended.tdms", "motor");
    println!("appended: {} of 3000 angles, the last at {:.2} rad instead of 29.99 rad", motor.len(), motor[motor.len() - 1]);
    assert!(motor.len() == 1000 && (motor[999] - 9.99).abs() < 1e-9);

    let (motor, output) = (angles("interleaved.tdms", "motor"), angles("interleaved.tdms", "output"));
    println!("interleaved: motor at {:?}, output from {:.2} rad", &motor[200..204], output[0]);
    assert!((motor[200] - 1.0).abs() < 1e-9 && (motor[201] - 0.05).abs() < 1e-9 && (motor[202] - 1.01).abs() < 1e-9);
    assert!((output[0] - 5.0).abs() < 1e-9); // an angle of the motor
}
RUST
timeout 280 cargo run --quiet
