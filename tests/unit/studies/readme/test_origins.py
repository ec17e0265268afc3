# SPDX-License-Identifier: GPL-3.0-or-later
"""Machine and commit of a table."""

import json
from pathlib import Path

import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.studies.readme.origins import origin_now, origin_of_case, with_origin


@pytest.mark.parametrize(("dirty", "ending"), [(False, ""), (True, " with changes")])
def test_origin_of_a_case_is_that_of_its_provenance(tmp_path: Path, dirty: bool, ending: str) -> None:
    record = {
        "machine": {"processor": "EPYC", "cores": 2},
        "git": {"commit": "0123456789abcdef", "dirty": dirty},
    }
    (tmp_path / "provenance.json").write_text(json.dumps(record))
    origin = origin_of_case(tmp_path)
    assert origin == {"machine": "EPYC, 2 cores", "commit": "0123456789ab" + ending}
    table = with_origin(pd.DataFrame({"value": ["1", "2"]}), origin)
    assert list(table.columns) == ["value", "machine", "commit"]
    assert set(table["machine"]) == {"EPYC, 2 cores"}


def test_a_case_that_was_not_run_has_no_origin(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="run the case first"):
        origin_of_case(tmp_path)


def test_origin_now_is_this_machine() -> None:
    assert "cores" in origin_now()["machine"]
