# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs of the workflow in a folder without results: cases, archives, studies; and what stops it at once."""

import json
import shutil

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema
from bedchain.trajectory.archive import solver_keys
from made import ROOT
from made.workflow import ALL, BED, SCORES, TRADEOFF, linked, plan, snakemake

KNOWN = sorted(file.parent.name for file in (ROOT / "cases").glob("*/case.yaml"))
STUB = 'for file in snakemake.output:\n    open(file, "w").write("{script} for " + snakemake.rule)\n'


@pytest.fixture
def empty(tmp_path):
    """A folder with the repository's files and no results."""
    return linked(tmp_path)


@pytest.fixture
def with_archive(empty):
    """The same, where the cases short and paper have archives, as far as dry runs look into them."""
    for name, start_s, end_s, frames in (("short", 1.5, 5.0, 151), ("paper", 10.0, 20.0, 411)):
        case = load_case(empty / "cases" / name / "case.yaml")
        provenance = {
            "solver_keys": solver_keys(case, load_schema()), "start_s": start_s, "end_s": end_s,
            "history_s": 0.25, "n_frames": frames, "level_m": 1e-3, "repeats": 3, "files": {},
        }  # fmt: skip
        (empty / "cases" / name / "reference").mkdir()
        (empty / "cases" / name / "reference" / "provenance.json").write_text(json.dumps(provenance))
    return empty


@pytest.fixture
def refused(capsys):
    """What a run that the Snakefile refuses says on stderr."""

    def message(folder, **config):
        with pytest.raises(SystemExit) as stop:
            plan(folder, **config)
        assert stop.value.code == 1
        assert not (folder / "results").exists()
        return capsys.readouterr().err

    return message


def test_everything_runs_in_an_empty_folder(empty):
    assert set(plan(empty).jobs) == ALL


def test_scores_need_no_chain_of_the_comparison(empty):
    jobs = plan(empty, "scores").jobs
    assert set(jobs) == SCORES | BED - {"measure_mixing"} | {"assign_cells", "plot_distribution"}
    assert jobs["plot_distribution"] == 1


def test_without_a_case_the_short_bed_is_simulated_and_the_paper_s_unpacked(with_archive):
    shutil.rmtree(with_archive / "cases" / "short" / "reference")
    jobs = set(plan(with_archive, case=None).jobs)
    archived = {rule.removeprefix("paper_") for rule in jobs if rule.startswith("paper_")}
    assert {rule for rule in jobs if not rule.startswith("paper_")} == ALL
    # one report shows both beds
    of_paper = {"unpack_reference", "write_agreement", "plot_scalar"}
    assert archived == ALL - BED - {"write_report"} | of_paper


def test_an_archived_bed_is_unpacked_and_no_solver_runs(with_archive):
    jobs = plan(with_archive).jobs
    assert set(jobs) == ALL - BED | {"unpack_reference"}
    assert jobs["unpack_reference"] == 1
    assert set(plan(with_archive, reference="simulate").jobs) == ALL


def test_what_the_archive_cannot_serve_stops_before_anything(with_archive, refused):
    file = with_archive / "cases" / "short" / "case.yaml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("columns: 10", "columns: 12"), encoding="utf-8")
    message = refused(with_archive)
    assert "cells.columns 12" in message and "divisor of 100" in message
    assert "take archive or simulate" in refused(with_archive, reference="simulated")
    shutil.rmtree(with_archive / "cases" / "short" / "reference")
    assert "short has no archive" in refused(with_archive, reference="archive")


def test_an_estimate_makes_nothing_else(empty):
    assert set(plan(empty, "estimate_cost").jobs) == {"estimate_cost"}
    assert plan(empty, "estimate").jobs == {"estimate": 1, "estimate_cost": 1}


def test_the_tradeoff_simulates_variants_only_of_what_is_simulated(with_archive, refused):
    jobs = set(plan(with_archive, "tradeoff").jobs)
    assert jobs == TRADEOFF - {"run_variant", "plot_variants"} | {"unpack_reference"}
    jobs = set(plan(with_archive, "tradeoff", reference="simulate", tradeoff={"dem": "tolerance_1e-09"}).jobs)
    assert jobs == BED | TRADEOFF
    message = refused(with_archive, tradeoff={"dem": ["basis"]})
    assert "no variant basis; take of" in message and "base" in message


def test_a_scene_without_gas_asks_for_nothing_of_openfoam(tmp_path):
    jobs = plan(linked(tmp_path, "openfoam_case"), case="drum").jobs
    no_gas = {"build_solver", "plot_snapshot", "plot_bubbles", "repeat_dem", "measure_mixing"}
    assert set(jobs) == ALL - no_gas


def test_an_unknown_case_or_preset_is_answered_by_the_known_ones(empty, refused):
    message = refused(empty, case="shorter")
    assert "there is no case 'shorter'" in message and ", ".join(KNOWN) in message
    (empty / "cases" / "presets.yaml").write_text("fast: {cell_m: 0.02, lag_s: 0.2, model: static}\n")
    message = refused(empty, preset="fats")
    assert "there is no preset 'fats'" in message and "take one of fast" in message


