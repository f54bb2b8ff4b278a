#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbags 0.11.9: a drive's status byte of 0x85 in a recording of ROS 2 is read as -123, and cannot be written.
#
# A message of ROS 2 has the fields "byte status" and "byte[] registers". The documentation of ROS 2 gives byte the type
# uint8_t in C++, and DDS calls it an octet, without a sign. A recording with 0x85 and [0x80, 0xFF] is written by
# mcap-ros2-support, which reads these numbers back as 133, 128 and 255. Expected of rosbags: the same. What happens:
# -123 and an array of int8 with -128 and -1, as in ROS 1, where byte is an alias of int8. A test as `status >= 0x80`
# for the fault bit is never true then, without an error. Writing 133 is an error of struct: -128 to 127 are taken.
# uint8 in the same message is right.
# For us: take `status & 0xFF`, and array.view('uint8').
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    rosbags==0.11.9 mcap==1.6.0 mcap-ros2-support==0.6.0 numpy==2.4.6
cd "$folder"
cat > status.py <<'PYTHON'
import pathlib
import struct

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from mcap_ros2.writer import Writer
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

path = pathlib.Path('drive.mcap')
with path.open('wb') as file:
    writer = Writer(file)
    schema = writer.register_msgdef('drive_msgs/msg/Status', 'byte status\nbyte[] registers\nuint8 other')
    message = {'status': 0x85, 'registers': [0x80, 0xFF], 'other': 0x85}
    writer.write_message('/status', schema, message, log_time=0, publish_time=0)
    writer.finish()

with path.open('rb') as file:
    read = next(make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()).decoded_message
print('mcap-ros2-support:', read.status, list(read.registers), read.other)
assert (read.status, list(read.registers), read.other) == (133, [128, 255], 133)

store = get_typestore(Stores.ROS2_JAZZY)
with AnyReader([path], default_typestore=store) as reader:
    connection, _, raw = next(reader.messages())
    found = reader.deserialize(raw, connection.msgtype)
print('rosbags:', found.status, found.registers, found.other)
assert (found.status, found.registers.tolist(), found.registers.dtype.name, found.other) == (
    -123, [-128, -1], 'int8', 133)

Byte = store.types['std_msgs/msg/Byte']
try:
    store.serialize_cdr(Byte(data=0x85), Byte.__msgtype__)
except struct.error as error:
    print('rosbags, written:', error)
else:
    raise SystemExit('0x85 is written')
PYTHON
timeout 60 venv/bin/python status.py
