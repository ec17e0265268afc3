# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts of figures, run in copies of one process that has loaded what all of them need.

A figure takes a second to draw, and its packages take another to load. Python's fork server loads them once a
run, when the first figure is due, and ends with the run. It loads nothing of this library: a script sees the
files as they are.
"""

import multiprocessing
import runpy
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

# snakemake.cli: each copy would load it, as the main module of the process that asks for it
LOADED = [
    "snakemake.cli", "snakemake.iocontainers", "numpy", "pandas", "matplotlib.pyplot",
    "matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf", "fontTools.subset",
]  # fmt: skip


def share_process(script_class: Any, prefix: str = "plot_") -> None:
    """Have the scripts of some rules run in copies of one process; those with a benchmark run as before.

    Parameters
    ----------
    script_class : type
        Snakemake's ``PythonScript``; its ``execute_script`` is replaced.
    prefix : str
        Of the scripts' names.
    """
    plainly = script_class.execute_script
    if plainly.__module__ == __name__:  # the Snakefile is read again for the second bed
        return
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(LOADED)
    context.set_executable(shlex.split(sys.executable)[0])  # as `workflow.quote_interpreter` left it

    def execute_script(job: Any, file: str, edit: bool = False) -> None:
        other_python = job.conda_env or job.container_img or job.env_modules
        named = Path(str(job.path.get_path_or_uri(secret_free=True))).name.startswith(prefix)
        if edit or not named or job.bench_record is not None or other_python:
            plainly(job, file, edit)
            return
        process = context.Process(target=run_script, args=(file,))
        process.start()
        process.join()
        if process.exitcode:
            raise subprocess.CalledProcessError(process.exitcode, f"{sys.executable} {file}")

    script_class.execute_script = execute_script


def run_script(file: str) -> None:
    """Run a file as the main program of this process."""
    sys.argv = [file]
    sys.path.insert(0, str(Path(file).parent))
    runpy.run_path(file, run_name="__main__")
