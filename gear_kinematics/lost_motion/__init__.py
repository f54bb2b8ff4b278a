"""Lost motion, stiffness and transmission error of a gear, from recordings.

Definitions and their sources are in docs/lost_motion.md.
"""

from gear_kinematics.lost_motion.recorded.bags import read_bag
from gear_kinematics.lost_motion.recorded.csv_files import Columns, CsvError, read_csv
from gear_kinematics.lost_motion.recorded.recording import Recording
from gear_kinematics.lost_motion.report import LostMotionReport, measure

__all__ = [
    'Columns',
    'CsvError',
    'LostMotionReport',
    'Recording',
    'measure',
    'read_bag',
    'read_csv',
]
