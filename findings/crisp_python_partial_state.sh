#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# crisp-python 3.6.0: a JointState of the gripper alone puts all joints of the arm at 0 rad, and sends them there.
#
# The drivers of an arm and of its gripper publish on one topic, each with its own joints, as ROS allows. Expected of a
# message of the gripper: the joints of the arm keep their positions. What happens: those that a message does not name
# are 0 rad, so that an arm at 1 rad is read at 1 and 0 rad in turn. If the gripper is heard first, 0 rad is also the
# first target, which is published as target_joint at 50 Hz from then on, while the arm stands at 1 rad.
# move_to() with another orientation at the same place sends all of it at once: a turn by 90° in one message, since its
# steps are counted by the distance alone; a move of 100 mm has 100 steps.
# For us: give each driver a topic of its own, or publish all joints in each message.
#
# Exit code 0: still so. Installs the wheels into a temporary folder; its clients of controllers and its tf2, which have
# no wheels, are replaced by empty ones.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check crisp-python==3.6.0 numpy==2.3.0 scipy==1.17.1 PyYAML \
    'ros-jazzy-rclpy[fastrtps]==7.1.6' ros-jazzy-common-interfaces==5.3.6
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$folder/log"
timeout 150 "$folder/venv/bin/python" - <<'PYTHON'
import sys
import threading
import time
from unittest.mock import MagicMock

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.executors import MultiThreadedExecutor
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState

for name in ('tf2_ros', 'tf2_ros.buffer', 'tf2_ros.transform_listener', 'control_msgs', 'control_msgs.action',
             'controller_manager_msgs', 'controller_manager_msgs.srv'):  # fmt: skip
    sys.modules[name] = MagicMock()
from crisp_py.robot import robot as module  # noqa: E402
from crisp_py.robot.robot_config import RobotConfig  # noqa: E402

for client in ('ControllerSwitcherClient', 'JointTrajectoryControllerClient', 'ParametersClient'):
    setattr(module, client, MagicMock())
module.CallbackMonitor = lambda **_: MagicMock(monitor=lambda name, function: function)

rclpy.init()
driver, node = rclpy.create_node('driver'), rclpy.create_node('robot')
config = RobotConfig(joint_names=['shoulder', 'elbow'], home_config=[0.0, 0.0])
robot = module.Robot(node=node, spin_node=False, robot_config=config)
targets, poses = [], []
driver.create_subscription(JointState, 'target_joint', lambda message: targets.append(list(message.position)), 10)
driver.create_subscription(PoseStamped, 'target_pose', poses.append, 1000)
states = driver.create_publisher(JointState, 'joint_states', 10)
current = driver.create_publisher(PoseStamped, 'current_pose', 10)
executor = MultiThreadedExecutor(num_threads=4)
executor.add_node(driver)
executor.add_node(node)
threading.Thread(target=executor.spin, daemon=True).start()


def wait(condition, send):
    deadline = time.monotonic() + 30
    while not condition() and time.monotonic() < deadline:
        send()
        time.sleep(0.05)
    assert condition()


def gripper():
    states.publish(JointState(name=['finger'], position=[0.02], velocity=[0.0]))


def arm():
    states.publish(JointState(name=['shoulder', 'elbow'], position=[1.0, 1.0], velocity=[0.0, 0.0]))


wait(lambda: robot._current_joint is not None, gripper)
wait(lambda: np.allclose(robot.joint_values, 1), arm)
targets.clear()
wait(lambda: len(targets) > 5, arm)
print('joints', robot.joint_values, 'rad, published target', targets[-1], 'rad')
assert np.allclose(targets, 0)
wait(lambda: np.allclose(robot.joint_values, 0), gripper)
print('joints after a message of the gripper', robot.joint_values, 'rad')

start = PoseStamped()
start.pose.orientation.w = 1.0
wait(lambda: robot._current_pose is not None, lambda: current.publish(start))


def moved(pose):
    """Return the distances and the turns between the targets that are published, in m and degrees."""
    time.sleep(0.3)
    poses.clear()
    robot.move_to(pose=pose)
    time.sleep(0.3)
    taken = list(poses)
    turns = [Rotation.from_quat([p.pose.orientation.x, p.pose.orientation.y, p.pose.orientation.z, p.pose.orientation.w])
             for p in taken]  # fmt: skip
    steps = [np.degrees((a.inv() * b).magnitude()) for a, b in zip(turns[:-1], turns[1:], strict=True)]
    ways = np.diff([p.pose.position.x for p in taken])
    return np.abs(ways), np.array([np.degrees(turns[0].magnitude()), *steps])


goal = robot.target_pose
goal.position = np.array([0.1, 0.0, 0.0])
ways, _ = moved(goal)
print('a move of 100 mm: greatest step', ways.max() * 1000, 'mm')
assert ways.max() < 0.01
robot._target_pose = robot.end_effector_pose
turned = robot.end_effector_pose
turned.orientation = Rotation.from_euler('z', 90, degrees=True)
_, steps = moved(turned)
print('a turn by 90° at the same place: greatest step', steps.max(), '°')
assert abs(steps.max() - 90) < 1e-6
executor.shutdown(timeout_sec=2)
rclpy.shutdown()
PYTHON
