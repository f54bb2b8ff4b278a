#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tdms 0.3.0 (Rust): once a property of the output changes in a recording, the motor's angles are read as its own.
#
# A TDMS file consists of segments. One that does not begin a new list of objects names only the channels at which
# something changed; the others go on as before, by National Instruments' description of the format. Expected of a file
# with a motor and an output whose second segment gives the output a unit: four angles each, as npTDMS reads them. What
# happens: only the named channels are looked for, so that the motor has its first two angles, and the output has six,
# two of which are the motor's 3 and 4 rad. Of a second segment without any metadata both channels lose their angles. In
# neither case is there an error. The channels "speed in 1/s" and "speed in 1/min" are one, with the numbers of the
# second, since a / is taken as the end of a name within its quotes, too. For us: read such files with npTDMS.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check npTDMS==1.13.0 numpy==2.4.6
cat > Cargo.toml <<'TOML'
[package]
name = "read"
version = "0.1.0"
edition = "2021"
[dependencies]
tdms = "=0.3.0"
TOML
cat > src/main.rs <<'RUST'
use std::path::Path;
use tdms::TDMSFile;

fn main() {
    for name in std::env::args().skip(1) {
        let file = TDMSFile::from_path(Path::new(&name)).unwrap();
        for (channel, found) in file.channels("joint") {
            let values: Vec<f64> = file.channel_data_double_float(found).unwrap().collect();
            println!("{name} {channel}: {values:?}");
        }
    }
}
RUST
cat > write.py <<'PYTHON'
import struct
import sys

from nptdms import ChannelObject, TdmsFile, TdmsWriter

METADATA, NEW_OBJECTS, RAW = 2, 4, 8
SAME, NONE = struct.pack('<I', 0), struct.pack('<I', 0xFFFFFFFF)
TWO_DOUBLES = struct.pack('<IIIQ', 20, 10, 1, 2)


def text(value):
    return struct.pack('<I', len(value)) + value.encode()


def thing(path, index, **properties):
    """The metadata of an object: its path, how its raw data lie, and its properties as strings."""
    listed = b''.join(text(name) + struct.pack('<I', 0x20) + text(value) for name, value in properties.items())
    return text(path) + index + struct.pack('<I', len(properties)) + listed


def segment(contents, objects, values):
    metadata = struct.pack('<I', len(objects)) + b''.join(objects) if contents & METADATA else b''
    raw = struct.pack(f'<{len(values)}d', *values)
    return b'TDSm' + struct.pack('<IIQQ', contents, 4713, len(metadata) + len(raw), len(metadata)) + metadata + raw


motor, output = "/'joint'/'motor'", "/'joint'/'output'"
objects = [thing('/', NONE), thing("/'joint'", NONE), thing(motor, TWO_DOUBLES), thing(output, TWO_DOUBLES)]
first = segment(METADATA | NEW_OBJECTS | RAW, objects, [1, 2, -0.1, -0.2])
more = [3, 4, -0.3, -0.4]
files = {
    'whole.tdms': first + segment(METADATA | RAW, [thing(motor, SAME), thing(output, SAME)], more),
    'unit.tdms': first + segment(METADATA | RAW, [thing(output, SAME, unit_string='rad')], more),
    'plain.tdms': first + segment(RAW, [], more),
}
for name, contents in files.items():
    with open(name, 'wb') as file:
        file.write(contents)
    channels = {channel.name: channel[:].tolist() for channel in TdmsFile.read(name)['joint'].channels()}
    assert channels == {'motor': [1, 2, 3, 4], 'output': [-0.1, -0.2, -0.3, -0.4]}, channels
with TdmsWriter('names.tdms') as writer:
    speeds = {'speed in 1/s': [1.0, 2.0], 'speed in 1/min': [60.0, 120.0]}
    writer.write_segment([ChannelObject('joint', name, values) for name, values in speeds.items()])
sys.stdout.write(' '.join([*files, 'names.tdms']))
PYTHON
names=$(venv/bin/python write.py)
timeout 280 cargo build --quiet
timeout 20 target/debug/read $names | tee found
cat > expected <<'TEXT'
whole.tdms motor: [1.0, 2.0, 3.0, 4.0]
whole.tdms output: [-0.1, -0.2, -0.3, -0.4]
unit.tdms motor: [1.0, 2.0]
unit.tdms output: [-0.1, -0.2, 3.0, 4.0, -0.3, -0.4]
plain.tdms motor: [1.0, 2.0]
plain.tdms output: [-0.1, -0.2]
names.tdms speed in 1: [60.0, 120.0]
TEXT
diff expected found
