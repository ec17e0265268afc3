# SPDX-License-Identifier: GPL-3.0-or-later
"""The workflow by dry runs on a copy of the repository whose results are made up and up to date."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from snakemake.api import SnakemakeApi
from snakemake.settings.enums import Quietness
from snakemake.settings.types import OutputSettings, ResourceSettings

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema
from bedchain.trajectory.archive import solver_keys
from bedchain.workflow import code, files_behind, imported_files, source_files
from made import ROOT

COPIED = ("Snakefile", "cases", "scripts", "openfoam_case", "liggghts_inputs", "envs/python.yaml")
ALL = {
    *(
        "build_solver",
        "write_parameters",
        "run_dem",
        "repeat_dem",
        "measure_mixing",
        "parse_dumps",
        "assign_cells",
        "build_transitions",
        "run_chain",
    ),
    *("compare_mixing", "time_models", "plot_cells", "plot_cost", "plot_distribution", "plot_mixing"),
    *("plot_snapshot", "write_table", "write_provenance", "audit_scene"),
    *("diagnose_chains", "plot_difference", "plot_chapman_kolmogorov", "plot_timescales"),
    *("plot_stationarity", "discuss_errors", "plot_discussion", "make_film"),
}
AUDIT = {"audit_scene"}  # reads neither time nor cells
PARTICLES = AUDIT | {
    *("build_solver", "write_parameters", "run_dem", "parse_dumps", "repeat_dem", "measure_mixing"),
}
# of the target `tradeoff` only
TRADEOFF = {"plot_tradeoff", "plot_variants"}
# of the target `scores` only
SCORES = {"score_models", "plot_pareto", "plot_best_mixing", "plot_autocorrelation"}
WHOLE_BED = {"plot_snapshot"}  # needs particles and gas, no cells


def snakemake(folder: Path, *arguments: str, config: str = "case=short") -> subprocess.CompletedProcess[str]:
    """Run snakemake in a folder; its own caches stay in there."""
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--cores",
        "2",
        *arguments,
        "--config",
        *shlex.split(config),
    ]
    environment = os.environ | {"XDG_CACHE_HOME": str(folder / ".cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def planned(folder: Path, *arguments: str, config: str = "case=short") -> dict[str, int]:
    """Rules that a dry run would run, with the number of their jobs."""
    done = snakemake(folder, "--dry-run", *arguments, config=config)
    assert done.returncode == 0, done.stdout + done.stderr
    rules = re.findall(r"^(?:local)?rule (\w+):$", done.stdout + done.stderr, re.M)
    return {rule: rules.count(rule) for rule in rules if rule != "all"}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A copy of the repository in which every result is there and up to date."""
    folder = tmp_path_factory.mktemp("finished")
    for name in COPIED:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("reference"))
        else:
            shutil.copy2(ROOT / name, folder / name)
    summary = snakemake(folder, "--summary")
    assert summary.returncode == 0, summary.stderr
    for line in summary.stdout.splitlines()[1:]:
        file = folder / line.split("\t")[0]
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("made up\n", encoding="utf-8")
    touched = snakemake(folder, "--touch", "--forceall")
    assert touched.returncode == 0, touched.stderr
    return folder


@pytest.fixture
def case(finished):
    """Editor of the short case of the finished copy; the file is put back afterwards."""
    file = finished / "cases" / "short" / "case.yaml"
    text = file.read_text(encoding="utf-8")

    def edit(section: str, key: str, value: str) -> None:
        body = file.read_text(encoding="utf-8")
        body = re.sub(rf"^({section}:.*\n(?:  .*\n)*?)  {key}:.*\n", r"\1", body, flags=re.M)
        if re.search(rf"^{section}:.*\n", body, re.M):
            body = re.sub(rf"^{section}:.*\n", f"{section}:\n  {key}: {value}\n", body, flags=re.M)
        else:
            body += f"{section}:\n  {key}: {value}\n"
        assert body != file.read_text(encoding="utf-8")
        file.write_text(body, encoding="utf-8")

    yield edit
    file.write_text(text, encoding="utf-8")


@pytest.fixture
def results(finished):
    """Contents of all results, to see that none is lost."""
    return lambda: {file: file.read_bytes() for file in (finished / "results").rglob("*") if file.is_file()}


def test_nothing_changed_means_nothing_to_be_done(finished):
    done = snakemake(finished, "--dry-run")
    assert "Nothing to be done" in done.stdout + done.stderr


def test_everything_runs_in_an_empty_folder(finished, tmp_path):
    for name in COPIED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(finished / name)
    assert set(planned(tmp_path)) == ALL


