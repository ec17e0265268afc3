# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases without particles: networks and beds of two fluids, and what is refused for them."""

from pathlib import Path
from typing import Any

from bedchain.case.network_checks import NETWORK
from bedchain.case.strict_yaml import read_yaml
from bedchain.case.two_fluid import is_two_fluid
from bedchain.errors import UserError

CASES = Path("cases")


def particle_free(case: dict[str, Any]) -> str:
    """What a case without particles is; empty for one with particles."""
    if NETWORK in case:
        return "a network"
    return "a bed of two fluids" if is_two_fluid(case) else ""


def require_particles(name: str, cases: Path = CASES) -> None:
    """Refuse a case without particles, before its results are looked for.

    Parameters
    ----------
    name : str
        Of a case, or another folder of ``results/``, which passes.
    cases : Path
        Folder of the cases.

    Raises
    ------
    UserError
    """
    file = cases / name / "case.yaml"
    data = read_yaml(file)[0] if file.exists() else {}
    if kind := particle_free(data if isinstance(data, dict) else {}):
        raise UserError(
            f"the case {name} is {kind}, which has no particles: ./run --config case={name} makes its "
            f"figures, results/{name}/figures"
        )
