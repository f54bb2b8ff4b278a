"""Recorded bags: reading and writing raw messages, without ROS.

`rosbags` reads ROS 1 bags, defines the message types and writes. rosbag2 files are read here,
because rosbags refuses unfinished and damaged files altogether and takes longer per message.
"""

from gear_kinematics.bag.errors import BagError, DamagedBagError, TopicError
from gear_kinematics.bag.reading import (
    Bag,
    ReportProgress,
    TopicMessages,
    in_batches,
    sort_by_topic,
)
from gear_kinematics.bag.storage import Message
from gear_kinematics.bag.topics import Topic
from gear_kinematics.bag.writing import BagWriter, LiveBagWriter

__all__ = [
    'Bag',
    'BagError',
    'BagWriter',
    'DamagedBagError',
    'LiveBagWriter',
    'Message',
    'ReportProgress',
    'Topic',
    'TopicError',
    'TopicMessages',
    'in_batches',
    'sort_by_topic',
]
