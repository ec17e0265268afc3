# SPDX-License-Identifier: GPL-3.0-or-later
"""What a stage leaves behind when all goes well, and when it does not."""

import json
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from bedchain.errors import DataError, UserError
from bedchain.files import atomic_file, write_csv
from bedchain.stage import LOG, run_stage, stage, stage_arguments


@dataclass(frozen=True)
class Span:
    """A value object of two names."""

    start_s: float
    end_s: float


@dataclass(frozen=True)
class Drawing:
    """A value object with a file, and a name that may be missing."""

    png: Path
    resolution_dpi: int
    csv: Path | None = None


@dataclass(frozen=True)
class Spans:
    """Value objects in a value object."""

    learning: Span
    comparison: Span


def rule(folder, **parts: dict[str, Any]) -> SimpleNamespace:
    """What Snakemake hands to a script, as far as stages look at it."""
    empty: dict[str, dict[str, Any]] = {"input": {}, "output": {}, "params": {}, "wildcards": {}}
    return SimpleNamespace(rule="draw", log=[str(folder / "draw.log")], **(empty | parts))


@pytest.mark.parametrize("kind", [UserError, DataError])
def test_bad_input_is_one_line_and_no_traceback(tmp_path, capsys, kind):
    with pytest.raises(SystemExit) as ended, stage(tmp_path / "logs" / "a.log"):
        raise kind("frame 3 of a.bin is cut off: rerun segment 2")
    assert ended.value.code == 1
    message = "error: frame 3 of a.bin is cut off: rerun segment 2\n"
    assert capsys.readouterr().err == message
    assert (tmp_path / "logs" / "a.log").read_text() == message


def test_defect_keeps_its_traceback_in_the_log(tmp_path):
    with pytest.raises(ZeroDivisionError), stage(tmp_path / "a.log"):
        _ = 1 / 0
    assert "ZeroDivisionError" in (tmp_path / "a.log").read_text()


def test_reports_go_to_the_log_of_their_stage_only(tmp_path):
    for name in ("a", "b"):
        with stage(tmp_path / f"{name}.log"):
            LOG.info("this is %s", name)
    assert "this is a" in (tmp_path / "a.log").read_text()
    assert "this is a" not in (tmp_path / "b.log").read_text()


def test_file_appears_only_when_it_is_complete(tmp_path):
    target = tmp_path / "made" / "table.csv"
    with atomic_file(target) as temporary:
        temporary.write_text("x")
        assert temporary.suffix == ".csv"
        assert not target.exists()
    assert [path.name for path in target.parent.iterdir()] == ["table.csv"]


def test_failure_leaves_what_was_there_before(tmp_path):
    target = tmp_path / "table.csv"
    target.write_text("before")
    with pytest.raises(RuntimeError), atomic_file(target) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert target.read_text() == "before"
    assert list(tmp_path.iterdir()) == [target]


def test_csv_keeps_eight_digits(tmp_path):
    write_csv(pd.DataFrame({"a_m": [1 / 3, 2e-7], "b": ["x", "y"]}), tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text() == "a_m,b\n0.33333333,x\n2e-07,y\n"


def test_stage_is_called_by_the_names_of_its_rule(tmp_path):
    calls = []

    def draw(cells: Path, repeats: list[Path], png: Path, model: str, folder: Path, lag_s: float) -> None:
        calls.append((cells, repeats, png, model, folder, lag_s))
        LOG.info("drawn")

    run_stage(
        draw,
        rule(
            tmp_path,
            input={"cells": "cells.npz", "repeats": ["1.csv", "2.csv"]},
            output={"png": "a.png"},
            params={"lag_s": 0.025, "folder": "results"},
            wildcards={"model": "static", "unused": "x"},
        ),
    )
    paths = [Path("1.csv"), Path("2.csv")]
    assert calls == [(Path("cells.npz"), paths, Path("a.png"), "static", Path("results"), 0.025)]
    assert "drawn" in (tmp_path / "draw.log").read_text()


def test_value_objects_are_made_of_a_mapping_or_of_their_own_names():
    def draw(learning: Span, comparison: Span, drawing: Drawing) -> None: ...

    names = {
        "learning": {"start_s": 1, "end_s": 2},
        "start_s": 3,
        "end_s": 4,
        "png": "a",
        "resolution_dpi": 5,
    }
    drawing = Drawing(Path("a"), 5)
    expected = {"learning": Span(1, 2), "comparison": Span(3, 4), "drawing": drawing}
    assert stage_arguments(draw, names) == expected


def test_value_objects_are_made_of_value_objects():
    def draw(spans: Spans) -> None: ...

    names = {"learning": {"start_s": 1, "end_s": 2}, "comparison": {"start_s": 3, "end_s": 4}}
    assert stage_arguments(draw, names) == {"spans": Spans(Span(1, 2), Span(3, 4))}


def test_a_default_stands_where_the_rule_has_no_such_name():
    def draw(lag_s: float, progress: bool = True) -> None: ...

    assert stage_arguments(draw, {"lag_s": 1.0}) == {"lag_s": 1.0}
    assert stage_arguments(draw, {"lag_s": 1.0, "progress": False}) == {"lag_s": 1.0, "progress": False}


def test_a_missing_name_says_rule_script_and_parameter(tmp_path):
    def plot_cells(cells: Path, lag_s: float) -> None: ...

    with pytest.raises(TypeError, match="rule draw: plot_cells takes 'lag_s'; there are cells, colour"):
        run_stage(plot_cells, rule(tmp_path, input={"cells": "c.npz"}, params={"colour": "red"}))
    assert "plot_cells takes 'lag_s'" in (tmp_path / "draw.log").read_text()


def test_a_missing_name_of_a_value_object_is_an_error():
    def draw(learning: Span) -> None: ...

    with pytest.raises(TypeError, match="Span takes 'end_s'"):
        stage_arguments(draw, {"start_s": 1.0})


def test_a_mapping_with_other_names_is_refused():
    def draw(learning: Span) -> None: ...

    with pytest.raises(TypeError, match="'learning' gives stop_s, which Span does not take"):
        stage_arguments(draw, {"learning": {"start_s": 1.0, "end_s": 2.0, "stop_s": 3.0}})


def test_bad_input_of_a_stage_ends_it_with_one_line(tmp_path, capsys):
    def draw() -> None:
        raise DataError("frame 3 is cut off")

    with pytest.raises(SystemExit):
        run_stage(draw, rule(tmp_path))
    assert capsys.readouterr().err == "error: frame 3 is cut off\n"


def test_what_a_stage_makes_is_known_to_the_next(tmp_path):
    table = tmp_path / "table.csv"
    run_stage(lambda table: table.write_text("a\n1\n"), rule(tmp_path, output={"table": str(table)}))
    table.write_text("a\n2\n")
    with pytest.raises(SystemExit):
        run_stage(lambda table: None, rule(tmp_path, input={"table": str(table)}))
    assert "table.csv was changed after it was written" in (tmp_path / "draw.log").read_text()
    assert not table.exists()


def test_an_error_over_an_input_that_cannot_be_read_names_it(tmp_path):
    (tmp_path / "old.json").write_text('{"times_s": [0.1, 0.')
    draw = rule(tmp_path, input={"old": f"{tmp_path}/old.json"})
    with pytest.raises(SystemExit):
        run_stage(lambda old: json.loads(old.read_text()), draw)
    assert "old.json cannot be read (" in (tmp_path / "draw.log").read_text()
    (tmp_path / "old.json").write_text("{}")
    with pytest.raises(KeyError):  # a defect of the program keeps its traceback
        run_stage(lambda old: {}["x"], draw)
