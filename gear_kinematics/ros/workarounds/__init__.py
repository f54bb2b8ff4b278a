# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Workarounds of rclpy and Fast DDS, each with its reason and the version it was seen in."""
