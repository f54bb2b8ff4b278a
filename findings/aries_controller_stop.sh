#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# aries-controller 0.7.0: after an interrupted program the rotary stage goes on turning; only with `ignore_safety_stop`
# set does it stop.
#
# The package moves the rotary stages of Kohzu's ARIES controller by telnet. By its documentation, the destructor stops
# all axes, so that Ctrl-C works as an emergency stop, and `ignore_safety_stop`, which is False by default, is to leave
# that out. Expected of a program that ends during a move: four commands STP. What happens: the condition is the wrong
# way round (`if self.ignore_safety_stop and not self.is_stopped`): by default there is not even a question whether the
# stage is turning, and the stage goes on to its target; with the setting that is to forbid the stop, it is stopped.
# Output: default: the stage was told APS1/5/45000/1 before the connection was closed
#         ignore_safety_stop: the stage was told APS1/5/45000/1 STP1/1 STP2/1 STP3/1 STP4/1 before the connection ...
# For us: call `stop_all_stages(immediate=True)` in a `finally` of one's own.
#
# Exit code 0: still so. Installs the version into a temporary folder, and simulates the controller on this machine.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check aries-controller==0.7.0
cd "$folder"
timeout 60 "$folder/venv/bin/python" -W ignore::DeprecationWarning - <<'PYTHON'
import socket
import threading

from aries import Aries

MOVE = 'APS1/5/45000/1'
STOPS = ['STP1/1', 'STP2/1', 'STP3/1', 'STP4/1']


def told(**settings):
    """The commands, without questions, that a program sends which is interrupted in a move of the first axis."""
    commands = []
    server = socket.create_server(('127.0.0.1', 0))

    def controller():
        connection, _ = server.accept()
        with connection, connection.makefile('rw', newline='\r\n') as stream:
            for line in stream:
                command = line.strip()
                moving = command == 'STR1' and MOVE in commands and 'STP1/1' not in commands
                stream.write(f'C\t{command.split("/")[0]}\t{int(moving)}\r\n')
                stream.flush()
                commands.append(command)

    thread = threading.Thread(target=controller)
    thread.start()

    def program():
        stage = Aries('127.0.0.1', server.getsockname()[1])
        for name, value in settings.items():
            setattr(stage, name, value)
        stage.position = (90, 0, 0, 0)
        assert not stage.is_stopped
        raise KeyboardInterrupt

    try:
        program()
    except KeyboardInterrupt:
        pass
    thread.join(10)
    assert not thread.is_alive()  # So the destructor has closed the connection.
    server.close()
    return [command for command in commands if not command.startswith(('RDP', 'STR'))]


assert Aries.ignore_safety_stop is False and '非常停止信号を発行しない。デフォルトはFalse' in Aries.__doc__
for name, settings, expected in (('default', {}, [MOVE]),
                                 ('ignore_safety_stop', {'ignore_safety_stop': True}, [MOVE, *STOPS])):
    commands = told(**settings)
    print(f'{name}: the stage was told {" ".join(commands)} before the connection was closed')
    assert commands == expected, commands
PYTHON
