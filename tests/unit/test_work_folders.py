# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders that bedchain made are emptied; any other stays as it is, with a sentence."""

import ast
import re

import pytest

from bedchain.errors import UserError
from bedchain.files import atomic_folder
from bedchain.work_folders import OURS, discard_folder, fresh_folder, work_folder
from made import ROOT

# the only functions that remove files or folders: what they have made themselves, known by a mark, by a name
# or because the same call has just written it
REMOVERS = {
    "work_folders.discard_folder",  # by the mark
    "files.atomic_file",  # its own temporary file
    "files._remove_left_over",  # the same of a process that was killed
    "files.atomic_folder",  # the mark
    "imported.write_imported",  # the first pass over the frames, which it has just written
    "store.retract",  # dem.json, the list of frames that stay
    "records.remove_other_results",  # by the names of stamp and record
    "pack_reference.pack_reference",  # the archive that it has just made and found wanting
    "gas_case.cut_anew",  # parts that it has just put together
    "segments.keep_own_frames",  # a frame of the segment that was just simulated
    "variant_run.simulate",  # the log of the run before
    "stored_dumps.parsed_run",  # the trajectory that it has just written
    "two_fluid.keep_frames",  # OpenFOAM's fields of the segment that was just simulated
    "benchmark_core.run_task",  # particles that it has just drawn, in a temporary folder
}
REMOVING = {"rmtree", "unlink", "rmdir", "remove", "removedirs"}
ADVICE = re.compile(r"\b(delete|remove|erase|unlink|rm)\b", re.IGNORECASE)


def test_a_work_folder_is_emptied_and_goes_with_all_in_it(tmp_path):
    folder = work_folder(tmp_path / "new" / "work")
    (folder / "deep").mkdir()
    (folder / "deep" / "file").write_text("x")
    (folder / "link").symlink_to(tmp_path)
    assert work_folder(folder) == folder and (folder / "deep" / "file").exists()
    assert [file.name for file in fresh_folder(folder).iterdir()] == [OURS]
    discard_folder(folder)
    discard_folder(folder)
    assert not folder.exists() and tmp_path.exists()


@pytest.mark.parametrize("function", [work_folder, fresh_folder, discard_folder])
@pytest.mark.parametrize("kind", ["folder", "file", "link"])
def test_what_bedchain_did_not_make_stays(tmp_path, function, kind):
    place, thesis = tmp_path / "place", tmp_path / "thesis"
    work_folder(thesis)  # even if the other end of a link is bedchain's
    (thesis / "chapter").write_text("x")
    if kind == "folder":
        place.mkdir()
        (place / "chapter").write_text("x")
    elif kind == "file":
        place.write_text("x")
    else:
        place.symlink_to(thesis)
    with pytest.raises(UserError, match="was not made by bedchain.*move it away, or take another folder"):
        function(place)
    assert (place if kind == "file" else place / "chapter").read_text() == "x"


def test_folders_within_a_work_folder_are_bedchains_too(tmp_path):
    (inner := work_folder(tmp_path / "work") / "inner").mkdir()
    (inner / "file").write_text("x")
    discard_folder(inner)
    assert not inner.exists()


def test_an_empty_folder_serves(tmp_path):
    assert fresh_folder(tmp_path) == tmp_path


def test_a_folder_that_appears_whole_spares_another_of_its_temporary_name(tmp_path):
    (tmp_path / "bed.part").mkdir()
    (tmp_path / "bed.part" / "chapter").write_text("x")
    with pytest.raises(UserError, match="bed.part is needed"), atomic_folder(tmp_path / "bed"):
        pass
    assert (tmp_path / "bed.part" / "chapter").exists() and not (tmp_path / "bed").exists()


def test_a_folder_that_appears_whole_holds_nothing_else_and_follows_a_failed_try(tmp_path):
    with pytest.raises(ValueError, match="half"), atomic_folder(tmp_path / "bed") as part:
        (part / "half").write_text("x")
        raise ValueError("half")
    with atomic_folder(tmp_path / "bed") as part:
        (part / "file").write_text("x")
    assert [file.name for file in (tmp_path / "bed").iterdir()] == ["file"]


def library_trees():
    """Syntax of each file of scripts/, with its name."""
    for file in sorted((ROOT / "scripts").rglob("*.py")):
        yield file.stem, ast.parse(file.read_text(encoding="utf-8"))


def test_only_known_functions_remove_anything():
    removers = set()
    for name, tree in library_trees():
        for function in ast.walk(tree):
            if isinstance(function, ast.FunctionDef):
                calls = (node.func for node in ast.walk(function) if isinstance(node, ast.Call))
                if any(isinstance(call, ast.Attribute) and call.attr in REMOVING for call in calls):
                    removers.add(f"{name}.{function.name}")
    assert removers == REMOVERS


def test_no_message_advises_to_delete():
    """Texts of errors, and of functions and constants that are parts of them."""
    advice = [
        f"{name}: {node.value}"
        for name, tree in library_trees()
        for statement in ast.walk(tree)
        if isinstance(statement, ast.Raise | ast.Return | ast.Assign)
        for node in ast.walk(statement)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and ADVICE.search(node.value)
    ]
    assert advice == []
