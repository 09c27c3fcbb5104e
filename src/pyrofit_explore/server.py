"""A server for one study, on this machine alone: its page, and curves for the sets it asks for."""

import json
import secrets
import sys
import threading
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

from pyrofit.errors import PyrofitError, StudyError
from pyrofit_explore.page import page

LONGEST = 1_000_000
"""Bytes of a request at most."""
Given = Mapping[str, Any]
Send = Callable[[Given], None]
Actions = Mapping[str, Callable[[Given], Given]]
"""Answers by name of the request: from its content to the answer."""
Streams = Mapping[str, Callable[[Given, Send], None]]
"""The same of answers in several parts, each sent as soon as it is known."""


class Server(ThreadingHTTPServer):
    """Serves pages of a study on this machine.

    A page needs the token of its address. Other origins are refused, and so are requests that come
    by another name of this machine.

    Parameters
    ----------
    actions
        Requests that are answered at once.
    streams
        Requests that are answered in parts.
    port
        Port; 0 takes a free one.

    Raises
    ------
    StudyError
        The port is taken, or is none.
    """

    daemon_threads = True

    def __init__(self, actions: Actions, streams: Streams, port: int = 0) -> None:
        try:
            super().__init__(("127.0.0.1", port), _Handler)
        except (OSError, OverflowError) as error:
            raise StudyError(
                f"port {port}: it cannot be used ({error}); give another one, or none"
            ) from None
        self.actions, self.streams = actions, streams
        self.token = secrets.token_urlsafe(24)

    @property
    def origin(self) -> str:
        """Scheme, address and port."""
        return f"http://127.0.0.1:{self.server_port}"

    @property
    def address(self) -> str:
        """Address of the page, with its token."""
        return f"{self.origin}/?token={self.token}"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore a page that was closed; tell of all else."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    wbufsize = -1
    """Head and body leave together."""

    def do_GET(self) -> None:
        """Send the page."""
        asked = urlsplit(self.path)
        token = parse_qs(asked.query).get("token", [""])[0]
        if asked.path != "/":
            self._send(HTTPStatus.NOT_FOUND, b"there is only one page: /", "text/plain")
        elif not self._is_own(token):
            said = b"the address lacks its token; open the one that pyrofit explore prints"
            self._send(HTTPStatus.FORBIDDEN, said, "text/plain")
        else:
            nonce = secrets.token_urlsafe(16)
            self._send(HTTPStatus.OK, page({}, nonce).encode(), "text/html", _policy(nonce))

    def do_POST(self) -> None:
        """Answer a page."""
        size = self.headers.get("Content-Length", "")
        if not self._is_own(self.headers.get("X-Token", "")) or not size.isdigit():
            self.close_connection = True
            self._send(HTTPStatus.FORBIDDEN, b"refused", "text/plain")
            return
        if int(size) > LONGEST:
            self.close_connection = True
            self._send(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, b"too long", "text/plain")
            return
        name, body = self.path.removeprefix("/"), self.rfile.read(int(size))
        if name in self.server.streams:
            self._stream(self.server.streams[name], body)
        elif name in self.server.actions:
            self._answer(self.server.actions[name], body)
        else:
            self._send(HTTPStatus.NOT_FOUND, b"unknown", "text/plain")

    def _answer(self, act: Callable[[Given], Given], body: bytes) -> None:
        try:
            answer = act(_given(body))
        except Exception as error:
            answer = {"error": message_of(error)}
        self._send(HTTPStatus.OK, _json(answer), "application/json")

    def _stream(self, act: Callable[[Given, Send], None], body: bytes) -> None:
        """Send a line for each part, until there is no more or the page has gone."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "application/x-ndjson")
        self.send_header("Connection", "close")
        self.end_headers()

        def send(part: Given) -> None:
            self.wfile.write(_json(part) + b"\n")
            self.wfile.flush()

        try:
            act(_given(body), send)
        except ConnectionError:
            raise
        except Exception as error:
            send({"error": message_of(error)})

    def _is_own(self, token: str) -> bool:
        """Tell whether a request has the token, and comes from a page of this server."""
        port = self.server.server_port
        hosts = (f"127.0.0.1:{port}", f"localhost:{port}")
        origins = (None, *(f"http://{host}" for host in hosts))
        return (
            secrets.compare_digest(token.encode(), self.server.token.encode())
            and self.headers.get("Host") in hosts
            and self.headers.get("Origin") in origins
        )

    def _send(self, status: HTTPStatus, body: bytes, kind: str, policy: str = "") -> None:
        self.send_response(status)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        if policy:
            self.send_header("Content-Security-Policy", policy)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing of requests."""


def message_of(error: Exception) -> str:
    """Return the message of an error for the page."""
    return str(error) if isinstance(error, PyrofitError) else f"{type(error).__name__}: {error}"


def _given(body: bytes) -> Given:
    """Return the content that a page sends.

    Raises
    ------
    StudyError
        It is no mapping.
    """
    try:
        given = json.loads(body)
    except ValueError:
        given = None
    if not isinstance(given, dict):
        raise StudyError("a request is a mapping in JSON")
    return given


def _policy(nonce: str) -> str:
    """Allow the page nothing of other hosts."""
    return (
        f"default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; "
        "connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'"
    )


def _json(content: Mapping[str, Any]) -> bytes:
    return json.dumps(content, ensure_ascii=False, allow_nan=False).encode()


def in_background(server: Server) -> threading.Thread:
    """Serve in a thread until ``server.shutdown()``."""
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    return thread
