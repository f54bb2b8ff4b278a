#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbag-merge 0.1.6: of two recordings that are merged in their folder, each angle is in the result twice.
#
# `rosbag-merge --input_bags a.bag b.bag` is to merge two recordings of ROS 1. Expected: the messages of a.bag and
# b.bag, each once. What happens: the option --input_paths, whose default is "./", is not left out where --input_bags is
# given, so that each .bag of the current folder is merged too: a.bag and b.bag are read a second time, and another
# recording there gets into the result as well. The text "./" is moreover taken as two folders, "." and "/". Neither
# --help nor the documentation says so, and nothing warns. By equal times, a speed of the merged angles is not a number.
# The package needs a version of rosbags of its time, as here: with rosbags 0.11.9 it does not write a recording.
# Output: merged in their folder: 10 s 1.0, 10 s 1.0, 11 s 2.0, 11 s 2.0, 20 s 3.0, 20 s 3.0, 30 s 99.0
#         merged from another folder: 10 s 1.0, 11 s 2.0, 20 s 3.0
# For us: call it in an empty folder, and check that the times of a topic grow.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rosbag-merge==0.1.6 rosbags==0.9.23 \
    icecream==2.2.0 tqdm==4.70.1 numpy==2.4.6
mkdir "$folder/recordings" "$folder/empty" "$folder/merged"
cd "$folder"
cat > recordings.py <<'PYTHON'
import sys
from pathlib import Path

from rosbags.rosbag1 import Reader, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
Float64 = store.types['std_msgs/msg/Float64']
SECOND = 10 ** 9

if sys.argv[1] == 'write':
    for name, start, angles in (('a', 10, [1.0, 2.0]), ('b', 20, [3.0]), ('another', 30, [99.0])):
        with Writer(Path('recordings', f'{name}.bag')) as writer:
            topic = writer.add_connection('/angle', Float64.__msgtype__, typestore=store)
            for k, angle in enumerate(angles):
                writer.write(topic, (start + k) * SECOND, store.serialize_ros1(Float64(angle), Float64.__msgtype__))
else:
    with Reader(Path('merged', sys.argv[1])) as reader:
        read = ', '.join(f'{time // SECOND} s {store.deserialize_ros1(data, topic.msgtype).data}'
                         for topic, time, data in reader.messages())
    print(f'{sys.argv[2]}: {read}')
    assert read == sys.argv[3], read
PYTHON
"$folder/venv/bin/python" recordings.py write
bags=("$folder/recordings/a.bag" "$folder/recordings/b.bag")
for name in recordings empty; do
  (cd "$name" && timeout 60 "$folder/venv/bin/rosbag-merge" --input_bags "${bags[@]}" --output_path "$folder/merged" \
    --outbag_name "$name" --write_bag > "$folder/$name.log" 2>&1) || { cat "$folder/$name.log"; exit 1; }
done
"$folder/venv/bin/python" recordings.py recordings.bag 'merged in their folder' \
  '10 s 1.0, 10 s 1.0, 11 s 2.0, 11 s 2.0, 20 s 3.0, 20 s 3.0, 30 s 99.0'
"$folder/venv/bin/python" recordings.py empty.bag 'merged from another folder' '10 s 1.0, 11 s 2.0, 20 s 3.0'
