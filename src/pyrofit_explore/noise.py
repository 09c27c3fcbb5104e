"""The noise of the fitted signals, estimated in a process of its own: it takes up to minutes.

The process gives way to the simulations of the page.

Run as a program, this module reads a study and its measurements, and writes the noise.
"""

import os
import pickle
import subprocess
import sys
import threading
from pathlib import Path

from pyrofit.config import Study
from pyrofit.errors import PyrofitError
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.estimate.targets import Measurements
from pyrofit.plugins import use_plugins
from pyrofit_explore.model import free_parameters

Noise = tuple[NoiseModel, ...]


class PendingNoise:
    """Noise that another process estimates."""

    def __init__(self, study: Study, measurements: Measurements) -> None:
        self._found: Noise | str | None = None
        self._process = subprocess.Popen(
            [sys.executable, "-c", f"from {__name__} import main; main()"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        given = pickle.dumps((study, dict(measurements)))
        self._thread = threading.Thread(target=self._receive, args=(given,), daemon=True)
        self._thread.start()

    def _receive(self, given: bytes) -> None:
        out, _ = self._process.communicate(given)
        ended = self._process.returncode
        self._found = pickle.loads(out) if ended == 0 else "the estimate of the noise was ended"

    def wait(self, seconds: float) -> None:
        """Wait for the noise, at most some seconds."""
        self._thread.join(seconds)

    @property
    def noise(self) -> Noise | None:
        """The noise of each fitted signal, once it is known."""
        return self._found if isinstance(self._found, tuple) else None

    @property
    def error(self) -> str:
        """Why there is none."""
        return self._found if isinstance(self._found, str) else ""

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._thread.join()


def main() -> None:
    """Read a study and its measurements from standard input, write its noise, or an error."""
    os.nice(5)
    study, measurements = pickle.load(sys.stdin.buffer)
    use_plugins([Path(folder) for folder in study.plugins])
    found: Noise | str
    try:
        asked = of_diagnosis(study, names=free_parameters(study))
        found = pose_likelihood(study, asked, measurements, study.fixed_values()).noise
    except PyrofitError as error:
        found = str(error)
    sys.stdout.buffer.write(pickle.dumps(found))
