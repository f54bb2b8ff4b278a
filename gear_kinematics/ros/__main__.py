"""`python -m gear_kinematics.ros`: starts the node."""

import sys

from gear_kinematics.__main__ import gear_state_publisher

if __name__ == '__main__':
    sys.exit(gear_state_publisher())
