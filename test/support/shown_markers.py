"""What a viewer is shown by the markers."""

import math

from geometry_msgs.msg import Point, Pose, Quaternion
from links import link_poses, read
from live import START
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from visualization_msgs.msg import Marker, MarkerArray

from gear_kinematics.kinematics import Mechanism, RotorSample, split_turns
from gear_kinematics.ros.markers import Markers
from gear_kinematics.shape.urdf import urdf
from gear_kinematics.state.state_messages import StateMessages
from gear_kinematics.wire.topics import JOINT_STATES

MODULE = 0.0005


def sent(mechanism: Mechanism, prefix: str = '') -> list[Marker]:
    """Return the markers as they are sent, in the frames of their links."""
    data = Markers(mechanism, module=MODULE, frame_prefix=prefix).due(0.0)
    return deserialize_message(data, MarkerArray).markers


def all_at(mechanism: Mechanism, rotor_angle: float) -> list[Marker]:
    """Return the markers where a viewer shows them, with poses in the stator's frame.

    The links are where URDF and mechanism_joint_states put them, as robot_state_publisher does.
    """
    names = {'output_joint': 'output_shaft', 'frame_prefix': ''}
    _, joints = read(urdf(mechanism, module=MODULE, **names))
    sample = RotorSample(START, split_turns(rotor_angle), None, None)
    [(_, data)] = StateMessages(mechanism, **names).encode(sample, [JOINT_STATES])
    states = deserialize_message(data, JointState)
    links = link_poses(joints, dict(zip(states.name, states.position, strict=True)))
    markers = sent(mechanism)
    for marker in markers:
        link, place = links[marker.header.frame_id], marker.pose.position
        assert marker.pose.orientation == Quaternion()
        x, y, z, _ = link @ [place.x, place.y, place.z, 1.0]
        half = 0.5 * math.atan2(link[1, 0], link[0, 0])
        turned = Quaternion(z=math.sin(half), w=math.cos(half))
        marker.pose = Pose(position=Point(x=x, y=y, z=z), orientation=turned)
    return markers
