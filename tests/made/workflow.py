# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of the repository, and the jobs of a dry run in them, planned inside this process."""

import os
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from modulefinder import ModuleFinder
from pathlib import Path
from typing import Any

import pytest
from snakemake.api import SnakemakeApi
from snakemake.jobs import get_script_mtime
from snakemake.settings.enums import Quietness
from snakemake.settings.types import ConfigSettings, DAGSettings, OutputSettings, ResourceSettings

from made import ROOT

# rules of the target `all`, of a case with gas that is simulated
BED = {"build_solver", "write_parameters", "run_dem", "repeat_dem", "parse_dumps", "measure_mixing"}
CHAINS = {
    "choose_chain",
    "assign_cells",
    "build_transitions",
    "run_chain",
    "compare_mixing",
    "time_models",
    "diagnose_chains",
}
FIGURES = {
    *("plot_cells", "plot_cost", "plot_distribution", "plot_mixing", "plot_snapshot", "plot_difference"),
    *("plot_chapman_kolmogorov", "plot_timescales", "plot_stationarity", "plot_discussion", "make_film"),
    *("plot_choice", "plot_modes", "plot_bubbles"),
}
TABLES = {"write_table", "write_provenance", "discuss_errors", "write_report"}
ALL = {"audit_scene"} | BED | CHAINS | FIGURES | TABLES
# rules of the studies
SCORES = {"score_models", "plot_pareto", "plot_best_mixing", "plot_autocorrelation"}
TRADEOFF = {"run_variant", "study_tradeoff", "plot_tradeoff", "plot_variants"}

# rules whose shell line an edit of their script does not run again
STABLE = {"build_solver", "write_parameters", "run_dem", "repeat_dem", "run_variant"}

ODD_NAME = "it's my & Ünï (1) #x;%+=,@!~[]*?<>|"  # all that the name of a folder may hold

COPIED = ("Snakefile", "cases", "scripts", "openfoam_case", "liggghts_inputs", "envs/python.yaml")


@dataclass
class Plan:
    """Jobs of a dry run.

    Attributes
    ----------
    jobs : Counter
        Rule -> jobs that would run, without those of targets.
    after : dict of str to set of str
        Rule -> rules that take its outputs.
    outputs : list of str
        Files of all jobs, also of those that need not run.
    """

    jobs: Counter[str] = field(default_factory=Counter)
    after: dict[str, set[str]] = field(default_factory=dict)
    outputs: list[str] = field(default_factory=list)

    def from_rules(self, *rules: str) -> set[str]:
        """These rules and all that follow them."""
        following = set(rules)
        while following < (wider := following.union(*(self.after.get(rule, set()) for rule in following))):
            following = wider
        return following


def plan(folder: Path, *targets: str, executor: str = "dryrun", **config: Any) -> Plan:
    """What snakemake would do in a folder, as ``snakemake --dry-run <targets> --config case=short <config>``.

    Parameters
    ----------
    folder : Path
        Its working folder, with the Snakefile.
    *targets : str
        Rules or files; none for the first rule.
    executor : {"dryrun", "touch"}
        The second marks all files as up to date.
    **config
        ``--config``; ``case=None`` for none.

    Raises
    ------
    SystemExit
        The Snakefile refuses the case.
    """
    words = {key: value for key, value in ({"case": "short"} | config).items() if value is not None}
    settings = DAGSettings(targets=frozenset(targets), forceall=executor == "touch")
    with opened(folder, words) as workflow:
        workflow.dag(settings).execute_workflow(executor=executor)
        return planned(workflow._workflow.dag)


@contextmanager
def opened(folder: Path, words: dict[str, Any]) -> Iterator[Any]:
    """Snakemake's workflow of a folder, with ``--config`` as a mapping; its caches stay in the folder."""
    get_script_mtime.cache_clear()
    with pytest.MonkeyPatch.context() as patch, SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
        patch.setenv("XDG_CACHE_HOME", str(folder / ".cache"))
        patch.setattr(sys, "path", list(sys.path))
        patch.setattr(sys, "executable", sys.executable)
        yield api.workflow(
            ResourceSettings(cores=2),
            config_settings=ConfigSettings(config=words),
            snakefile=folder / "Snakefile",
            workdir=folder,
        )


def built_solver() -> Path:
    """Path of bedFoam, built where that is needed."""
    target = "results/bin/bedFoam"
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", "--rerun-incomplete"]
    command += ["--quiet", "all", "--", target]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return ROOT / target


def planned(dag: Any) -> Plan:
    """Jobs of a DAG that ran dry."""
    dry_run = Plan(outputs=[str(file) for job in dag.jobs for file in job.output])
    dry_run.jobs.update(
        job.rule.name for job in dag.needrun_jobs(exclude_finished=False) if not job.rule.norun
    )
    for job in dag.jobs:
        after = {other.rule.name for other in dag.depending[job] if not other.rule.norun}
        dry_run.after.setdefault(job.rule.name, set()).update(after)
    return dry_run


def linked(folder: Path, *without: str) -> Path:
    """A folder without results: links to the repository's files, a copy of its cases without archives."""
    for name in set(COPIED) - {"cases", *without}:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).symlink_to(ROOT / name)
    shutil.copytree(ROOT / "cases", folder / "cases", ignore=shutil.ignore_patterns("reference"))
    return folder


def finished_copy(folder: Path) -> Path:
    """A copy of the repository without archives, in which every result of the short case is up to date."""
    for name in COPIED:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("reference"))
        else:
            shutil.copy2(ROOT / name, folder / name)
    for output in plan(folder).outputs:
        (folder / output).parent.mkdir(parents=True, exist_ok=True)
        (folder / output).write_text("made up\n", encoding="utf-8")
    plan(folder, executor="touch")
    return folder


def snakemake(
    folder: Path, *arguments: str, python: Path | str = sys.executable
) -> subprocess.CompletedProcess[str]:
    """Run snakemake in a process of its own; its caches stay in the folder."""
    command = [str(python), "-m", "snakemake", "--cores", "2", *arguments]
    environment = os.environ | {"XDG_CACHE_HOME": str(folder / ".cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def modules_behind(script: Path) -> set[Path]:
    """Files of the library that a script imports by the standard library's account, no empty packages."""
    finder = ModuleFinder([str(script.parent)])
    finder.run_script(str(script))
    files = {Path(module.__file__) for module in finder.modules.values() if module.__file__}
    return {file for file in files if file.name != "__init__.py" or holds_code(file)} - {script}


def holds_code(package: Path) -> bool:
    """Whether the file of a package runs anything but its docstring."""
    code = compile(package.read_text(encoding="utf-8"), str(package), "exec")
    return not set(code.co_names) <= {"__doc__"}
