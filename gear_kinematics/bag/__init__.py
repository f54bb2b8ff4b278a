"""Recorded bags: reading and writing raw messages, without ROS.

`rosbags` reads ROS 1 bags, defines the message types and writes. rosbag2 files are read here,
because rosbags refuses unfinished and damaged files altogether and takes longer per message.
"""

from gear_kinematics.bag.errors import BagError, DamagedBagError, TopicError
from gear_kinematics.bag.reading import (
    Bag,
    ReportProgress,
    TopicMessages,
    by_topic,
)
from gear_kinematics.bag.storage import Message, in_batches
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
    'by_topic',
    'in_batches',
]
