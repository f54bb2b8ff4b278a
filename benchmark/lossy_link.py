# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How soon the node has a message that a lossy link between it and the driver has lost.

    python benchmark/lossy_link.py [--profile FILE] [--rate 500] [--seconds 60] [--loss 1] [--json]

Driver and node are on two hosts, which are network namespaces; the listener is on the node's.
Packets are dropped at random in both directions. A gap is a pause in the answers of more than
10 ms and 5 messages, which ends with the answer to the message that was lost; the time to close it
counts from the sending of this message. Needs root.
"""

import argparse
import json
import math
import os
import sys
import time
from array import array
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from network import NoNetworkError, two_hosts
from peer import peer
from processes import NODE, PROFILE, Program, private_surroundings, program
from rotor_driver import SECOND
from state_listener import Listener, receive_answers

DEPTH = 1000
"""Messages that the driver keeps to send them again."""
_PAUSE = 0.01  # s
_PAUSE_MESSAGES = 5
_QUIET = 10.0  # s without an answer, after which nothing more is to come


class Arrivals:
    """When messages were sent and answered."""

    def __init__(self) -> None:
        """Start with none."""
        self._sent = array('q')
        self._answered = array('q')

    def __len__(self) -> int:
        """How many answers there are."""
        return len(self._sent)

    def add(self, data: bytes) -> None:
        """Take an answer."""
        self._answered.append(time.time_ns())
        seconds, nanoseconds = np.frombuffer(data, '<u4', 2, 4).tolist()
        self._sent.append(seconds * SECOND + nanoseconds)

    def gaps(self, rate: float) -> Any:
        """Give the time until each gap was closed, s."""
        sent, answered = (np.array(times) / SECOND for times in (self._sent, self._answered))
        closing = 1 + np.flatnonzero(np.diff(answered) > _PAUSE + _PAUSE_MESSAGES / rate)
        return (answered - sent)[closing]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--profile', type=Path, default=PROFILE, help='of driver and node')
    parser.add_argument('--rate', type=int, default=500, metavar='HZ')
    parser.add_argument('--seconds', type=float, default=60.0)
    parser.add_argument('--loss', type=int, default=1, help='percent of the packets')
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    try:
        result = measure(options.profile, options.rate, options.seconds, options.loss)
    except NoNetworkError as error:
        sys.exit(str(error))
    if options.json:
        print(json.dumps(result))
    else:
        for name, value in result.items():
            print(f'{name}: {value:.6g}')


def measure(profile: Path, rate: int, seconds: float, loss: int) -> dict[str, float]:
    """Let the node answer a driver on the other host; times in s."""
    count = round(rate * seconds)
    arrivals = Arrivals()
    with ExitStack() as stack:
        driver_host, node_host, cable = stack.enter_context(two_hosts())
        surroundings = stack.enter_context(private_surroundings())
        surroundings.environment.update(
            # The other host is not on the loopback, and the memory of both is no way round it.
            ROS_AUTOMATIC_DISCOVERY_RANGE='SUBNET',
            FASTDDS_BUILTIN_TRANSPORTS='UDPv4',
            FASTRTPS_DEFAULT_PROFILES_FILE=str(profile.resolve()),
        )
        os.environ.update(surroundings.environment)
        depth = surroundings._replace(arguments=[*surroundings.arguments, '-p', f'depth:={DEPTH}'])
        with driver_host.entered():
            driver = stack.enter_context(Program(program('rotor_driver.py'), depth))
        driver.report()
        with node_host.entered():
            node = stack.enter_context(Program(NODE, surroundings))
            own = stack.enter_context(peer('lossy_link', surroundings.arguments))
            listener = stack.enter_context(Listener(own, {'output_state': arrivals.add}))
            listener.wait_until_heard()
        cable.lose(loss)
        before, driver_before = node.cpu_time(), driver.cpu_time()
        driver.tell(rate=rate, count=count, allowed=count, counted=False)
        receive_answers(listener, [arrivals], count=count, quiet=_QUIET)
        cable.lose(0)
        cpu, driver_cpu = node.cpu_time() - before, driver.cpu_time() - driver_before
        driver.report()
        dropped = node_host.dropped()
    gaps = arrivals.gaps(rate)
    quantiles = np.quantile(gaps, (0.5, 0.9, 0.99, 1.0)).tolist() if len(gaps) else [math.nan] * 4
    return {
        'answered': len(arrivals) / count,
        'packets dropped before the node': dropped,
        'gaps': len(gaps),
        **dict(zip(('p50', 'p90', 'p99', 'max'), quantiles, strict=True)),
        'cpu of the node, a message': cpu / count,
        'cpu of the driver, a message': driver_cpu / count,
    }


if __name__ == '__main__':
    main()
