# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts of rules, run in copies of one process that has loaded what most of them need.

Many a script works for a second, and its packages take another to load. Python's fork server loads them once
a run, when the first script is due, and ends with the run. It loads nothing of this library: a script sees
the files as they are.
"""

import contextlib
import multiprocessing
import os
import runpy
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

from snakemake.benchmark import benchmarked

# snakemake.cli: each copy would load it, as the main module of the process that asks for it
LOADED = [
    *("snakemake.cli", "snakemake.iocontainers", "numpy", "pandas", "numba", "tqdm", "matplotlib.pyplot"),
    *("scipy.sparse.linalg", "scipy.sparse.csgraph", "scipy.spatial", "scipy.special"),
    *("matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf", "fontTools.subset"),
]

# read when a package is loaded: no script draws its speed from more threads than one
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def share_process(script_class: Any) -> None:
    """Have the scripts of rules run in copies of one process; those of another Python run as before.

    Parameters
    ----------
    script_class : type
        Snakemake's ``PythonScript``; its ``execute_script`` is replaced.
    """
    plainly = script_class.execute_script
    if plainly.__module__ == __name__:  # the Snakefile is read again for the second bed
        return
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(LOADED)
    context.set_executable(shlex.split(sys.executable)[0])  # as `workflow.quote_interpreter` left it
    os.environ.update(dict.fromkeys(THREADS, "1"))  # of the server; a shell's are set by snakemake

    def execute_script(job: Any, file: str, edit: bool = False) -> None:
        other_python = job.conda_env or job.container_img or job.env_modules
        if edit or other_python:
            plainly(job, file, edit)
            return
        process = context.Process(target=run_script, args=(file,))
        process.start()
        record = job.bench_record
        with contextlib.nullcontext() if record is None else benchmarked(process.pid, record):
            process.join()
        if process.exitcode:
            raise subprocess.CalledProcessError(process.exitcode, f"{sys.executable} {file}")

    script_class.execute_script = execute_script


def run_script(file: str) -> None:
    """Run a file as the main program of this process."""
    sys.argv = [file]
    sys.path.insert(0, str(Path(file).parent))
    runpy.run_path(file, run_name="__main__")
