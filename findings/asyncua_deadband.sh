#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asyncua 2.1.0: with a deadband of 0.1 rad a shaft that turns from 0 to 10 rad is not reported, and its encoder's fault
# neither.
#
# OPC UA compares each sample with the last value that was put into the subscriber's queue, and takes no account of the
# deadband where the status changes. Expected of deadband_monitor() at asyncua's server: a value each 0.1 rad or so, and
# the bad status. What happens: each sample is compared with the one before it, so that steps of 0.05 rad are not
# reported, however far they go: what the subscriber knows is wrong by 10 rad. A bad status is not reported at all, nor
# is the first good value after it, although it is 5 rad off: both are a TypeError in the server's log. A subscriber
# without a deadband gets all.
# For us: subscribe without a deadband at a server of asyncua, and leave small changes out in the client.
#
# Exit code 0: still so. Installs the version into a temporary folder; server and client are on the loopback address.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asyncua==2.1.0
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON' 2> log || { cat log; exit 1; }
import asyncio
import socket

from asyncua import Client, Server, ua

DEADBAND, STEP, STEPS, LAST = 0.1, 0.05, 200, 50.0


class Received:
    def __init__(self):
        self.values, self.done = [], asyncio.Event()

    def datachange_notification(self, node, value, data):
        good = data.monitored_item.Value.StatusCode.is_good()
        self.values.append((value, 'good' if good else 'bad'))
        if value == LAST:
            self.done.set()


async def main():
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    server = Server()
    await server.init()
    server.set_endpoint(f'opc.tcp://127.0.0.1:{port}')
    angle = await server.nodes.objects.add_variable(2, 'angle', 0.0)
    async with server, Client(f'opc.tcp://127.0.0.1:{port}') as client:
        received = {}
        node = client.get_node(angle.nodeid)
        for name in ('without deadband', 'with deadband'):
            received[name] = Received()
            subscription = await client.create_subscription(20, received[name])
            if name == 'with deadband':
                await subscription.deadband_monitor(node, DEADBAND)
            else:
                await subscription.subscribe_data_change(node)
        for step in range(1, STEPS + 1):
            await server.write_attribute_value(angle.nodeid, ua.DataValue(ua.Variant(step * STEP)))
        fault = ua.DataValue(ua.Variant(STEPS * STEP), ua.StatusCode(ua.StatusCodes.BadSensorFailure))
        await server.write_attribute_value(angle.nodeid, fault)
        for after_fault in (STEPS * STEP + 5, LAST):
            await server.write_attribute_value(angle.nodeid, ua.DataValue(ua.Variant(after_fault)))
        for reports in received.values():
            await asyncio.wait_for(reports.done.wait(), 30)
    for name, reports in received.items():
        print(name, len(reports.values), 'reports:', reports.values[:2], '...', reports.values[-3:])
    every, banded = (reports.values for reports in received.values())
    assert len(every) == 1 + STEPS + 3 and [status for _, status in every].count('bad') == 1
    assert banded == [(0.0, 'good'), (LAST, 'good')]


asyncio.run(main())
PYTHON
