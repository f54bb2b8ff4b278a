"""What a viewer is shown by the markers."""

from live import START
from rclpy.serialization import deserialize_message
from visualization_msgs.msg import Marker, MarkerArray

from gear_kinematics.kinematics import Mechanism, split_turns
from gear_kinematics.markers import Markers
from gear_kinematics.rotor_input import RotorSample

MODULE = 0.0005


def sample_at(rotor_angle: float) -> RotorSample:
    return RotorSample(START, split_turns(rotor_angle), None, None)


def shown(markers: Markers, sample: RotorSample | None, now: float) -> list[Marker]:
    messages = [deserialize_message(data, MarkerArray) for data in markers.due(sample, now)]
    return [marker for message in messages for marker in message.markers]


def all_at(mechanism: Mechanism, rotor_angle: float, prefix: str = '') -> list[Marker]:
    """Give what a viewer that starts now sees."""
    return shown(
        Markers(mechanism, module=MODULE, frame_prefix=prefix), sample_at(rotor_angle), 0.0
    )