def test_scores_need_no_chain_of_the_comparison(finished, tmp_path):
    for name in COPIED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(finished / name)
    jobs = planned(tmp_path, "scores")
    needed = PARTICLES - AUDIT - {"measure_mixing"} | {"assign_cells", "plot_distribution"}
    assert set(jobs) - {"scores"} == SCORES | needed
    assert jobs["plot_distribution"] == 1


@pytest.fixture
def with_archive(finished, tmp_path):
    """An empty folder whose short case has an archive, as far as dry runs look into it."""
    for name in COPIED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(finished / name)
    (tmp_path / "cases").unlink()
    shutil.copytree(finished / "cases", tmp_path / "cases")
    for name, start_s, end_s, frames in (("short", 1.5, 5.5, 171), ("paper", 10.0, 20.0, 411)):
        case = load_case(tmp_path / "cases" / name / "case.yaml")
        found = {
            "solver_keys": solver_keys(case, load_schema()), "start_s": start_s, "end_s": end_s,
            "history_s": 0.25, "n_frames": frames, "level_m": 1e-3, "repeats": 3, "files": {},
        }  # fmt: skip
        (tmp_path / "cases" / name / "reference").mkdir()
        (tmp_path / "cases" / name / "reference" / "provenance.json").write_text(json.dumps(found))
    return tmp_path


def test_without_a_case_the_short_bed_is_simulated_and_the_paper_s_unpacked(with_archive):
    shutil.rmtree(with_archive / "cases" / "short" / "reference")
    jobs = planned(with_archive, config="")
    archived = {rule.removeprefix("paper_") for rule in jobs if rule.startswith("paper_")}
    assert {rule for rule in jobs if not rule.startswith("paper_")} == ALL
    assert archived == ALL - (PARTICLES - AUDIT) | {"unpack_reference", "write_agreement"}


def test_an_archived_bed_is_unpacked_and_no_solver_runs(with_archive):
    jobs = planned(with_archive)
    assert set(jobs) == ALL - (PARTICLES - AUDIT) | {"unpack_reference"}
    assert jobs["unpack_reference"] == 1
    assert set(planned(with_archive, config="case=short reference=simulate")) == ALL


def test_what_the_archive_cannot_serve_stops_before_anything(with_archive):
    file = with_archive / "cases" / "short" / "case.yaml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("columns: 10", "columns: 12"), encoding="utf-8")
    done = snakemake(with_archive, "--dry-run")
    assert done.returncode != 0 and "cells.columns 12" in done.stderr and "divisor of 100" in done.stderr
    done = snakemake(with_archive, "--dry-run", config="case=short reference=simulated")
    assert done.returncode != 0 and "take archive or simulate" in done.stderr
    shutil.rmtree(with_archive / "cases" / "short" / "reference")
    done = snakemake(with_archive, "--dry-run", config="case=short reference=archive")
    assert done.returncode != 0 and "short has no archive" in done.stderr
    assert "Traceback" not in done.stderr and not (with_archive / "results").exists()


@pytest.fixture
def with_preset(finished):
    """The finished copy with one preset, a made-up one; put back afterwards."""
    file = finished / "cases" / "presets.yaml"
    shipped = file.read_bytes() if file.exists() else None
    file.write_text("fast: {cell_m: 0.02, lag_s: 0.2, model: static}\n", encoding="utf-8")
    yield finished
    file.unlink()
    if shipped is not None:
        file.write_bytes(shipped)


def test_a_preset_makes_chains_of_its_own_from_the_bed_that_is_there(with_preset, case):
    made = ALL - (PARTICLES - AUDIT) - {"plot_difference"}
    jobs = planned(with_preset, config="case=short fidelity=fast")
    assert set(jobs) == made and jobs["run_chain"] == 1
    done = snakemake(with_preset, "--dry-run", config="case=short fidelity=fats")
    assert done.returncode != 0 and "take one of fast" in done.stderr and "Traceback" not in done.stderr
    file = with_preset / "cases" / "short" / "case.yaml"
    file.write_text(file.read_text(encoding="utf-8") + "fidelity: fast\n", encoding="utf-8")
    case("figures", "batch_height_m", "0.02")
    assert set(planned(with_preset)) == made - WHOLE_BED - AUDIT


def test_an_estimate_makes_nothing_else(finished, tmp_path):
    for name in COPIED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(finished / name)
    assert planned(tmp_path, "estimate") == {"estimate": 1, "estimate_cost": 1}


