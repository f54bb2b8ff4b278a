"""The node and other ROS interfaces; only this room imports rclpy."""
