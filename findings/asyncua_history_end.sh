#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asyncua 2.1.0: the last three angles of a shaft until 5 s are read from its history as those at 8, 9 and 10 s.
#
# A server keeps the angles of a shaft at 1, 2 ... 10 s, each of which is 1 rad more than the one before it. Expected
# of read_raw_history(None, end, 3), where `end` is at 5 s: 5, 4 and 3 rad, as OPC UA (part 11) has an end without a
# start read backwards from the end. What happens: with the default storage, in memory, the end is ignored wherever
# there is no start, so that the newest angles come, those at 10, 9 and 8 s, without an error. The other storage of the
# same library, HistorySQLite, gives 5, 4 and 3 rad, and so do both if they are asked from 5 s back to 0 s.
# Output: in memory: until 5 s: [10.0, 9.0, 8.0], from 5 s back to 0 s: [5.0, 4.0, 3.0]
#         in SQLite: until 5 s: [5.0, 4.0, 3.0], from 5 s back to 0 s: [5.0, 4.0, 3.0]
# For us: give both ends of the time, the later one first to read backwards, and look at the stamps of what comes.
#
# Exit code 0: still so. Installs the versions into a temporary folder; the server is on the loopback address.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asyncua==2.1.0 aiosqlite==0.22.1
cd "$folder"
timeout 120 "$folder/venv/bin/python" - 2> /dev/null <<'PYTHON'
import asyncio
import socket
from datetime import datetime, timedelta, timezone

from asyncua import Client, Server, ua
from asyncua.server.history_sql import HistorySQLite


def at(seconds):
    return datetime(2026, 1, 1, 12, 0, 0, 500, tzinfo=timezone.utc) + timedelta(seconds=seconds)


async def read(storage=None):
    with socket.create_server(('127.0.0.1', 0)) as free:
        url = f'opc.tcp://127.0.0.1:{free.getsockname()[1]}'
    server = Server()
    await server.init()
    if storage:
        server.iserver.history_manager.set_storage(storage)
        await server.iserver.history_manager.init()
    server.set_endpoint(url)
    shaft = await server.nodes.objects.add_variable(2, 'angle', 0.0)

    async def turn(angle):
        value = ua.DataValue(ua.Variant(angle, ua.VariantType.Double), SourceTimestamp=at(angle))
        await server.write_attribute_value(shaft.nodeid, value)

    await turn(0.0)
    async with server:
        await server.historize_node_data_change(shaft, period=None, count=0)
        for second in range(1, 11):
            await turn(float(second))
            await asyncio.sleep(0.03)
        await asyncio.sleep(0.5)
        async with Client(url) as client:
            node = client.get_node(shaft.nodeid)
            ranges = [(None, at(5), 3), (at(5), at(0), 3), (at(0), at(10), 0)]
            return [[value.Value.Value for value in await node.read_raw_history(*limits)] for limits in ranges]


found = {'in memory': asyncio.run(read()), 'in SQLite': asyncio.run(read(HistorySQLite('history.sqlite')))}
for name, (until, back, every) in found.items():
    print(f'{name}: until 5 s: {until}, from 5 s back to 0 s: {back}')
    assert back == [5.0, 4.0, 3.0] and every == [float(second) for second in range(11)]
assert found['in memory'][0] == [10.0, 9.0, 8.0]
assert found['in SQLite'][0] == [5.0, 4.0, 3.0]
PYTHON
