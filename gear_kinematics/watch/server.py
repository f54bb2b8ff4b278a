# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Serves the page of `gearkin watch` on this machine, to browsers that have its address."""

import asyncio
import hmac
import json
import logging
import secrets
import socket
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from typing import Any

from rich.console import Console
from tornado.httpserver import HTTPServer
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from gear_kinematics.watch.gear import Answer
from gear_kinematics.watch.page import drawing, watch_page
from gear_kinematics.watch.view import UNANSWERED
from gear_kinematics.watch.watcher import PERIOD, Watcher

HOST = '127.0.0.1'
_NAMES = (HOST, 'localhost')
"""Host names of requests. A page from elsewhere whose name is redirected here (DNS rebinding) has
another host name; a forwarded port has another number."""
_LARGEST = 4096  # bytes of a request's body, and of a command
_ANSWER = 5.0  # s to wait for the answer of the node


def serve(watcher: Watcher, console: Console, stopped: Callable[[], bool]) -> None:
    """Serve the page until stopped; its address is printed."""
    server = Server(watcher)
    console.print(f'Open {server.address}', soft_wrap=True, markup=False, highlight=False)
    asyncio.run(server.run(stopped))


class Server:
    """The page, with a new secret in its address."""

    def __init__(self, watcher: Watcher) -> None:
        """Open a free port."""
        token = secrets.token_urlsafe(24)
        self._socket = socket.create_server((HOST, 0))
        self._socket.setblocking(False)  # noqa: FBT003, its only argument
        given = {'watcher': watcher, 'token': token}
        self._application = Application(
            [(r'/([^/]+)/', _Page, given), (r'/([^/]+)/live', _Live, given)],
            log_function=lambda _: None,
            websocket_max_message_size=_LARGEST,
        )
        self.address = f'http://{HOST}:{self._socket.getsockname()[1]}/{token}/'

    async def run(self, stopped: Callable[[], bool]) -> None:
        """Serve until stopped; requests have no body, and a large one is refused unread."""
        server = HTTPServer(self._application, max_body_size=_LARGEST)
        server.add_socket(self._socket)
        try:
            while not stopped():  # noqa: ASYNC110, a signal only sets a flag
                await asyncio.sleep(PERIOD)
        finally:
            server.stop()
            await server.close_all_connections()


class _Guarded(RequestHandler):
    """Refuses whoever does not know the token, and pages of other origins."""

    _origins: tuple[str | None, ...] = (None,)  # in addition to its own

    def initialize(self, watcher: Watcher, token: str) -> None:
        """Take the watcher and the token, which all requests have in common."""
        self._watcher, self._token = watcher, token

    def prepare(self) -> None:
        """Check a request before anything else; raises HTTPError if it is refused."""
        origins = (*self._origins, f'http://{self.request.host}')
        if (
            self.request.host_name not in _NAMES
            or not hmac.compare_digest(self.path_args[0].encode(), self._token.encode())
            or self.request.headers.get('Origin') not in origins
        ):
            raise HTTPError(403)

    def set_default_headers(self) -> None:
        """Forbid caching and framing of the page, and sending its address to others."""
        self.clear_header('Server')
        self.set_header('Cache-Control', 'no-store')
        self.set_header('Content-Security-Policy', "frame-ancestors 'none'")
        self.set_header('Cross-Origin-Resource-Policy', 'same-origin')
        self.set_header('Referrer-Policy', 'no-referrer')
        self.set_header('X-Content-Type-Options', 'nosniff')

    def log_exception(self, kind: Any, error: Any, trace: Any) -> None:
        """Log the error without the address, which contains the token."""
        if not isinstance(error, HTTPError | WebSocketClosedError | asyncio.CancelledError):
            logging.getLogger(__name__).error('', exc_info=(kind, error, trace))


class _Page(_Guarded):
    async def get(self, _token: str) -> None:
        self.finish(watch_page(f'ws://{self.request.host}'))


class _Live(_Guarded, WebSocketHandler):
    """Sends the latest view at most thirty times a second, and takes commands."""

    _origins = ()  # browsers always name that of a WebSocket

    def open(self, _token: str) -> None:
        self._sending = asyncio.create_task(self._send())

    def on_close(self) -> None:
        self._sending.cancel()

    async def on_message(self, message: str | bytes) -> None:
        """Do what a button asks for, and answer in words."""
        try:
            asked = asyncio.wrap_future(self._watcher.ask(json.loads(message)))
            answer = await asyncio.wait_for(asked, _ANSWER)
        except (ValueError, RecursionError):
            answer = Answer('There is no such command.', done=False)
        except TimeoutError:
            answer = Answer(UNANSWERED, done=False)
        with suppress(WebSocketClosedError):  # who asked may have left meanwhile
            await self.write_message({'answer': answer._asdict()})

    async def _send(self) -> None:
        drawn = None
        loop = asyncio.get_running_loop()
        with suppress(WebSocketClosedError):
            while True:
                due = loop.time() + PERIOD
                view = self._watcher.view
                if self._watcher.drawn != drawn:
                    drawn = self._watcher.drawn
                    html = await loop.run_in_executor(None, drawing, *drawn)
                    await self.write_message({'drawing': html})
                await self.write_message({'view': asdict(view)})  # until it has gone out
                await asyncio.sleep(due - loop.time())
