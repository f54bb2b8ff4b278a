# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The state of the mechanism, from messages of the rotor and without ROS."""
