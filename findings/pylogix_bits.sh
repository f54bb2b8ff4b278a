#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylogix 1.1.6: of 20 drives of a Logix PLC that one Write() enables two are not, and all 21 answers are Success.
#
# A program sets bit 3 of the control words of 20 drives and then bit 2 of Go, in one Write() with a list. Expected: 21
# bits, in this order, and the answers to them. What happens: a bit that no longer fits into a packet is left out, and
# those behind it go on where their names are shorter. As the answers are only counted, it is never sent: drives 8 and
# 17 are not enabled, and Go is set before the drives 9 to 19 are. Go is answered three times, each of them "Success".
# This PLC allows packets of 504 bytes, as older ones do; with 4002 bytes it takes more tags.
# The second one: eight flags from Flags[1].28 on are read from the bits 28 to 31 of Flags[1] and 0 to 3 of Flags[2],
# but written to the bits 28 to 31 and 0 to 3 of Flags[1]. With an array of BOOL they are written where they are read.
# A server that takes the requests of CIP apart, and keeps the tags, takes the place of the PLC.
# Output: not enabled: [8, 17]; 21 answers, {'Success'}, 3 of them to Go.2, which was first set after 8 drives
#         8 flags from Flags[1].28 on: Flags[1] = 0xF000000F, Flags[2] = 0x0, read back: 4 of 8
#         8 flags from Bools[60] on: 8 of 8
# For us: look at the names of the answers, write such bits one by one, and no list of bits beyond the end of a word.
#
# Exit code 0: still so. Installs the version into a temporary folder; the server is on the loopback address.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylogix==1.1.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from pylogix import PLC

REGISTER, UNCONNECTED, CONNECTED = 0x65, 0x6F, 0x70
READ, MODIFY, OPEN, CLOSE, MULTIPLE = 0x4C, 0x4E, 0x54, 0x4E, 0x0A
UNKNOWN_TAG, NOT_SUPPORTED = 4, 8
DINT, BOOLS = 0xC4, 0xD3


def answer(service, data=b'', status=0):
    return bytes([service | 0x80, 0, status, 0]) + data


class Controller:
    """Words that are read and set by the services of a Logix controller, over small connections."""

    def __init__(self, tags):
        self.tags = tags  # the type and the words of each name
        self.order = []
        self.server = socket.create_server(('127.0.0.1', 0))
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            line, _ = self.server.accept()
            stream = line.makefile('rb')
            while header := stream.read(24):
                command, length = struct.unpack_from('<HH', header)
                body = stream.read(length)
                if command not in (REGISTER, UNCONNECTED, CONNECTED):
                    break
                if command == UNCONNECTED:
                    body = self.connection(body)
                elif command == CONNECTED:
                    found = body[20:22] + self.request(body[22:])
                    body = body[:6] + struct.pack('<HHHIHH', 2, 0xA1, 4, 2, 0xB1, len(found)) + found
                line.sendall(struct.pack('<HHI', command, len(body), 7) + bytes(4) + header[12:] + body)

    def connection(self, body):
        service = body[16]
        if service == OPEN:
            found = answer(service, struct.pack('<II', 1, 2) + body[32:40] + struct.pack('<IIH', 100000, 100000, 0))
        else:
            found = answer(service, body[26:34] + bytes(2)) if service == CLOSE else answer(service, b'', NOT_SUPPORTED)
        return body[:6] + struct.pack('<HIHH', 2, 0, 0xB2, len(found)) + found

    def request(self, request):
        service, end = request[0], 2 + 2 * request[1]
        path, data = request[2:end], request[end:]
        if service == MULTIPLE:
            count, = struct.unpack_from('<H', data)
            starts = [*struct.unpack_from(f'<{count}H', data, 2), len(data)]
            parts = [self.request(data[start:stop]) for start, stop in zip(starts, starts[1:])]
            offsets = [2 + 2 * count + sum(map(len, parts[:number])) for number in range(count)]
            return answer(service, struct.pack(f'<H{count}H', count, *offsets) + b''.join(parts))
        assert path[0] == 0x91
        size = path[1]
        name, rest = path[2:2 + size].decode(), path[2 + size + size % 2:]
        assert rest == b'' or (rest[0] == 0x28 and len(rest) == 2)
        index = rest[1] if rest else 0
        if name not in self.tags:
            return answer(service, b'', UNKNOWN_TAG)
        kind, words = self.tags[name]
        if service == READ:
            count, = struct.unpack('<H', data)
            return answer(service, struct.pack(f'<H{count}I', kind, *words[index:index + count]))
        assert service == MODIFY and len(data) == 10
        size, high, low = struct.unpack('<HII', data)
        words[index] = (words[index] | high) & low
        self.order.append(name)
        return answer(service)


drives = [f'Axis{number:02}_ControlWord_Of_Drive' for number in range(20)]
tags = {name: (DINT, [0]) for name in [*drives, 'Go']}
tags |= {'Flags': (DINT, [0] * 4), 'Bools': (BOOLS, [0] * 4)}
plc = Controller(tags)
with PLC('127.0.0.1', port=plc.server.getsockname()[1]) as client:
    answers = client.Write([(f'{name}.3', 1) for name in drives] + [('Go.2', 1)])
    size = client.ConnectionSize
    order = plc.order.copy()
    flags = client.Write('Flags[1].28', [1] * 8)
    read = client.Read('Flags[1].28', 8).Value
    assert client.Write('Bools[60]', [1] * 8).Status == 'Success'
    bools = client.Read('Bools[60]', 8).Value

idle = [number for number, name in enumerate(drives) if not tags[name][1][0]]
states, named = {one.Status for one in answers}, [one.TagName for one in answers]
print(f'not enabled: {idle}; {len(answers)} answers, {states}, {named.count("Go.2")} of them to Go.2,',
      f'which was first set after {order.index("Go")} drives')
words = tags['Flags'][1]
print(f'8 flags from Flags[1].28 on: Flags[1] = 0x{words[1]:X}, Flags[2] = 0x{words[2]:X}, read back: {sum(read)} of 8')
print(f'8 flags from Bools[60] on: {sum(bools)} of 8')
assert size == 504 and idle == [8, 17] and len(answers) == 21 and states == {'Success'}
assert named.count('Go.2') == order.count('Go') == 3 and order.index('Go') == 8
assert not any(f'{drives[number]}.3' in named for number in idle)
assert flags.Status == 'Success' and words == [0, 0xF000000F, 0, 0] and read == [True] * 4 + [False] * 4
assert bools == [True] * 8 and tags['Bools'][1] == [0, 0xF0000000, 0xF, 0]
PYTHON
