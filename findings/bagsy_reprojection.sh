#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bagsy 1.6.3: the tip of an arm that is at (1, 0.5) m in the base is reprojected to (-0.5, 1) m.
#
# Its stream_bag() reprojects topics of a bag into other frames, by the transforms in /tf, a TFBuffer and a function for
# each type of message, which are called here without a bag. The elbow is 1 m in front of the base and turned by 90° to
# the left, the tip is 0.5 m further along the forearm. Expected of TFBuffer.lookup_transform('base', 'tip', stamp),
# whose arguments are named target_frame and source_frame as in tf2, and of reproject_point_stamped() and
# reproject_pose_stamped() with a point or a pose at the origin of the tip: (1, 0.5, 0) and 90°. What happens:
# (-0.5, 1, 0) and -90°, which is where the base is as seen from the tip. So the arguments the other way round give the
# right pose. A frame that is reprojected into itself is right.
# For us: give lookup_transform() the two frames exchanged, or multiply by the inverse.
#
# Exit code 0: still so. Installs the versions into a temporary folder, without open3d, which these parts do not need.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 rosbags==0.11.9
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps bagsy==1.6.3
cat > "$folder/tip.py" <<'PYTHON'
import numpy as np
from bagsy.lib.reproject_msg import TFBuffer, reproject_point_stamped, reproject_pose_stamped
from rosbags.typesys import Stores, get_typestore

types = get_typestore(Stores.ROS2_JAZZY).types
Stamped, Moved, Turn, Vector, Header, Time = (types[name] for name in (
    'geometry_msgs/msg/TransformStamped', 'geometry_msgs/msg/Transform', 'geometry_msgs/msg/Quaternion',
    'geometry_msgs/msg/Vector3', 'std_msgs/msg/Header', 'builtin_interfaces/msg/Time'))


def transform(parent, child, x, degrees):
    half = np.radians(degrees) / 2
    turn = Turn(x=0.0, y=0.0, z=np.sin(half), w=np.cos(half))
    header = Header(stamp=Time(sec=1, nanosec=0), frame_id=parent)
    moved = Moved(translation=Vector(x=x, y=0.0, z=0.0), rotation=turn)
    return Stamped(header=header, child_frame_id=child, transform=moved)


buffer = TFBuffer()
buffer.add_transform(transform('base', 'elbow', 1.0, 90), static=False)
buffer.add_transform(transform('elbow', 'tip', 0.5, 0), static=False)


def position_and_turn(target, source):
    found = buffer.lookup_transform(target, source, 10 ** 9).matrix
    turn = np.degrees(np.arctan2(found[1, 0], found[0, 0]))
    print(f'lookup_transform({target!r}, {source!r}): {np.round(found[:3, 3], 9) + 0.0}, {turn:.0f} degrees')
    return *found[:3, 3], turn


assert np.allclose(position_and_turn('base', 'tip'), (-0.5, 1, 0, -90))
assert np.allclose(position_and_turn('tip', 'base'), (1, 0.5, 0, 90))
assert np.allclose(position_and_turn('base', 'base'), (0, 0, 0, 0))
origin = {'header.frame_id': 'tip', 'header.stamp.sec': 1, 'header.stamp.nanosec': 0}
point = reproject_point_stamped(origin | {'point.x': 0.0, 'point.y': 0.0, 'point.z': 0.0}, 'base', buffer)
pose = {'pose.position.' + axis: 0.0 for axis in 'xyz'} | {'pose.orientation.' + axis: 0.0 for axis in 'xyz'}
pose = reproject_pose_stamped(origin | pose | {'pose.orientation.w': 1.0}, 'base', buffer)
turn = np.degrees(2 * np.arctan2(pose['pose.orientation.z'], pose['pose.orientation.w']))
print('the point:', *(float(point['point.' + name]) for name in 'xyz'), f'the turn of the pose: {turn:.0f} degrees')
assert point['header.frame_id'] == pose['header.frame_id'] == 'base'
assert np.allclose([point['point.' + axis] for axis in 'xyz'], (-0.5, 1, 0))
assert np.allclose([pose['pose.position.' + axis] for axis in 'xyz'] + [turn], (-0.5, 1, 0, -90))
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/tip.py"
