"""The node and everything else that talks to ROS: the only room that imports rclpy."""
