# SPDX-License-Identifier: GPL-3.0-or-later
"""VTK's own readers, in a process that may die: over some damaged files VTK aborts, or never ends.

The process gets a path a line on its standard input. It answers with a line of JSON, then with the bytes of
the arrays that the line names. There are as many processes as threads read at once; they end with this one.
"""

import json
import os
import queue
import subprocess
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from resource import RLIM_INFINITY, RLIMIT_AS, RLIMIT_CPU, RLIMIT_DATA, getrlimit, setrlimit
from typing import IO, Any

import numpy as np

from bedchain.errors import DataError
from bedchain.trajectory.forms.legacy_vtk import Values

LONGEST_S, SLOWEST_BYTES_S = 30.0, 1e6  # of processor time: a busy machine makes no file a bad one
# memory beyond what the process has at its start: ascii, base64 and zlib unpack by less than the factor
ROOM_BYTES, ROOM_FACTOR = 512 * 2**20, 60
BROKE_DOWN = "VTK breaks down over it, or goes on and on: the file is damaged"


class VtkProcess:
    """A process that reads VTK files; it is started by the first file, and anew after it has died."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def read(self, path: Path) -> Values:
        """Points and arrays of a file.

        Raises
        ------
        DataError
            VTK cannot read it, or the process has died of it or of its limits.
        """
        process = self._process if self._process and self._process.poll() is None else _started()
        self._process = process
        assert process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(json.dumps(str(path.absolute())).encode() + b"\n")
            process.stdin.flush()
            header = json.loads(process.stdout.readline())
            arrays = [_array(process.stdout, *about) for about in header.get("arrays", ())]
        except (ValueError, OSError) as error:  # nothing, or half of an answer
            self.close()
            raise DataError(BROKE_DOWN) from error
        if "error" in header:
            raise DataError(header["error"])
        return Values(arrays[0], dict(zip(header["names"], arrays[1:], strict=True)))

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def __del__(self) -> None:
        self.close()


_IDLE: "queue.SimpleQueue[VtkProcess]" = queue.SimpleQueue()


def read_values(path: Path) -> Values:
    """Points and arrays of a file, by a process that is at leisure or a new one; see `VtkProcess.read`."""
    try:
        process = _IDLE.get_nowait()
    except queue.Empty:
        process = VtkProcess()
    try:
        return process.read(path)
    finally:
        _IDLE.put(process)


def _started() -> "subprocess.Popen[bytes]":
    library = str(Path(__file__).parents[3])
    paths = [library, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths), "VTK_SMP_MAX_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-c", f"from {__name__} import serve; serve()"],
        env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip


def _array(stream: IO[bytes], kind: str, shape: Sequence[int]) -> np.ndarray:
    dtype = np.dtype(kind)
    size = dtype.itemsize * int(np.prod(shape, dtype=np.int64))
    content = stream.read(size)
    if len(content) < size:
        raise ValueError("half of an array")
    return np.frombuffer(content, dtype).reshape(shape)


def serve() -> None:
    """The process itself: answers until its input ends."""
    answers = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):  # VTK writes to both, thousands of lines over some files
        os.dup2(nowhere, stream)
    _, hard = getrlimit(RLIMIT_AS)
    setrlimit(RLIMIT_AS, (hard, hard))
    import pyvista

    pyvista.PolyData(np.zeros((1, 3)))  # what VTK takes once
    for line in sys.stdin.buffer:
        path = Path(json.loads(line))
        try:
            _limit(path.stat().st_size)
            values = _values(path, pyvista)
            arrays = [values.points, *values.fields.values()]
            header = {"names": list(values.fields), "arrays": [(a.dtype.str, a.shape) for a in arrays]}
        except Exception as error:  # whatever VTK or pyvista raise
            header, arrays = {"error": f"VTK cannot read it ({' '.join(str(error).split())[:200]})"}, []
        answers.write(json.dumps(header).encode() + b"\n")
        for array in arrays:
            answers.write(np.ascontiguousarray(array).tobytes())
        answers.flush()


def _limit(size: int) -> None:
    """Let a number in a header that is believed end this process: by memory, and by processor time."""
    busy = os.times()
    longest_s = int(busy.user + busy.system + LONGEST_S + size / SLOWEST_BYTES_S)
    setrlimit(RLIMIT_CPU, (longest_s, getrlimit(RLIMIT_CPU)[1]))
    in_use = 4096 * int(Path("/proc/self/statm").read_text().split()[5])
    _, hard = getrlimit(RLIMIT_DATA)
    room = in_use + ROOM_BYTES + ROOM_FACTOR * size
    setrlimit(RLIMIT_DATA, (room if hard == RLIM_INFINITY else min(room, hard), hard))


def _values(path: Path, pyvista: Any) -> Values:
    with warnings.catch_warnings(), pyvista.VtkErrorCatcher(raise_errors=True, send_to_logging=False):
        warnings.simplefilter("ignore")  # what VTK warns of, it also raises
        mesh = pyvista.read(path)
    if not isinstance(mesh, pyvista.PointSet | pyvista.PolyData | pyvista.UnstructuredGrid):
        raise DataError(f"a data set of the kind {type(mesh).__name__} holds no particles")
    points = np.asarray(mesh.points)
    data = mesh.point_data if len(mesh.point_data) else mesh.cell_data
    arrays = {name: np.asarray(array) for name, array in data.items()}
    wanted = {name: a for name, a in arrays.items() if len(a) == len(points) and a.dtype.kind in "iufb"}
    return Values(points, wanted)
