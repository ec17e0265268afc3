# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear whole or not at all, arrays in them, names of manifests, locks."""

import errno
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from bedchain.array_files import map_array, read_arrays
from bedchain.errors import DataError, UserError
from bedchain.files import (
    atomic_file,
    locked_folder,
    path_inside,
    refuse_special_file,
    write_arrays,
    write_text,
)
from made import ROOT


def test_arrays_come_back_exactly(tmp_path):
    path = tmp_path / "some.npz"
    arrays = {
        "a": np.arange(6, dtype=np.int32).reshape(2, 3),
        "b": np.array([np.pi, np.nan]),
        "c": np.array("text"),
    }
    write_arrays(path, arrays)
    again = read_arrays(path)
    for name, array in arrays.items():
        assert again[name].dtype == array.dtype and again[name].tobytes() == array.tobytes()
    assert map_array(path, "a").tolist() == [[0, 1, 2], [3, 4, 5]]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "some.npz"
    write_arrays(path, {"a": np.ones(3)})
    before = path.read_bytes()
    with pytest.raises(ValueError, match="[Oo]bject arrays"):
        write_arrays(path, {"a": np.zeros(1000), "odd": np.array([object()])})
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "name", ["a.bin", "dem/segment_0001", "absent/frame.bin", "./a.bin", "..a/b", "loop/a.bin"]
)
def test_paths_within_a_folder_pass_even_where_the_folder_is_a_link(tmp_path, name):
    (tmp_path / "disk").mkdir()
    (tmp_path / "disk" / "a.bin").touch()
    (tmp_path / "disk" / "loop").symlink_to(tmp_path / "disk")
    (tmp_path / "results").symlink_to(tmp_path / "disk")
    assert path_inside(tmp_path / "results", name) == tmp_path / "results" / name


@pytest.mark.parametrize(
    "name", ["/etc/passwd", "../a.bin", "dem/../../a.bin", "", None, 3, "a\0b", "a" * 5000]
)
def test_names_that_are_no_relative_path_are_refused(tmp_path, name):
    with pytest.raises(DataError, match="make the manifest again"):
        path_inside(tmp_path, name)


def test_links_out_of_the_folder_and_in_circles_are_refused(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "out").symlink_to(tmp_path)
    (tmp_path / "run" / "circle").symlink_to("circle")
    for name in ("out", "out/frame.bin"):
        with pytest.raises(DataError, match="is a link to"):
            path_inside(tmp_path / "run", name)
    with pytest.raises(DataError, match="cannot be reached"):
        path_inside(tmp_path / "run", "circle")


def test_special_files_are_refused_before_they_are_opened(tmp_path):
    os.mkfifo(tmp_path / "frame.bin")
    with pytest.raises(DataError, match=r"frame.bin is a special file \(pipe, socket or device\)"):
        path_inside(tmp_path, "frame.bin")
    with pytest.raises(DataError, match="is a special file"):
        refuse_special_file(Path("/dev/zero"))


def test_a_full_disk_or_a_folder_in_the_way_names_the_file_that_was_to_be(tmp_path):
    target = tmp_path / "table.csv"
    with pytest.raises(UserError, match="table.csv: no space is left on its disk"), atomic_file(target):
        raise OSError(errno.ENOSPC, "No space left on device")
    target.mkdir()
    with pytest.raises(UserError, match="table.csv: a folder stands in its place"):
        write_text(target, "x")
    assert list(tmp_path.iterdir()) == [target]
    (tmp_path / "file").touch()
    with pytest.raises(FileExistsError):  # `errors.report_user_errors` has the sentence
        write_text(tmp_path / "file" / "a.csv", "x")


def test_an_error_over_another_file_keeps_its_name(tmp_path):
    with pytest.raises(FileNotFoundError, match="other"), atomic_file(tmp_path / "table.csv"):
        (tmp_path / "other").read_text()


def test_what_a_killed_process_left_half_written_is_removed_by_the_next(tmp_path):
    ended = subprocess.Popen(["true"])
    ended.wait()
    (tmp_path / f".table.{ended.pid}.csv").write_text("half")
    (tmp_path / f".table.{os.getpid()}.csv").write_text("ours")
    (tmp_path / ".table.notes.csv").write_text("a user's")
    write_text(tmp_path / "table.csv", "x")
    assert sorted(file.name for file in tmp_path.iterdir()) == [".table.notes.csv", "table.csv"]


def test_a_lock_waits_for_the_solvers_of_a_killed_process_and_no_longer(tmp_path):
    code = (
        "import sys, subprocess; from pathlib import Path; from bedchain.files import locked_folder\n"
        "with locked_folder(Path(sys.argv[1])):\n"
        "    subprocess.Popen(['sleep', sys.argv[2]], close_fds=False); print(flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", code, str(tmp_path), "1.5"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "scripts")}
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment) as holder:
        holder.stdout.readline()
        with pytest.raises(UserError, match=f"in use by process {holder.pid}"), locked_folder(tmp_path):
            pass
        holder.kill()
        holder.wait()
        began = time.monotonic()
        with locked_folder(tmp_path):
            assert time.monotonic() - began < 15
