# SPDX-License-Identifier: GPL-3.0-or-later
"""The networks of a case page: its section ``network`` as chains, each with what it starts with."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.networks import bubbling_wakes, mixer, reactors, riser, wakes
from bedchain.chains.networks.builders import from_edges, from_fluxes, from_rates
from bedchain.chains.networks.network import Network, State
from bedchain.errors import DataError, UserError, guess

Array = NDArray[np.float64]
Section = Mapping[str, Any]
# declared and computed contents may differ by this [1]
CONTENT_TOLERANCE = 1e-9


class PageChain(NamedTuple):
    """A chain of a page.

    Attributes
    ----------
    name : str
    network : Network
    start : (n_states,) array or None
        Contents that are followed from time 0 on, beside the feed.
    theory : dict of str to float
        What a closed form says of it, by ``<quantity>``.
    shown : bool
        Whether figures show it.
    moments_s : tuple of float
        Moments at which what follows its start is shown [s].
    """

    name: str
    network: Network
    start: Array | None
    theory: dict[str, float]
    shown: bool = True
    moments_s: tuple[float, ...] = ()


def chains_of(section: Section, place: str) -> list[PageChain]:
    """Chains of a page.

    Parameters
    ----------
    section : mapping
        Section ``network`` of a checked case.
    place : str
        The case's file, for messages.

    Raises
    ------
    UserError
        A chain cannot be; the message names the file, the chain, and the state.
    """
    chains = []
    for entry in section["chains"]:
        try:
            chains.append(chain_of(entry, Path(place).parent.parent, section["moments_s"]))
        except UserError as error:
            raise UserError(f"{place}, chain {entry['name']}: {error}") from None
    _check_mixtures(section, chains, place)
    return chains


def starts_and_exits(section: Section, cases: Path) -> tuple[bool, bool]:
    """Whether the shown chains of a page have an open one, and one of states with heights."""
    networks = [chain_of(entry, cases).network for entry in section["chains"] if entry["show"]]
    return any(network.is_open for network in networks), any(
        np.isfinite(state.height_m) for network in networks for state in network.states
    )


def chain_of(entry: Section, cases: Path, moments_s: Sequence[float] = ()) -> PageChain:
    """A chain of a page.

    Parameters
    ----------
    entry : mapping
        Of the section's ``chains``.
    cases : Path
        Folder of the cases, which it may name one of.
    moments_s : sequence of float
        Of the page, where the entry has none.

    Raises
    ------
    UserError
        See `network.Network` and the builders; or declared contents are not what its moves hold.
    """
    builder = next(name for name in BUILDERS if name in entry)
    network, start, theory = BUILDERS[builder](entry[builder], cases)
    if "start" in entry:
        start = _start(network, entry["start"])
    check_contents(network)
    moments = tuple(entry.get("moments_s", moments_s))
    return PageChain(entry["name"], network, start, theory, entry["show"], moments)


def check_contents(network: Network) -> None:
    """Refuse declared contents that are not those of the steady state of an open network.

    Raises
    ------
    DataError
        They are not; the message names the state.
    """
    if not network.carries:
        return
    off = np.abs(network.open_chain.hold_up() / network.contents - 1)
    if (wrong := np.flatnonzero(off > CONTENT_TOLERANCE)).size:
        worst = int(wrong[np.argmax(off[wrong])])
        held = network.open_chain.hold_up()[worst]
        raise DataError(
            f"state {network.names[worst]} has the declared content {network.contents[worst]:.9g}, "
            f"but its moves and the feed hold {held:.9g}: correct one of them, or leave the content out"
        )


def _start(network: Network, amounts: Mapping[str, float]) -> Array:
    for name in amounts:
        if name not in network.names:
            raise DataError(f"start names {name}, which is no state{guess(name, network.names)}")
    return np.array([float(amounts.get(name, 0.0)) for name in network.names])


Built = tuple[Network, Array | None, dict[str, float]]
Builder = Callable[[Section, Path], Built]


def _free(build: Callable[..., Network], value: str) -> Builder:
    def built(keys: Section, cases: Path) -> Built:
        given = keys["states"]
        states = [
            State(
                one["name"],
                one.get("content", float("nan")),
                one.get("height_m", float("nan")),
                one.get("zone", ""),
            )
            for one in given
        ]
        moves = [(move["from"], move["to"], move[value]) for move in keys["moves"]]
        options = {"step_s": keys["step_s"]} if "step_s" in keys else {}
        return build(states, keys.get("exits", []), moves, keys.get("feed", {}), **options), None, {}

    return built


def _mixer(keys: Section, cases: Path) -> Built:
    size = keys["rows"], keys["columns"]
    moves = keys["down_1"], keys["up_1"], keys["sideways_1"]
    network = mixer.static_mixer(*size, keys["steps"], *moves, step_s=keys["step_s"])
    return network, mixer.loaded(*size, keys["loading"], keys["loaded_1"]), {}


def _wakes(keys: Section, cases: Path) -> Built:
    names = ("caught_1", "up_1", "feed_1", "wake_1", "step_s")
    network = wakes.axial_wakes(**{name: keys[name] for name in names if name in keys})
    return network, None, {}


def _exchange(keys: Section, unit: str) -> riser.Exchange:
    return riser.Exchange(
        0.0,
        0.0,
        keys[f"to_annulus_{unit}"],
        keys[f"to_core_{unit}"],
        keys["refluxed_1"],
        keys.get(f"dense_{unit}"),
        keys.get(f"box_{unit}", 1.0),
    )


def _riser(keys: Section, cases: Path) -> Built:
    sizes = keys["height_m"], keys["up_m_s"], keys["down_m_s"]
    exchange = _exchange(keys, "1_s")
    rates = exchange.to_annulus, exchange.to_core, exchange.refluxed
    theory = {} if exchange.dense else {"residence_mean_continuous": riser.mean_residence_s(*sizes, *rates)}
    return riser.riser(keys["cells"], *sizes, exchange), None, theory


def _riser_steps(keys: Section, cases: Path) -> Built:
    return riser.riser_steps(keys["cells"], _exchange(keys, "1")), None, {}


def _bubbling_bed(keys: Section, cases: Path) -> Built:
    bed = bubbling_wakes.bed_of_case(cases / keys["case"] / "case.yaml")
    mechanisms = bubbling_wakes.Mechanisms(keys["wakes"], keys["dispersed"])
    network = bubbling_wakes.bubbling_wakes(bed, keys["cells"], mechanisms)
    theory = {"bed_height": bed.bed_height, "circulation_time": bed.circulation_time}
    start = np.zeros(len(network.states))
    start[: keys["cells"] // 10 or 1] = network.contents[: keys["cells"] // 10 or 1]
    return network, start, theory


def _tanks(keys: Section, cases: Path) -> Built:
    sizes = keys["cells"], keys["residence_s"], keys["rate_1_s"]
    network, theory = reactors.tanks(*sizes, keys.get("peclet_1"), keys["height_m"])
    return network, None, theory


def _mixed_emulsion(keys: Section, cases: Path) -> Built:
    network, theory = reactors.mixed_emulsion(**keys)
    return network, None, theory


def _two_phase(keys: Section, cases: Path) -> Built:
    bubbles = reactors.Bubbles(*(keys[name] for name in reactors.Bubbles._fields))
    network, theory = reactors.two_phases(bubbles, keys["exchange_1_s"])
    return network, None, theory


def _three_phase(keys: Section, cases: Path) -> Built:
    bubbles = reactors.Bubbles(*(keys[name] for name in reactors.Bubbles._fields))
    grains = reactors.Grains(*(keys[name] for name in reactors.Grains._fields))
    network, theory = reactors.three_phases(bubbles, grains)
    return network, None, theory


BUILDERS: dict[str, Builder] = {
    "edges": _free(from_edges, "probability_1"),
    "rates": _free(from_rates, "rate_1_s"),
    "fluxes": _free(from_fluxes, "flow"),
    "static_mixer": _mixer,
    "axial_wakes": _wakes,
    "bubbling_bed": _bubbling_bed,
    "riser": _riser,
    "riser_steps": _riser_steps,
    "tanks": _tanks,
    "mixed_emulsion": _mixed_emulsion,
    "two_phase": _two_phase,
    "three_phase": _three_phase,
}


def _check_mixtures(section: Section, chains: list[PageChain], place: str) -> None:
    """Refuse a mixture of chains that are not on the page, have other states, or start with nothing."""
    known = {chain.name: chain for chain in chains}
    for mixture in section.get("mixtures", []):
        names = [mixture["key"], *mixture["others"]]
        for name in names:
            if name not in known:
                raise UserError(
                    f"{place}, mixture {mixture['name']}: there is no chain {name}{guess(name, known)}"
                )
            if known[name].start is None:
                raise UserError(f"{place}, mixture {mixture['name']}: the chain {name} has no start; add one")
            if known[name].network.names != known[names[0]].network.names:
                raise UserError(
                    f"{place}, mixture {mixture['name']}: {name} has other states than {names[0]}; take "
                    "chains on the same states"
                )
