"""From rotor messages to the state of the mechanism, without ROS."""
