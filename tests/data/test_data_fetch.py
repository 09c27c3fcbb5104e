import errno
import hashlib
import os
import socket
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pooch
import pytest

from pyrofit.data import fetch as module
from pyrofit.data.download import sha256
from pyrofit.data.fetch import fetch, locate, missing, registry, store
from pyrofit.errors import DataError

FILES = {"LICENSE": b"free\n", "PMMA/a.csv": b"Time\n1\n", "PMMA/deep/b.csv": b"Time\n2\n"}


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def upstream(tmp_path: Path) -> Path:
    folder = tmp_path / "upstream"
    for name, content in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


@pytest.fixture
def url(upstream: Path) -> Iterator[str]:
    handler = partial(QuietHandler, directory=str(upstream))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
        thread.join()


@pytest.fixture(autouse=True)
def small_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in FILES.items()}
    monkeypatch.setattr(module, "registry", lambda: dict(digests))


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache, no mirror, and no proxy on the way to the local server."""
    monkeypatch.delenv("PYROFIT_DATA_DIR", raising=False)
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    monkeypatch.setattr(pooch, "os_cache", lambda name: tmp_path / "cache" / name)
    return tmp_path / "cache" / "pyrofit" / "macfp-14b73ea959d3"


def files_below(folder: Path) -> list[str]:
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def test_registry_lists_the_needed_files_with_their_checksums() -> None:
    listed = registry()
    assert "LICENSE" in listed
    assert sum("UMET_TGA_N2" in name for name in listed) == 7
    assert sum("UMD_CAPA" in name for name in listed) == 4
    assert "PMMA/Calibration_Data/UMD/UMD_TGA_N2_10K.csv" in listed
    assert sum("PMMA" in name and "Gasification" in name for name in listed) == 8
    assert sum("UMD_Wood_CAPA" in name for name in listed) == 9
    assert len(listed) == 57
    assert not any("NIST" in name for name in listed)
    assert all(len(digest) == 64 and int(digest, 16) for digest in listed.values())


def test_store_is_the_cache_of_the_commit(cache: Path) -> None:
    assert store() == cache


def test_store_is_the_mirror_if_set(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(tmp_path))
    assert store() == tmp_path


def test_empty_variable_counts_as_unset(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYROFIT_DATA_DIR", "")
    assert store() == cache


@pytest.mark.parametrize("name", ["nowhere", "file"])
def test_mirror_that_is_no_folder_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(tmp_path / name))
    for ask in (store, fetch):
        with pytest.raises(DataError, match="must be an existing folder"):
            ask()


def test_files_are_fetched_once(url: str, cache: Path, upstream: Path) -> None:
    assert missing(store())
    assert missing(cache) == list(FILES)
    paths = fetch(base_url=url)
    assert paths == [cache / name for name in FILES]
    assert [path.read_bytes() for path in paths] == list(FILES.values())
    assert files_below(cache) == sorted(FILES)
    assert not missing(store())
    for name in FILES:
        (upstream / name).unlink()
    assert fetch(base_url=url) == paths


def test_fetch_is_silent_where_no_terminal_looks(
    url: str, capfd: pytest.CaptureFixture[str]
) -> None:
    fetch(base_url=url)
    assert capfd.readouterr() == ("", "")


def test_only_missing_and_altered_files_are_fetched(url: str, cache: Path, upstream: Path) -> None:
    fetch(base_url=url)
    (cache / "LICENSE").unlink()
    (cache / "PMMA/a.csv").write_bytes(b"altered")
    (upstream / "PMMA/deep/b.csv").unlink()
    fetch(base_url=url)
    assert (cache / "LICENSE").read_bytes() == FILES["LICENSE"]
    assert (cache / "PMMA/a.csv").read_bytes() == FILES["PMMA/a.csv"]


def test_wrong_checksum_leaves_no_file(url: str, cache: Path, upstream: Path) -> None:
    (upstream / "PMMA/a.csv").write_bytes(b"altered upstream")
    with pytest.raises(DataError, match=r"a.csv: SHA-256 is .* is registered; nothing was kept"):
        fetch(base_url=url)
    assert files_below(cache) == ["LICENSE"]


def test_wrong_download_keeps_the_file_that_was_there(
    url: str, cache: Path, upstream: Path
) -> None:
    cache.mkdir(parents=True)
    (cache / "LICENSE").write_bytes(b"mine")
    (upstream / "LICENSE").write_bytes(b"altered upstream")
    with pytest.raises(DataError, match="SHA-256"):
        fetch(base_url=url)
    assert (cache / "LICENSE").read_bytes() == b"mine"


def test_file_absent_upstream_is_named_with_the_status(
    url: str, cache: Path, upstream: Path
) -> None:
    (upstream / "PMMA/deep/b.csv").unlink()
    with pytest.raises(DataError, match=r"b.csv: the download failed \(HTTP status 404\)"):
        fetch(base_url=url)
    assert files_below(cache) == ["LICENSE", "PMMA/a.csv"]


def test_no_network_is_explained(cache: Path) -> None:
    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{closed.getsockname()[1]}/"
        with pytest.raises(DataError, match=r"download failed .*network.*PYROFIT_DATA_DIR"):
            fetch(base_url=address)
    assert files_below(cache) == []


WRITE_FAILURES = [
    (errno.ENOSPC, "the disk is full. Free some space"),
    (errno.EACCES, "the folder may not be written. Change its permissions"),
    (errno.EROFS, "the folder may not be written"),
    (errno.EIO, r"cannot be written \(Input/output error\)"),
]


@pytest.mark.parametrize(("code", "message"), WRITE_FAILURES)
def test_failed_write_is_explained_and_leaves_no_file(
    cache: Path, monkeypatch: pytest.MonkeyPatch, code: int, message: str
) -> None:
    class Failing:
        def __init__(self, **options: object) -> None:
            pass

        def __call__(self, url: str, target: str, pooch: object) -> None:
            Path(target).write_bytes(b"half a fi")
            raise OSError(code, os.strerror(code))

    monkeypatch.setattr(pooch, "HTTPDownloader", Failing)
    with pytest.raises(DataError, match=message) as error:
        fetch()
    assert str(cache / "LICENSE") in str(error.value)
    assert "XDG_CACHE_HOME" in str(error.value)
    assert files_below(cache) == []


def test_folder_that_cannot_be_made_is_explained(url: str, cache: Path) -> None:
    cache.parent.mkdir(parents=True)
    cache.write_bytes(b"a file where the folder should be")
    with pytest.raises(DataError, match="cannot be written"):
        fetch(base_url=url)


def test_located_file_is_verified(url: str, cache: Path) -> None:
    fetch(base_url=url)
    assert locate("PMMA/a.csv") == cache / "PMMA/a.csv"
    (cache / "PMMA/a.csv").write_bytes(b"altered")
    with pytest.raises(DataError, match=r"Delete it and run `pyrofit data fetch`") as error:
        locate("PMMA/a.csv")
    assert hashlib.sha256(b"altered").hexdigest() in str(error.value)
    assert hashlib.sha256(FILES["PMMA/a.csv"]).hexdigest() in str(error.value)


def test_missing_file_tells_both_ways_to_get_it() -> None:
    with pytest.raises(DataError, match=r"`make data`.*PYROFIT_DATA_DIR"):
        locate("LICENSE")


def test_unknown_file_names_the_nearest_one() -> None:
    with pytest.raises(DataError, match=r"unknown measured file 'PMMA/c.csv'. Did you mean 'PMMA/"):
        locate("PMMA/c.csv")


def test_mirror_is_verified_and_never_written(
    upstream: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYROFIT_DATA_DIR", str(upstream))
    assert fetch(base_url="http://127.0.0.1:9/") == [upstream / name for name in FILES]
    (upstream / "LICENSE").write_bytes(b"altered")
    with pytest.raises(DataError, match=r"Delete it and put https://raw.*/LICENSE in its place"):
        fetch(base_url="http://127.0.0.1:9/")
    (upstream / "LICENSE").unlink()
    with pytest.raises(DataError, match="is not there"):
        fetch(base_url="http://127.0.0.1:9/")
    assert not cache.exists()


def test_unreadable_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="cannot be read"):
        sha256(tmp_path)
