# SPDX-License-Identifier: GPL-3.0-or-later
"""A case that is a network: the sections that it may have, and its checks before any chain is built."""

from collections.abc import Iterator
from typing import Any

from bedchain.case.check_registry import Finding, reads
from bedchain.errors import Problem

NETWORK = "network"
# sections of a case that is a network, and the keys of those that it shares with a bed
SECTIONS = ("title", NETWORK, "figures")
FIGURE_KEYS = ("resolution_dpi",)
NO_BUILDERS = ("name", "start", "show", "moments_s")


def bed_problems(data: dict[str, Any], known: dict[str, Any], lines: dict[str, int]) -> list[Problem]:
    """Sections of a bed in a case that has a network: a case has one source."""
    return [
        Problem(
            name,
            "belongs to a bed of particles, and this case is a network",
            "leave one of the two out",
            lines.get(name),
        )
        for name in data
        if name in known and name not in SECTIONS
    ]


def network_schema(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema of a case that is a network."""
    parts = {name: schema["properties"][name] for name in SECTIONS}
    keys = {name: parts["figures"]["properties"][name] for name in FIGURE_KEYS}
    parts["figures"] = parts["figures"] | {"properties": keys}
    return schema | {"required": ["title", NETWORK], "properties": parts}


@reads("network.chains")
def chains_have_one_builder(chains: list[dict[str, Any]]) -> Iterator[Finding]:
    """Refuse a chain with no model or several, and two chains of one name."""
    names = [chain.get("name") for chain in chains]
    for chain in chains:
        builders = [name for name in chain if name not in NO_BUILDERS]
        if len(builders) != 1:
            given = " and ".join(builders) or "no model"
            remedy = "give it one, such as edges, rates, fluxes, static_mixer, axial_wakes, riser"
            yield "network.chains", f"{chain.get('name')} has {given}", remedy
    for name in sorted({str(name) for name in names if names.count(name) > 1}):
        yield "network.chains", f"{names.count(name)} chains are called {name}", "give each its own name"