@pytest.mark.parametrize(
    "name", ["my bed", "it's", "a&b", "{b}", "#x", "$(touch x)", "`touch x`", "a;b", "-x", ".x"]
)
def test_a_case_with_a_name_for_a_shell_is_refused_in_one_line(empty, refused, name):
    shutil.copytree(empty / "cases" / "short", empty / "cases" / name)
    message = refused(empty, case=name)
    assert message.startswith(f"error: the name of the case {name!r} must have letters, digits,")
    assert message.count("\n") == 1 and not (empty / "x").exists()


def test_a_preset_with_such_a_name_is_refused(empty, refused):
    (empty / "cases" / "presets.yaml").write_text('"$(touch x)": {cell_m: 0.02, lag_s: 0.2, model: static}\n')
    assert "line 1: the name of the preset '$(touch x)' must have" in refused(empty, preset="$(touch x)")


def test_a_case_and_a_preset_may_be_named_by_numbers(empty):
    """All ways to look like a number are in unit/command_line/test_words.py."""
    shutil.copytree(empty / "cases" / "short", empty / "cases" / "2024_11_25")
    (empty / "cases" / "presets.yaml").write_text('"0700": {cell_m: 0.02, lag_s: 0.2, model: static}\n')
    file = "results/2024_11_25/parameters.lig"
    done = snakemake(empty, file, "--config", "case=2024_11_25", "preset=0700")
    assert done.returncode == 0, done.stderr
    assert (empty / file).exists()


@pytest.mark.parametrize(("case", "folder"), [("mueller", "mueller-balanced"), ("short", "short")])
def test_a_preset_simulates_its_own_bed_where_it_changes_it(empty, case, folder):
    """balanced also leaves lag and cells to the rule."""
    dry_run = plan(empty, case=case, preset="balanced")
    assert {f"results/{folder}/dem.json", f"results/{case}-balanced/choice.csv"} <= set(dry_run.outputs)


def test_a_preset_of_the_command_is_no_bed_of_the_case_s_own_preset(empty):
    file = empty / "cases" / "short" / "case.yaml"
    file.write_text(f"preset: fast\n{file.read_text()}")
    assert "results/short-accurate/dem.json" in plan(empty, case="short", preset="accurate").outputs


def test_the_bed_of_a_preset_stays_that_of_the_archive(with_archive):
    dry_run = plan(with_archive, case="paper", preset="fast")
    assert "unpack_reference" in dry_run.jobs and "run_dem" not in dry_run.jobs
    assert "results/paper/trajectory.npy" in dry_run.outputs


def test_a_network_asks_for_nothing_of_a_bed(empty):
    jobs = plan(empty, case="riser").jobs
    figures = {f"plot_network_{name}" for name in ("states", "residence", "path", "pulses")}
    assert set(jobs) == {"run_network", "write_provenance", "write_report"} | figures


def test_a_network_that_cannot_be_ends_before_any_job(empty, refused):
    page = (ROOT / "cases" / "elutriation" / "case.yaml").read_text(encoding="utf-8")
    (empty / "cases" / "leaky").mkdir()
    (empty / "cases" / "leaky" / "case.yaml").write_text(page.replace("flow: 0.13", "flow: 0.12"))
    message = refused(empty, case="leaky")
    assert message.startswith(
        "error: cases/leaky/case.yaml, chain fines with cyclone: the flows of bed do not balance"
    )
    for word in ({"preset": "fast"}, {"reference": "simulate"}):
        message = refused(empty, case="riser", **word)
        assert "network" in message and "leave" in message and message.count("\n") == 1


def test_a_refusal_is_one_message_and_an_old_word_one_hint(empty):
    done = snakemake(empty, "--dry-run", "--config", "case=shorter", "fidelity=fast")
    assert done.returncode == 1 and "Traceback" not in done.stderr + done.stdout
    assert done.stderr.splitlines() == [
        "hint: --config: fidelity is now called preset",
        f"error: there is no case 'shorter': take --config case=NAME with one of {', '.join(KNOWN)}; "
        "did you mean short?",
    ]


def test_a_figure_is_drawn_by_the_script_of_its_rule(with_archive):
    (with_archive / "scripts").unlink()
    shutil.copytree(ROOT / "scripts", with_archive / "scripts")
    for script in ("plot_timescales", "plot_discussion"):
        (with_archive / "scripts" / f"{script}.py").write_text(STUB.format(script=script))
    for bed in ("short", "paper"):
        (with_archive / "results" / bed).mkdir(parents=True)
        for table in ("diagnostics.csv", "discussion.csv"):
            (with_archive / "results" / bed / table).write_text("made up\n")
    figures = {
        "results/short/figures/fig_timescales.png": "plot_timescales",
        "results/short/figures/fig_discussion.png": "plot_discussion",
        "results/paper/figures/fig_timescales.png": "paper_plot_timescales",
    }
    done = snakemake(with_archive, "--allowed-rules", *figures.values(), "--", *figures)
    assert done.returncode == 0, done.stderr
    for file, rule in figures.items():
        assert (with_archive / file).read_text() == f"{rule.removeprefix('paper_')} for {rule}"


def test_what_waits_is_looked_at_once_for_each_job(tmp_path):
    asked = [f"results/short/{name}" for name in ("table1.csv", "audit.csv", "parameters.lig")]
    done = snakemake(linked(tmp_path / "folder"), "--cores", "1", "--verbose", "--", *asked)
    assert done.returncode == 0
    assert sum(line.startswith("Ready jobs") for line in done.stderr.splitlines()) == len(asked)
