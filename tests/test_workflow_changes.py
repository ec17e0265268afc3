# SPDX-License-Identifier: GPL-3.0-or-later
"""What a change of a case or a source runs again, where every result is made up and up to date."""

import os
import re
from contextlib import contextmanager

import pytest

from made.workflow import ALL, BED, STABLE, finished_copy, modules_behind, plan, snakemake

AUDIT = {"audit_scene"}  # reads neither time nor cells
WHOLE_BED = {"plot_snapshot", "plot_bubbles"}  # need particles and gas, no cells
CHOICE = {"choose_chain", "plot_choice"}  # reads the learning window and the lines between groups alone


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A copy of the repository in which every result of the short case is up to date."""
    return finished_copy(tmp_path_factory.mktemp("finished"))


@contextmanager
def edited(file, text):
    """A file with another text, put back afterwards with its times."""
    content, times = file.read_bytes(), file.stat()
    file.write_text(text, encoding="utf-8")
    try:
        yield
    finally:
        file.write_bytes(content)
        os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))


@pytest.fixture
def case(finished):
    """Editor of the short case of the finished copy; the file is put back afterwards."""
    file = finished / "cases" / "short" / "case.yaml"

    def edit(section: str, key: str, value: str) -> None:
        before = file.read_text(encoding="utf-8")
        body = re.sub(rf"^({section}:.*\n(?:  .*\n)*?)  {key}:.*\n", r"\1", before, flags=re.M)
        if re.search(rf"^{section}:.*\n", body, re.M):
            body = re.sub(rf"^{section}:.*\n", f"{section}:\n  {key}: {value}\n", body, flags=re.M)
        else:
            body += f"{section}:\n  {key}: {value}\n"
        assert body != before
        file.write_text(body, encoding="utf-8")

    with edited(file, file.read_text(encoding="utf-8")):
        yield edit


def test_nothing_changed_means_nothing_to_be_done(finished):
    assert plan(finished).jobs == {}


def test_a_comment_in_the_case_file_runs_nothing(finished, case):
    file = finished / "cases" / "short" / "case.yaml"
    case("figures", "batch_height_m", "0.03  # the default, three rows")
    file.write_text(file.read_text(encoding="utf-8") + "# a comment\n", encoding="utf-8")
    assert plan(finished).jobs == {}


def test_another_grid_runs_the_cells_and_what_follows(finished, case):
    case("cells", "rows", "100")
    assert set(plan(finished).jobs) == ALL - AUDIT - BED - WHOLE_BED - CHOICE


@pytest.mark.parametrize(
    ("key", "value", "jobs"),
    [
        ("cells_colour", "red", {"plot_cells": 1}),
        ("cost_colour", "red", {"plot_cost": 1}),
        ("distribution_colour_map", "magma", {"plot_distribution": 3}),
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
    assert plan(finished).jobs == jobs | {"write_report": 1}


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
    left_alone = {"build_solver"} | (AUDIT if section == "time" else set())
    assert set(plan(finished).jobs) == ALL - left_alone


def test_a_later_end_lets_the_particles_go_on_with_the_same_parameters(finished, case):
    case("time", "end_s", "6.0")
    assert set(plan(finished).jobs) == ALL - {"build_solver", "write_parameters"} - AUDIT


def test_another_repeat_runs_it_alone_and_what_compares(finished, case):
    case("comparison", "repeats", "4")
    jobs = plan(finished).jobs
    simulated = ("repeat_dem", "parse_dumps", "measure_mixing")
    assert [jobs[rule] for rule in simulated] == [1, 1, 1]
    assert set(jobs) == {
        *simulated,
        *("compare_mixing", "plot_mixing", "discuss_errors", "plot_discussion"),
        *("write_table", "write_provenance", "plot_cost", "write_report"),
    }


def test_another_estimator_leaves_the_cells_alone(finished, case):
    case("chain", "estimator", "per_step")
    left_alone = AUDIT | BED | WHOLE_BED | CHOICE | {"assign_cells", "plot_cells", "plot_stationarity"}
    assert set(plan(finished).jobs) == ALL - left_alone


def test_another_batch_leaves_the_matrices_alone(finished, case):
    case("figures", "batch_height_m", "0.018")
    jobs = plan(finished).jobs
    assert "run_chain" in jobs and "plot_distribution" in jobs
    assert not {"build_transitions", "assign_cells", "time_models", "diagnose_chains"} & set(jobs)


@pytest.mark.parametrize("key", ["preset", "fidelity"])
def test_a_preset_makes_chains_of_its_own_from_the_bed_that_is_there(finished, case, key):
    presets = finished / "cases" / "presets.yaml"
    chains = ALL - BED - {"plot_difference"}
    with edited(presets, "fast: {cell_m: 0.02, lag_s: 0.2, model: static}\n"):
        jobs = plan(finished, **{key: "fast"}).jobs
        assert set(jobs) == chains and jobs["run_chain"] == 1
        file = finished / "cases" / "short" / "case.yaml"
        file.write_text(file.read_text(encoding="utf-8") + f"{key}: fast\n", encoding="utf-8")
        case("figures", "batch_height_m", "0.02")
        assert set(plan(finished).jobs) == chains - WHOLE_BED - AUDIT - CHOICE


@pytest.mark.parametrize(
    ("file", "rule"),
    [
        ("liggghts_inputs/in.settle", "run_dem"),
        ("openfoam_case/system/fvSolution", "run_dem"),
        ("openfoam_case/solver/bedFoam/dragLaws.C", "build_solver"),
        ("scripts/assign_cells.py", "assign_cells"),
        ("scripts/plot_cost.py", "plot_cost"),
        ("scripts/plot_mixing.py", "plot_mixing"),
    ],
)
def test_an_edited_source_runs_its_rule_and_what_follows(finished, file, rule):
    with edited(finished / file, (finished / file).read_text(encoding="utf-8") + "\n"):
        dry_run = plan(finished)
    assert set(dry_run.jobs) == dry_run.from_rules(rule)


@pytest.fixture(scope="module")
def imported(finished):
    """Modules that the script of each rule imports."""
    return {rule: modules_behind(finished / "scripts" / f"{rule}.py") for rule in ALL - STABLE}


@pytest.mark.parametrize(
    "module", ["trajectory/grid", "trajectory/dumps", "figures/style", "chains/registry"]
)
def test_an_edited_module_runs_the_rules_whose_scripts_import_it_and_what_follows(finished, imported, module):
    file = finished / "scripts" / "bedchain" / f"{module}.py"
    importers = {rule for rule, modules in imported.items() if file in modules}
    assert importers
    with edited(file, file.read_text(encoding="utf-8") + "\n"):
        dry_run = plan(finished)
    assert set(dry_run.jobs) == dry_run.from_rules(*importers)


BAD_VALUES = [
    ("bed", "widht_m", "0.1", "did you mean width_m?"),
    ("particles", "diameter_m", "-1.0e-3", "at least 1e-06"),
    ("bed", "width_m", "5.0e-4", "narrower than a particle"),
    ("time", "dem_step_s", "2.0e-4", "Rayleigh"),
    ("time", "frame_interval_s", "0.02501", "multiple of time.dem_step_s"),
    ("learning", "end_s", "50.0", "outside the simulated time"),
]


@pytest.mark.parametrize(("section", "key", "value", "answer"), BAD_VALUES)
def test_a_bad_case_stops_before_anything(finished, case, capsys, section, key, value, answer):
    case(section, key, value)
    with pytest.raises(SystemExit):
        plan(finished)
    message = capsys.readouterr().err
    assert f"{section}.{key}" in message and answer in message and "cases/short/case.yaml" in message


def test_a_refused_run_loses_no_result(finished, case):
    files = [file for file in (finished / "results").rglob("*") if file.is_file()]
    before = {file: file.read_bytes() for file in files}
    case("learning", "end_s", "50.0")
    case("bed", "widht_m", "0.1")
    file = finished / "cases" / "short" / "case.yaml"
    file.write_text(re.sub(r"^seed: .*", "seed: 10001", file.read_text(encoding="utf-8"), flags=re.M))
    done = snakemake(finished, "--config", "case=short")
    assert done.returncode == 1 and "Traceback" not in done.stdout + done.stderr
    assert "seed: 10001 is not prime" in done.stderr and "take 10007" in done.stderr
    assert "did you mean width_m?" in done.stderr and "outside the simulated time" in done.stderr
    assert {file: file.read_bytes() for file in (finished / "results").rglob("*") if file.is_file()} == before