def test_the_tradeoff_simulates_variants_only_of_what_is_simulated(with_archive):
    chains = {"study_tradeoff", "plot_tradeoff", "unpack_reference", "tradeoff"}
    assert set(planned(with_archive, "tradeoff")) == chains
    jobs = set(
        planned(with_archive, "tradeoff", config="case=short reference=simulate 'tradeoff={dem: [base]}'")
    )
    assert jobs == PARTICLES - AUDIT | TRADEOFF | chains - {"unpack_reference"}
    done = snakemake(with_archive, "--dry-run", config="case=short 'tradeoff={dem: [basis]}'")
    assert done.returncode != 0 and "no variant basis; take of" in done.stderr and "base" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_scene_without_gas_asks_for_nothing_of_openfoam(finished, tmp_path):
    for name in set(COPIED) - {"openfoam_case"}:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(finished / name)
    jobs = planned(tmp_path, config="case=drum")
    assert set(jobs) == ALL - {"build_solver", "plot_snapshot", "repeat_dem", "measure_mixing"}


def test_a_comment_in_the_case_file_runs_nothing(finished, case):
    file = finished / "cases" / "short" / "case.yaml"
    case("figures", "batch_height_m", "0.03  # the default, three rows")
    file.write_text(file.read_text(encoding="utf-8") + "# a comment\n", encoding="utf-8")
    assert planned(finished) == {}


def test_another_grid_runs_the_cells_and_what_follows(finished, case):
    case("cells", "rows", "100")
    assert set(planned(finished)) == ALL - PARTICLES - WHOLE_BED


@pytest.mark.parametrize(
    ("key", "value", "jobs"),
    [
        ("cells_colour", "red", {"plot_cells": 1}),
        ("cost_colour", "red", {"plot_cost": 1}),
        ("distribution_colour_map", "magma", {"plot_distribution": 2}),
        ("dem_colour", "red", {"plot_mixing": 2, "plot_chapman_kolmogorov": 1}),
        (
            "static_colour",
            "red",
            {"plot_mixing": 2, "plot_chapman_kolmogorov": 1, "plot_timescales": 1, "plot_discussion": 1},
        ),
        ("snapshot_colour_map", "magma", {"plot_snapshot": 1}),
        ("left_colour", "red", {"make_film": 1}),
    ],
)
def test_a_colour_runs_only_its_figure(finished, case, key, value, jobs):
    case("figures", key, value)
    assert planned(finished) == jobs


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("gas", "drag_law", "di_felice"),
        ("gas", "superficial_velocity_m_s", "1.4"),
        ("contact", "friction_1", "0.4"),
        ("time", "dem_step_s", "1.0e-5"),
    ],
)
def test_physics_runs_the_particles_and_what_follows(finished, case, section, key, value):
    case(section, key, value)
    assert set(planned(finished)) == ALL - {"build_solver"} - (AUDIT if section == "time" else set())


def test_a_later_end_lets_the_particles_go_on_with_the_same_parameters(finished, case):
    case("time", "end_s", "6.0")
    assert set(planned(finished)) == ALL - {"build_solver", "write_parameters"} - AUDIT


def test_another_repeat_runs_it_alone_and_what_compares(finished, case):
    case("comparison", "repeats", "4")
    jobs = planned(finished)
    assert {rule: jobs.get(rule) for rule in ("repeat_dem", "parse_dumps", "measure_mixing")} == {
        "repeat_dem": 1,
        "parse_dumps": 1,
        "measure_mixing": 1,
    }
    assert set(jobs) == {
        *("repeat_dem", "parse_dumps", "measure_mixing", "compare_mixing", "plot_mixing"),
        *("discuss_errors", "plot_discussion"),
        *("write_table", "write_provenance"),
    }


def test_another_estimator_leaves_the_cells_alone(finished, case):
    case("chain", "estimator", "per_step")
    left_alone = PARTICLES | WHOLE_BED | {"assign_cells", "plot_cells", "plot_stationarity"}
    assert set(planned(finished)) == ALL - left_alone


def test_another_batch_leaves_the_matrices_alone(finished, case):
    case("figures", "batch_height_m", "0.018")
    jobs = planned(finished)
    assert "run_chain" in jobs and "plot_distribution" in jobs
    assert not {"build_transitions", "assign_cells", "time_models", "diagnose_chains"} & set(jobs)


