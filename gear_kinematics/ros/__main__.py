# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`python -m gear_kinematics.ros`: starts the node."""

import sys

from gear_kinematics.__main__ import gear_state_publisher

if __name__ == '__main__':
    sys.exit(gear_state_publisher())
