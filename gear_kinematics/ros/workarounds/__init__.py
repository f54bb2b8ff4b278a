"""Workarounds of rclpy and Fast DDS, each with its reason and the version it was seen in."""