@pytest.mark.parametrize(
    ("file", "first"),
    [
        ("liggghts_inputs/in.settle", "run_dem"),
        ("openfoam_case/system/fvSolution", "run_dem"),
        ("openfoam_case/solver/bedFoam/dragLaws.C", "build_solver"),
        ("scripts/bedchain/trajectory/grid.py", "assign_cells"),
        ("scripts/bedchain/trajectory/frames.py", "parse_dumps"),
    ],
)
def test_an_edited_source_runs_what_depends_on_it(finished, file, first):
    edited = finished / file
    content, times = edited.read_bytes(), edited.stat()
    edited.write_bytes(content + b"\n")
    try:
        jobs = planned(finished)
    finally:
        edited.write_bytes(content)
        os.utime(edited, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert first in jobs and "compare_mixing" in jobs


@pytest.mark.parametrize(
    ("section", "key", "value", "said"),
    [
        ("bed", "widht_m", "0.1", "did you mean width_m?"),
        ("particles", "diameter_m", "-1.0e-3", "above 0"),
        ("bed", "width_m", "5.0e-4", "narrower than a particle"),
        ("time", "dem_step_s", "1.0e-4", "Rayleigh"),
        ("time", "frame_interval_s", "0.02501", "multiple of time.dem_step_s"),
        ("learning", "end_s", "50.0", "outside the simulated time"),
    ],
)
def test_a_bad_case_stops_before_anything_and_loses_nothing(
    finished, case, results, section, key, value, said
):
    before = results()
    case(section, key, value)
    done = snakemake(finished)
    assert done.returncode != 0
    assert f"{section}.{key}" in done.stderr and said in done.stderr
    assert "cases/short/case.yaml" in done.stderr
    assert "Traceback" not in done.stderr
    assert results() == before


def test_a_seed_that_is_no_prime_stops_before_anything(finished, results):
    file = finished / "cases" / "short" / "case.yaml"
    text, before = file.read_text(encoding="utf-8"), results()
    file.write_text(re.sub(r"^seed: .*", "seed: 10001", text, flags=re.M), encoding="utf-8")
    done = snakemake(finished)
    file.write_text(text, encoding="utf-8")
    assert done.returncode != 0 and "seed: 10001 is not prime" in done.stderr and "take 10007" in done.stderr
    assert results() == before


def test_an_unknown_case_is_told_the_known_ones(finished):
    done = snakemake(finished, config="case=shorter")
    assert done.returncode != 0
    assert "there is no case 'shorter'" in done.stderr and "mueller, paper, short" in done.stderr


@pytest.fixture(scope="module")
def rules(finished):
    """The rules of the Snakefile that run a script, by name."""
    before = Path.cwd()
    os.chdir(finished)
    try:
        with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
            workflow = api.workflow(ResourceSettings(cores=2), snakefile=finished / "Snakefile")._workflow
            return {rule.name: rule for rule in workflow.rules if rule.script}
    finally:
        os.chdir(before)


def script_of(rule) -> Path:
    """The script of a rule, which it names from the folder of its own snakefile."""
    return ROOT / "scripts" / Path(rule.script).name


def used_names(script: Path, kind: str) -> set[str]:
    """Names that a script asks of ``snakemake.<kind>``."""
    return set(re.findall(rf"\bsnakemake\.{kind}\.(\w+)", script.read_text(encoding="utf-8")))


def test_every_script_has_the_name_of_its_rule(rules):
    without_own_name = {"build_solver", "write_parameters", "run_dem", "repeat_dem"}
    others = {"validate_bed", "write_agreement", "estimate_cost"}
    assert set(rules) == (ALL | SCORES | TRADEOFF | others) - without_own_name
    for name, rule in rules.items():
        assert Path(rule.script).name == f"{name}.py"


def test_every_rule_names_the_modules_that_its_script_imports(rules):
    wrong = []
    for name, rule in rules.items():
        wanted = set(code(name))
        assert wanted, f"{rule.script} imports nothing of the library"
        given = {str(file) for file in rule.input if str(file).startswith("scripts/bedchain/")}
        if given != wanted:
            wrong.append(f"rule {name} must take code({name!r})")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("kind", ["input", "output", "params"])
def test_rules_give_exactly_what_their_scripts_use(rules, kind):
    wrong = []
    for name, rule in rules.items():
        given, used = set(getattr(rule, kind).keys()), used_names(script_of(rule), kind)
        if used != given:
            wrong.append(f"rule {name}: {used - given or 'none'} missing, {given - used or 'none'} not used")
    assert not wrong, "\n".join(wrong)


def test_imports_are_followed_through_modules(tmp_path):
    file = tmp_path / "script.py"
    file.write_text(
        "import os\nfrom bedchain.trajectory import grid\ndef f():\n    import bedchain.dem.disk\n"
        "    from bedchain.files import complete\n",
        encoding="utf-8",
    )
    library = Path("scripts/bedchain")
    own = {library / "trajectory/grid.py", library / "dem/disk.py", library / "files.py"}
    assert imported_files(file) == own
    assert str(library / "errors.py") in files_behind(library / "dem/disk.py")


def test_sources_are_found_sorted_and_without_links(tmp_path):
    (tmp_path / "sub").mkdir()
    for name in ("b.C", "sub/a.C", "c.o"):
        (tmp_path / name).touch()
    (tmp_path / "link.C").symlink_to(tmp_path / "b.C")
    assert source_files(str(tmp_path), "*.C") == [f"{tmp_path}/b.C", f"{tmp_path}/sub/a.C"]
