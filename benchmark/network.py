# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Two hosts on this machine, joined by a cable that can be pulled and can lose packets.

A host is a Linux network namespace. It has no name and no way out, and it is gone with the last
process in it and the last file that refers to it, however this process ends.
"""

import ctypes
import json
import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager

CARD = 'eth0'
ADDRESS = '02:00:00:00:00:01'
MASK = 30  # bits: a subnet of two
_PATIENCE = 10.0  # s: the kernel takes up to one
_CLONE_NEWNET = 0x40000000  # os.CLONE_NEWNET from Python 3.12 on
_LOSS = """
add table inet faults
add counter inet faults dropped
add chain inet faults arriving {{ type filter hook input priority filter; }}
flush chain inet faults arriving
add rule inet faults arriving iifname {card} numgen random mod 100 < {percent} \
counter name dropped drop
"""
_libc = ctypes.CDLL(None, use_errno=True)


class NoNetworkError(RuntimeError):
    """This machine or this user cannot make such hosts; the text says why."""


class Host:
    """A network namespace with nothing but a loopback and, once it is connected, a card."""

    def __init__(self) -> None:
        """Make it.

        Raises:
            NoNetworkError: without the right to.
        """
        try:
            # In a thread of its own, which needs no way back.
            with ThreadPoolExecutor(1) as pool:
                pool.submit(_call, 'unshare', _CLONE_NEWNET).result()
                self._namespace = pool.submit(_open_namespace).result()
        except OSError as error:
            raise NoNetworkError(
                f'{error}: network namespaces need root, or unshare --map-root-user --net'
            ) from error
        # For other processes.
        self.path = f'/proc/{os.getpid()}/fd/{self._namespace}'

    def close(self) -> None:
        """Let go of it."""
        os.close(self._namespace)

    @contextmanager
    def entered(self) -> Iterator[None]:
        """Let what this thread starts in the meantime be on this host."""
        here = _open_namespace()
        _call('setns', self._namespace, _CLONE_NEWNET)
        try:
            yield
        finally:
            _call('setns', here, _CLONE_NEWNET)
            os.close(here)

    def run(self, *command: str, text: str | None = None) -> str:
        """Run a program to its end and return what it prints.

        Raises:
            NoNetworkError: if it fails.
        """
        with self.entered():
            done = subprocess.run(  # noqa: S603, the commands below
                command, capture_output=True, check=False, input=text, text=True
            )
        if done.returncode:
            raise NoNetworkError(f'{" ".join(command)}: {done.stderr.strip()}')
        return done.stdout

    def card(self) -> dict:
        """Return the state and the counters of the card, by iproute2's names."""
        [card] = json.loads(self.run('ip', '-json', '-statistics', 'link', 'show', 'dev', CARD))
        return card

    def switch_card(self, state: str) -> None:
        """Switch the card 'up' or 'down'."""
        self.run('ip', 'link', 'set', 'dev', CARD, state)

    def lose(self, percent: int) -> None:
        """Drop arriving packets at random from now on."""
        self.run('nft', '-f', '-', text=_LOSS.format(card=CARD, percent=percent))

    def dropped(self) -> int:
        """Count the packets that were dropped on arrival."""
        listed = self.run('nft', '--json', 'list', 'counter', 'inet', 'faults', 'dropped')
        [packets] = [
            entry['counter']['packets']
            for entry in json.loads(listed)['nftables']
            if 'counter' in entry
        ]
        return packets


class Cable:
    """Joins two hosts."""

    def __init__(self, one: Host, other: Host) -> None:
        """Plug it in."""
        self._ends = one, other
        # With one address for both, no card asks for the other's. After a cut the kernel may lose
        # the answer to that, and it asks again a second later.
        card = ('name', CARD, 'address', ADDRESS, 'arp', 'off')
        one.run('ip', 'link', 'add', *card, 'type', 'veth', 'peer', *card, 'netns', other.path)
        for number, host in enumerate(self._ends, start=1):
            host.run('ip', 'address', 'add', f'10.0.0.{number}/{MASK}', 'dev', CARD)
            host.run('ip', 'link', 'set', 'dev', 'lo', 'up')
            host.switch_card('up')
            host.lose(0)
        self._wait_for_carrier()

    def lose(self, percent: int) -> None:
        """Drop packets at random in both directions from now on."""
        for host in self._ends:
            host.lose(percent)

    @contextmanager
    def pulled(self) -> Iterator[None]:
        """Pull it in the meantime.

        The one host's card is switched off. The other one's loses its carrier, but stays up and
        keeps its address, as with a real cable.
        """
        one, _ = self._ends
        one.switch_card('down')
        try:
            yield
        finally:
            one.switch_card('up')
            self._wait_for_carrier()

    def _wait_for_carrier(self) -> None:
        """Wait until the kernel reports the carrier, which takes it up to a second.

        Before, it sends nothing there, and middleware that starts does not see the card.
        """
        deadline = time.monotonic() + _PATIENCE
        while not all(host.card()['operstate'] == 'UP' for host in self._ends):
            if time.monotonic() > deadline:
                raise NoNetworkError('the cable does not come up')
            time.sleep(0.01)


@contextmanager
def two_hosts() -> Iterator[tuple[Host, Host, Cable]]:
    """Make two hosts and the cable between them.

    Raises:
        NoNetworkError: if rights or tools are lacking.
    """
    for tool in ('ip', 'nft'):
        if not shutil.which(tool):
            raise NoNetworkError(f'there is no {tool} on the path')
    with closing(Host()) as one, closing(Host()) as other:
        yield one, other, Cable(one, other)


def _open_namespace() -> int:
    """Open the network namespace of this thread."""
    return os.open('/proc/thread-self/ns/net', os.O_RDONLY)


def _call(function: str, *arguments: int) -> None:
    """Call the C library.

    Raises:
        OSError: as errno says.
    """
    if getattr(_libc, function)(*arguments):
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
