# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recorded bags: reading and writing raw messages, without ROS.

rosbag2 files are read here, because rosbags refuses unfinished and damaged files altogether and
takes longer per message. It converts ROS 1 bags and writes (`bag.writing`); as Ubuntu has no
package of it, nothing else needs it.
"""

from gear_kinematics.bag.errors import BagError, DamagedBagError, TopicError
from gear_kinematics.bag.reading import Bag, MessagesByTopic, ReportProgress, TopicMessages
from gear_kinematics.bag.storage import Message, Topic, in_batches

__all__ = [
    'Bag',
    'BagError',
    'DamagedBagError',
    'Message',
    'MessagesByTopic',
    'ReportProgress',
    'Topic',
    'TopicError',
    'TopicMessages',
    'in_batches',
]
