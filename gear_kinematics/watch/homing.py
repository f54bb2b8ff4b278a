# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Homes a running node by one call of its service."""

import time

from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from gear_kinematics.ros.graph import Graph
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.gear import Answer, homing_client
from gear_kinematics.watch.view import UNANSWERED
from gear_kinematics.wire.nearest import among, listed

_PERIOD = 0.1  # s between looks at the graph
_SEARCH = 4.0  # s, in which nodes are found that announce themselves every 3 s
_DELAY = 1.0  # s by which the services of a node may be found after it
_PATIENCE = 5.0  # s to wait for the answer


def home(wanted: str, actuator: str) -> Answer:
    """Call `~/home` of the node with a full name, or of the only one, and return its answer.

    Raises ValueError if there is no such node, or there are several to choose from, and
    RuntimeError if the node does not answer.
    """
    wanted = wanted and f'/{wanted.removeprefix("/")}'
    with replay_node('') as node:
        end = time.monotonic() + _SEARCH
        gears: list[str] = []
        while time.monotonic() < end and (not wanted or wanted not in gears):
            time.sleep(_PERIOD)
            gears = Graph(node).gears
        if not gears:
            raise ValueError('no gear_state_publisher is running with this ROS_DOMAIN_ID')
        if wanted and wanted not in gears:
            raise ValueError(f'{wanted} is not running{among(wanted, gears)}')
        if not wanted and len(gears) > 1:
            raise ValueError(f'which node is to be homed? Repeat with --node: {listed(gears)}')
        name = wanted or gears[0]
        # The graph names the service of a client as well, so it is asked first.
        known = {each for each, _ in node.get_service_names_and_types()}
        client = homing_client(node, name, actuator)
        service = client.srv_name
        if not client.wait_for_service(_SEARCH if service in known else _DELAY):
            homes = {each for each in known if each.startswith(f'{name}/') and 'home' in each}
            alone = actuator and homes == {f'{name}/home'}
            one = ', as it has one gear: leave --actuator out'
            hint = one if alone else among(service, homes)
            raise ValueError(f'there is no service {service}{hint}')
        asked = client.call_async(Trigger.Request())
        with SingleThreadedExecutor(context=node.context) as executor:
            executor.add_node(node)
            executor.spin_until_future_complete(asked, _PATIENCE)
        if not asked.done():
            raise RuntimeError(f'{name}: {UNANSWERED}')
        text, done = Answer.of(asked.result())
        return Answer(f'{name}: {text}', done)
