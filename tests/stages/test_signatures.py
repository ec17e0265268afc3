# SPDX-License-Identifier: GPL-3.0-or-later
"""Every rule gives exactly the names that the entry function of its script takes."""

import importlib
import os
from pathlib import Path

import pytest
from snakemake.api import SnakemakeApi
from snakemake.settings.enums import Quietness
from snakemake.settings.types import ConfigSettings, OutputSettings, ResourceSettings

from bedchain.stage import stage_arguments
from made import ROOT


class Watched(dict):
    """Names of a rule, which remember what was looked up."""

    def __init__(self, names):
        super().__init__(names)
        self.used = set()

    def __getitem__(self, name):
        self.used.add(name)
        return super().__getitem__(name)

    def get(self, name, default=None):
        if name in self:
            self.used.add(name)
        return super().get(name, default)


@pytest.fixture(scope="module", params=["archive", "simulate", "network"])
def rules(request):
    """The rules of the Snakefile that run a script, by name; `paper` has an archive."""
    words = {"case": "riser"} if request.param == "network" else {"case": "paper", "reference": request.param}
    before = Path.cwd()
    os.chdir(ROOT)
    try:
        with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
            config = ConfigSettings(config=words)
            workflow = api.workflow(
                ResourceSettings(cores=2), config_settings=config, snakefile=ROOT / "Snakefile"
            )._workflow
            return {rule.name: rule for rule in workflow.rules if rule.script}
    finally:
        os.chdir(before)


def entry_of(rule):
    """The entry function of a rule's script, which has its name."""
    name = Path(rule.script).stem
    return getattr(importlib.import_module(name), name)


def files_and_values(rule):
    """Named inputs, outputs and params of a rule; those that depend on wildcards by their name alone."""
    values = {name: name if callable(value) else value for name, value in rule.params.items()}
    return {name: str(name) for part in (rule.input, rule.output) for name in part.keys()} | values  # noqa: SIM118


def test_no_name_stands_twice_in_a_rule(rules):
    for name, rule in rules.items():
        parts = [set(part.keys()) for part in (rule.input, rule.output, rule.params)]
        assert len(set.union(*parts)) == sum(map(len, parts)), f"rule {name}: a name is given twice"


def test_rules_give_exactly_what_their_scripts_take(rules):
    assert len(rules) > 20 or {"run_network", "plot_network_axial"} <= rules.keys()
    wrong = []
    for name, rule in rules.items():
        given = files_and_values(rule)
        wildcards = {wildcard: wildcard for wildcard in rule.wildcard_names}
        names = Watched(wildcards | given)
        try:
            stage_arguments(entry_of(rule), names)
        except TypeError as error:
            wrong.append(f"rule {name}: {error}")
        else:
            if unused := given.keys() - names.used:
                wrong.append(f"rule {name} gives {', '.join(sorted(unused))}, which its script does not take")
    assert not wrong, "\n".join(wrong)
