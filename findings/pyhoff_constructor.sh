#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyhoff 1.1.2: with the terminals given to BK9000(), as documented, a torque sensor at 8 mA is read at 4 mA, its zero.
#
# The terminals of a Beckhoff coupler can be given to its constructor, as the example there does, or to
# add_bus_terminals(). In the process image of a BK9000 a status word stands before each word of data, and outputs begin
# at 0x0800, which the class itself sets. Expected either way: the channels of a KL3054 are read from 1, 3, 5 and 7, and
# the first output behind it is written at 0x0809. What happens: the constructor gives out the addresses before it sets
# the map of the coupler. Channels 1 to 4 are read from 0 to 3, so that channel 1 shows its status as 4 mA, and channel
# 2 the 8 mA of channel 1; a voltage for a drive is written at 4. read_delta() of a counter KL1512 is documented as the
# change since the last read, but is the one since the start: 3 pulses that came once are read as 3 each time.
# For us: make the coupler without terminals and call add_bus_terminals() then; take the difference of read_counter().
#
# Exit code 0: still so. Installs the version into a temporary folder; the coupler is a Modbus server of the script.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyhoff==1.1.2
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import socketserver
import struct
import threading

from pyhoff.devices import BK9000, KL1512, KL3054, KL4132

assert 'bus_terminals=[KL3202, KL9010])' in BK9000.__mro__[1].__init__.__doc__
assert 'since last read' in KL1512.read_delta.__doc__
words = {1: round(0x7FFF * 4 / 16), 3: round(0x7FFF * 8 / 16), 5: 0, 7: 0}
written = []


class Coupler(socketserver.BaseRequestHandler):
    """A Modbus server (functions 4 and 6) with the process image of a BK9000."""

    def handle(self):
        while request := self.request.recv(260):
            head, function, address, value = request[:4], *struct.unpack('>BHH', request[7:12])
            if function == 4:
                data = b''.join(struct.pack('>H', words.get(address + i, 0)) for i in range(value))
                answer = struct.pack('>BBB', request[6], function, len(data)) + data
            else:
                written.append((address, value))
                answer = request[6:12]
            self.request.sendall(head + struct.pack('>H', len(answer)) + answer)


server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), Coupler)
server.daemon_threads = True
threading.Thread(target=server.serve_forever, daemon=True).start()
port = server.server_address[1]


def run(coupler):
    """The currents in mA of the first two channels, and where 5 V are written."""
    currents = [round(coupler.select(KL3054).read_current(channel), 2) for channel in (1, 2)]
    written.clear()
    coupler.select(KL4132).set_voltage(1, 5.0)
    return currents, written[0][0]


added = BK9000('127.0.0.1', port)
added.add_bus_terminals([KL3054, KL4132])
added = run(added)
given = run(BK9000('127.0.0.1', port, bus_terminals=[KL3054, KL4132]))
print('8 and 12 mA, and the address of an output:', added, 'by add_bus_terminals(),', given, 'by the constructor')
assert added == ([8.0, 12.0], 0x0809)
assert given == ([4.0, 8.0], 4)

words.update({1: 100, 3: 0})
counter = BK9000('127.0.0.1', port)
counter.add_bus_terminals(KL1512)
counter = counter.select(KL1512)
words[1] = 103
deltas = [counter.read_delta(1) for _ in range(3)]
print('changes of a counter that went on by 3 once:', deltas)
assert deltas == [3, 3, 3]
server.shutdown()
PYTHON
