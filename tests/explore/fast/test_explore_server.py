"""The server of the explorer answers its own page alone."""

import http.client
import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pytest

from pyrofit.errors import StudyError
from pyrofit_explore.page import page
from pyrofit_explore.server import LONGEST, Server, in_background

Given = Mapping[str, Any]


def refuse(given: Given) -> Given:
    raise StudyError("the study has no such thing")


def fail(given: Given) -> Given:
    raise ZeroDivisionError("of a run")


def count(given: Given, send: Callable[[Given], None]) -> None:
    for i in range(given["to"]):
        send({"i": i})
    raise StudyError("the end")


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    actions = {"echo": lambda given: given, "refuse": refuse, "fail": fail}
    made = Server(actions, {"count": count})
    in_background(made)
    yield made
    made.shutdown()
    made.server_close()


def asked(
    server: Server, method: str, path: str, body: bytes | None = None, **headers: str
) -> tuple[http.client.HTTPResponse, str]:
    line = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    line.request(method, path, body, headers)
    answer = line.getresponse()
    text = answer.read().decode()
    line.close()
    return answer, text


def posted(server: Server, name: str, given: object, **headers: str) -> tuple[int, str]:
    own = {"X-Token": server.token, **headers}
    answer, text = asked(server, "POST", f"/{name}", json.dumps(given).encode(), **own)
    return answer.status, text


def test_server_listens_on_this_machine_alone(server: Server) -> None:
    assert server.server_address[0] == "127.0.0.1"


def test_a_port_that_is_taken_is_told(server: Server) -> None:
    for port in (server.server_port, 70_000):
        with pytest.raises(StudyError, match=f"port {port}: it cannot be used"):
            Server({}, {}, port)


def test_page_needs_its_token(server: Server) -> None:
    assert asked(server, "GET", f"/?token={server.token}")[0].status == 200
    for path in ("/", "/?token=", "/?token=wrong", f"/?token={server.token}x"):
        assert asked(server, "GET", path)[0].status == 403
    assert asked(server, "GET", f"/other?token={server.token}")[0].status == 404


def test_policy_lets_the_page_load_nothing_from_other_hosts(server: Server) -> None:
    answer, text = asked(server, "GET", f"/?token={server.token}")
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "connect-src 'self'" in policy
    assert "unsafe" not in policy
    nonce = policy.split("script-src 'nonce-")[1].split("'")[0]
    assert text.count(f'nonce="{nonce}"') == 3
    assert "://" not in text


def test_answers_need_token_host_and_origin(server: Server) -> None:
    own = f"127.0.0.1:{server.server_port}"
    assert posted(server, "echo", {"a": 1}) == (200, '{"a": 1}')
    assert posted(server, "echo", {}, Origin=f"http://{own}")[0] == 200
    assert posted(server, "echo", {}, Host=f"localhost:{server.server_port}")[0] == 200
    assert posted(server, "echo", {}, **{"X-Token": "wrong"})[0] == 403
    assert posted(server, "echo", {}, Origin="http://evil.example")[0] == 403
    assert posted(server, "echo", {}, Origin="null")[0] == 403
    assert posted(server, "echo", {}, Host=f"evil.example:{server.server_port}")[0] == 403


def test_errors_are_answers(server: Server) -> None:
    assert json.loads(posted(server, "refuse", {})[1]) == {"error": "the study has no such thing"}
    assert json.loads(posted(server, "fail", {})[1]) == {"error": "ZeroDivisionError: of a run"}
    assert "mapping in JSON" in json.loads(posted(server, "echo", [1])[1])["error"]
    assert posted(server, "none", {})[0] == 404
    assert posted(server, "echo", {})[0] == 200


def test_long_requests_are_refused_unread(server: Server) -> None:
    own = {"X-Token": server.token, "Content-Length": str(LONGEST + 1)}
    assert asked(server, "POST", "/echo", b"", **own)[0].status == 413


def test_parts_are_lines_and_the_last_one_is_the_error(server: Server) -> None:
    status, text = posted(server, "count", {"to": 2})
    assert status == 200
    assert [json.loads(line) for line in text.splitlines()] == [
        {"i": 0},
        {"i": 1},
        {"error": "the end"},
    ]


def test_text_of_a_study_cannot_end_the_script_of_a_page() -> None:
    text = page({"title": "</script><script>alert(1)</script>"})
    assert text.count("</script>") == 2
