#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rerun 0.41.0: a PoseArray of an mcap is not shown in 3D, while a PoseStamped is.
#
# A recording has the same pose as geometry_msgs/PoseStamped on /one and in a geometry_msgs/PoseArray on /many.
# The conversion to .rrd makes InstancePoses3D of /one. Of /many it keeps the fields alone, under the name of the
# message, for which no view has a picture; it says nothing of it.
# Seen by the archetypes that `rerun rrd print` lists for each topic.
# For us: record /tf for rerun.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rerun-sdk==0.41.0 rosbags==0.11.9
"$folder/venv/bin/python" - "$folder/bag" <<'PYTHON'
import sys
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS2_JAZZY)
types = store.types
pose = types['geometry_msgs/msg/Pose'](
    position=types['geometry_msgs/msg/Point'](x=1.0, y=2.0, z=3.0),
    orientation=types['geometry_msgs/msg/Quaternion'](x=0.0, y=0.0, z=0.0, w=1.0),
)
header = types['std_msgs/msg/Header'](
    stamp=types['builtin_interfaces/msg/Time'](sec=1, nanosec=0), frame_id='world'
)
messages = {
    '/one': types['geometry_msgs/msg/PoseStamped'](header=header, pose=pose),
    '/many': types['geometry_msgs/msg/PoseArray'](header=header, poses=[pose]),
}
with Writer(Path(sys.argv[1]), version=9, storage_plugin=StoragePlugin.MCAP) as writer:
    for topic, message in messages.items():
        name = message.__msgtype__
        connection = writer.add_connection(topic, name, typestore=store)
        writer.write(connection, 10**9, store.serialize_cdr(message, name))
PYTHON
export HOME="$folder"
rerun="$folder/venv/bin/rerun"
"$rerun" analytics disable > /dev/null 2>&1
"$rerun" mcap convert "$folder"/bag/*.mcap -o "$folder/bag.rrd" > /dev/null 2>&1
for topic in one many; do
    "$rerun" rrd print -vv --entity "/$topic" "$folder/bag.rrd" 2> /dev/null |
        grep -o 'archetype: [A-Za-z0-9_.]*' | sort -u > "$folder/$topic"
    echo "/$topic:" $(grep -v Mcap "$folder/$topic")
done
grep -q InstancePoses3D "$folder/one"
grep -q geometry_msgs.msg.PoseArray "$folder/many"
if grep -qE 'Poses3D|Transform3D|Points3D' "$folder/many"; then exit 1; fi
