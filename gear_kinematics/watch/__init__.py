# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Watches a running gear_state_publisher and the drivers, on a page or in a terminal."""
