"""Recorded bags: raw messages in and out, without ROS.

`rosbags` reads ROS 1, knows the message types and writes. rosbag2 files are read here, because
rosbags refuses unfinished and damaged files as a whole and takes longer over each message.
"""

from gear_kinematics.bag.errors import BagError, DamagedBagError, TopicError
from gear_kinematics.bag.reading import Bag, BagMessage, read_bag
from gear_kinematics.bag.storage import RawMessage, in_batches
from gear_kinematics.bag.topics import TOPIC_TYPES, Topic, listed
from gear_kinematics.bag.writing import BagWriter, write_bag

__all__ = [
    'TOPIC_TYPES',
    'Bag',
    'BagError',
    'BagMessage',
    'BagWriter',
    'DamagedBagError',
    'RawMessage',
    'Topic',
    'TopicError',
    'in_batches',
    'listed',
    'read_bag',
    'write_bag',
]
