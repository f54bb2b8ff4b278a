#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-750-plc 0.2.6: an encoder at a WAGO 750-404 that has counted to 1000 is read at 59395, and a reset of the
# counter is neither sent nor refused.
#
# A WAGO controller has an up/down counter 750-404, whose three words of input are its status, and the lower and the
# upper word of the count. Expected of read(): the count. What happens: the bytes of both words are exchanged. write()
# of the same channel takes the words in the right order, so that a 1000 that is written is read back as 59395 too; but
# it changes only the library's own copy of the inputs, and sends one word, the control word as it was: neither the new
# count nor the bit 5, "set counter". reset() is a write(0): 0 is read, until the next update_state().
# A Modbus server with the process image and the list of modules of a controller takes its place.
# Output: counts 1, 1000 and 70000 are read as [256, 59395, 16805905], in the words they are [1, 1000, 70000]
#         after write(1000): read 59395, sent [[0]]; after reset(): read 0, sent [[0]], updated: 16805905
# For us: take the count from the words in `hub.connection.state.input`, and set the counter over Modbus.
#
# Exit code 0: still so. Installs the versions into a temporary folder; the server is on the loopback address.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-750-plc==0.2.6 pymodbus==3.11.4
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from wg750xxx import HubConfig, PLCHub

COUNTER, ANALOG_INPUTS = 404, 467  # a counter with three words each way, and two analog inputs of a word each
DIGITAL_INPUTS, DIGITAL_OUTPUTS = 0x8801, 0x8802  # eight of each
WIDTHS = {0x1022: 3 * 16, 0x1023: 5 * 16, 0x1024: 8, 0x1025: 8}


class Controller:
    """The process image of a controller and its registers of information, over Modbus/TCP."""

    def __init__(self):
        self.inputs, self.outputs, self.written = [0] * 5, [0] * 3, []
        self.server = socket.create_server(('127.0.0.1', 0))
        threading.Thread(target=self.serve, daemon=True).start()

    def count(self, value):
        self.inputs[1:3] = value & 0xFFFF, value >> 16

    def words(self, address, size):
        if 0x2030 <= address < 0x2033:
            modules = [COUNTER, ANALOG_INPUTS, DIGITAL_INPUTS, DIGITAL_OUTPUTS] if address == 0x2030 else []
            return modules + [0] * (size - len(modules))
        if address in WIDTHS:
            return [WIDTHS[address]]
        image = self.inputs if address < 0x0200 else self.outputs
        return (image[address & 0x01FF:] + [0] * size)[:size] if address < 0x0400 else [0] * size

    def serve(self):
        line, _ = self.server.accept()
        stream = line.makefile('rb')
        while header := stream.read(8):
            number, _, length, unit, function = struct.unpack('>HHHBB', header)
            body = stream.read(length - 2)
            address, size = struct.unpack_from('>HH', body)
            if function in (3, 4):
                found = struct.pack(f'>B{size}H', 2 * size, *self.words(address, size))
            elif function in (1, 2):
                found = bytes([(size + 7) // 8]) + bytes((size + 7) // 8)
            else:
                assert function == 16
                values = list(struct.unpack(f'>{size}H', body[5:]))
                self.written.append(values)
                start = address & 0x01FF
                self.outputs[start:start + size] = values
                found = body[:4]
            line.sendall(struct.pack('>HHHBB', number, 0, len(found) + 2, unit, function) + found)


plc = Controller()
hub = PLCHub(HubConfig(host='127.0.0.1', port=plc.server.getsockname()[1]))
counter = hub.modules[0].channels[0]
counts, read, words = [1, 1000, 70000], [], []
for count in counts:
    plc.count(count)
    hub.connection.update_state()
    low, high = (int(word) for word in hub.connection.state.input.value[1:3])
    words.append(low | high << 16)
    read.append(counter.read())
print('counts 1, 1000 and 70000 are read as', f'{read}, in the words they are {words}')
counter.write(1000)
written = counter.read(), plc.written.copy()
plc.written.clear()
counter.reset()
reset = counter.read(), plc.written.copy()
hub.connection.update_state()
print('after write(1000): read {}, sent {};'.format(*written), 'after reset(): read {}, sent {},'.format(*reset),
      f'updated: {counter.read()}')
assert read == [256, 59395, 16805905] and words == counts
assert written == (59395, [[0]]) and reset == (0, [[0]]) and counter.read() == 16805905
assert plc.outputs == [0, 0, 0]
hub.close()
PYTHON
