# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node and other ROS interfaces; `watch` alone imports rclpy, too."""
