# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Many recordings at a time: in processes of this machine, or on a cluster."""
