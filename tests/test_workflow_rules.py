# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules of the Snakefile beside their scripts: names, library files, and what each gives the other."""

import re
from pathlib import Path

import pytest

from made import ROOT
from made.workflow import ALL, SCORES, STABLE, TRADEOFF, linked, modules_behind, opened

SCRIPTS = ROOT / "scripts"
OTHERS = {"validate_bed", "write_agreement", "estimate_cost"}
BY_SHELL = {"verify_solver", "compare_peers", "study_stability", "study_tradeoff"}


@pytest.fixture(scope="module")
def rules(tmp_path_factory):
    """All rules, by name."""
    with opened(linked(tmp_path_factory.mktemp("rules")), {"case": "short"}) as workflow:
        return {rule.name: rule for rule in workflow._workflow.rules}


@pytest.fixture(scope="module")
def scripted(rules):
    """Rules that run a script inside snakemake."""
    return {name: rule for name, rule in rules.items() if rule.script}


def used_names(script: Path, kind: str) -> set[str]:
    """Names that a script asks of ``snakemake.<kind>``."""
    return set(re.findall(rf"\bsnakemake\.{kind}\.(\w+)", script.read_text(encoding="utf-8")))


def test_every_script_has_the_name_of_its_rule(scripted):
    assert set(scripted) == (ALL - STABLE) | SCORES | (TRADEOFF - BY_SHELL) | OTHERS
    for name, rule in scripted.items():
        assert Path(rule.script).name == f"{name}.py"


def test_every_log_has_the_name_of_its_rule(rules):
    for name, rule in rules.items():
        for log in rule.log:
            assert name in str(log), f"rule {name} writes {log}"


def test_every_rule_takes_the_modules_that_its_script_imports_and_no_others(rules, scripted):
    wrong = []
    for name in {*scripted, *BY_SHELL}:
        modules = {str(file.relative_to(ROOT)) for file in modules_behind(SCRIPTS / f"{name}.py")}
        assert modules, f"{name}.py imports nothing of the library"
        given = {file for file in map(str, rules[name].input) if re.match(r"scripts/.*\.py$", file)}
        given -= {file for file in given if "/inputs/" in file}  # run by other codes
        if given != modules:
            wrong.append(f"rule {name} must take code({name!r}): {sorted(given ^ modules)}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("kind", ["input", "output", "params"])
def test_rules_give_exactly_what_their_scripts_use(scripted, kind):
    wrong = []
    for name, rule in scripted.items():
        given, used = set(getattr(rule, kind).keys()), used_names(SCRIPTS / f"{name}.py", kind)
        if used != given:
            wrong.append(f"rule {name}: {used - given or 'none'} missing, {given - used or 'none'} not used")
    assert not wrong, "\n".join(wrong)
