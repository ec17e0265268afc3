# SPDX-License-Identifier: GPL-3.0-or-later
"""Rules of the Snakefile beside their scripts: names, logs, and the library files that they depend on."""

import re
from pathlib import Path

import pytest

from made import ROOT
from made.workflow import ALL, SCORES, STABLE, TRADEOFF, linked, modules_behind, opened

SCRIPTS = ROOT / "scripts"
OTHERS = {
    *("validate_bed", "write_agreement", "estimate_cost", "list_left_out"),
    *("measure_residence", "plot_residence", "measure_segregation", "plot_segregation", "plot_scalar"),
    *("study_ladder", "plot_ladder", "score_presets", "answer_bed"),
}
OF_NUMBER, OF_WORD = r",[\d.]+}", r",[\w.-]+}"  # a wildcard that is a number, or a word
BY_SHELL = {"verify_solver", "compare_peers", "study_stability", "study_bands", "study_tradeoff"}


@pytest.fixture(scope="module")
def rules(tmp_path_factory):
    """All rules, by name."""
    with opened(linked(tmp_path_factory.mktemp("rules")), {"case": "short"}) as workflow:
        return {rule.name: rule for rule in workflow._workflow.rules}


@pytest.fixture(scope="module")
def scripted(rules):
    """Rules that run a script inside snakemake."""
    return {name: rule for name, rule in rules.items() if rule.script}


def test_every_script_has_the_name_of_its_rule(scripted):
    assert set(scripted) == (ALL - STABLE) | SCORES | (TRADEOFF - BY_SHELL - STABLE) | OTHERS
    for name, rule in scripted.items():
        assert Path(rule.script).name == f"{name}.py"


def test_shell_lines_hold_only_words_that_mean_nothing_to_a_shell(rules):
    """File names are safe by the rule for names of cases, and texts of a user are quoted.

    So the shell lines stay as they are: another line makes each bed that was simulated run again.
    """
    for name, rule in rules.items():
        line = rule.shellcmd or ""
        params = [value for key, value in rule.params.items() if f"{{params.{key}}}" in line]
        for value in [*rule.input, *rule.output, *rule.log, *params] if line else []:
            safe = callable(value) or re.fullmatch(
                r"[A-Za-z0-9._/{} =-]*", str(value).replace(OF_NUMBER, "}").replace(OF_WORD, "}")
            )
            assert safe, f"rule {name}: {value}"


@pytest.mark.parametrize("key", ["stability", "study", "reference", "peers", "tradeoff", "preset"])
def test_a_command_as_a_value_of_a_user_is_refused(tmp_path, key):
    with pytest.raises(SystemExit), opened(linked(tmp_path), {key: "$(touch x)"}) as workflow:
        assert workflow._workflow.rules


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
