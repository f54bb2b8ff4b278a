# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""From rotor messages to the state of the mechanism, without ROS."""
