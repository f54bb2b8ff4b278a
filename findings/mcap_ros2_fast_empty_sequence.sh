#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap-ros2-support-fast 0.8.0: behind an empty sequence of points, 1.5 rad are read as 0, and written wrongly.
#
# A message of ROS 2 has geometry_msgs/Point[] contacts, float64 position and float64 effort. With 0, 1 and 2 contacts,
# a position of 1.5 rad and an effort of -2.25 N·m, it is serialized by mcap-ros2-support; rosbags serializes it to the
# same bytes. Expected of the decoder of mcap-ros2-support-fast: these numbers. What happens: without contacts, the
# position is 0 and the effort 5.3e-315, without an error; with one or two contacts both are right. As a Point ends with
# a float64, the decoder takes the place behind the sequence as aligned to 8 bytes, also where there is no Point. Its
# encoder leaves out the same four bytes, so that it and its decoder agree: what it writes is read back as 1.5 rad by
# its own decoder, and neither mcap-ros2-support nor rosbags can read it.
# For us: read and write recordings of own messages by mcap-ros2-support or rosbags. A JointState has no such field.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mcap-ros2-support-fast==0.8.0 ros-parser==0.9.0 mcap-ros2-support==0.6.0 mcap==1.6.0 rosbags==0.11.9 numpy==2.4.6
cat > "$folder/joint.py" <<'PYTHON'
from types import SimpleNamespace

import mcap_ros2._dynamic as mcap_ros2
from mcap_ros2_support_fast.decoder import DecoderFactory
from mcap_ros2_support_fast.writer import ROS2EncoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

NAME = 'gear_msgs/msg/Joint'
TEXT = 'geometry_msgs/Point[] contacts\nfloat64 position\nfloat64 effort'
POINT = '\n' + 80 * '=' + '\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n'
SCHEMA = SimpleNamespace(id=1, name=NAME, encoding='ros2msg', data=(TEXT + POINT).encode())
decode = DecoderFactory().decoder_for('cdr', SCHEMA)
encode = ROS2EncoderFactory().encoder_for(SCHEMA)
serialize = mcap_ros2.serialize_dynamic(NAME, TEXT + POINT)[NAME]
deserialize = mcap_ros2.generate_dynamic(NAME, TEXT + POINT)[NAME]
store = get_typestore(Stores.ROS2_JAZZY)
store.register(get_types_from_msg(TEXT, NAME))
Joint, Point = store.types[NAME], store.types['geometry_msgs/msg/Point']

for contacts in 0, 1, 2:
    points = contacts * [{'x': 0.1, 'y': 0.2, 'z': 0.3}]
    message = {'contacts': points, 'position': 1.5, 'effort': -2.25}
    data = serialize(message)
    other = Joint(contacts=[Point(**point) for point in points], position=1.5, effort=-2.25)
    assert bytes(store.serialize_cdr(other, NAME)) == data
    right, fast = deserialize(data), decode(data)
    print(f'{contacts} contacts: {right.position} and {right.effort}, fast: {fast.position} and {fast.effort}')
    assert (right.position, right.effort) == (1.5, -2.25)
    if contacts:
        assert (fast.position, fast.effort) == (1.5, -2.25) and bytes(encode(message)) == data
        continue
    assert fast.position == 0 and 0 < fast.effort < 1e-300

    written = bytes(encode(message))
    again = decode(written)
    print(f'its {len(written)} instead of {len(data)} bytes are read back: {again.position} and {again.effort}')
    assert len(written) == len(data) - 4 and (again.position, again.effort) == (1.5, -2.25)
    for name, read in ('mcap-ros2-support', deserialize), ('rosbags', lambda raw: store.deserialize_cdr(raw, NAME)):
        try:
            read(written)
        except Exception as error:
            print(f'by {name}: {error!r}')
        else:
            raise SystemExit(f'{name} reads it')
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/joint.py"
