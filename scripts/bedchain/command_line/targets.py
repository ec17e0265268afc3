# SPDX-License-Identifier: GPL-3.0-or-later
"""Targets and options of the command line: refused where snakemake would ignore a word or wait for ever."""

import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from bedchain.case.names import RESERVED
from bedchain.command_line.words import near_word, typed_line
from bedchain.errors import UserError, guess, nearest

# words of a study -> rules that read them; without one of these, or a file, they would be ignored
READERS = {
    "stability": ("stability", "study_stability"),
    "tradeoff": ("tradeoff", "study_tradeoff"),
    "peers": ("peers", "compare_peers"),
    "study": ("readme",),
}
# targets of a bed of particles
OF_PARTICLES = (
    *("verify", "validate", "peers", "ladder", "scores", "tradeoff"),
    *("stability", "bands", "estimate", "readme"),
)


def check_options(options: Sequence[str], cores: int | None, jobs: int | None) -> None:
    """Refuse options of snakemake that make it ignore words or wait for ever.

    Parameters
    ----------
    options : sequence of str
        Of the command line.
    cores, jobs : int, optional
        Cores of this machine and jobs at a time [1].

    Raises
    ------
    UserError
        ``--config`` twice or without a word, no cores.
    """
    if "--" in options:
        options = options[: options.index("--")]
    forms = re.compile("--config(=.*)?|-C.*", re.DOTALL)
    places = [place for place, word in enumerate(options) if forms.fullmatch(word)]
    if len(places) > 1:
        raise UserError(
            f"--config is there {len(places)} times, and the last alone counts: "
            "put all words after one, --config case=NAME preset=NAME"
        )
    for place in places:
        if options[place] in ("--config", "-C") and "=" not in "".join(options[place + 1 : place + 2]):
            raise UserError("--config has no key=value after it: add case=NAME, or leave it out")
    for option, number in (("--cores", cores), ("--jobs", jobs)):
        if number is not None and number < 1:
            raise UserError(f"{option} {number} runs nothing and waits for ever: take at least 1")


def check_targets(
    targets: Collection[str],
    words: Mapping[str, Any],
    rules: Collection[str],
    cases: Collection[str],
    folders: Collection[str],
    kind: str = "",
) -> None:
    """Refuse targets that are none, and words of a study without its target, with the line probably meant.

    Parameters
    ----------
    targets : collection of str
        Rules and files; a file has a ``/``.
    words : mapping of str to value
        Of ``--config``, checked.
    rules, cases : collection of str
        All names that there are.
    folders : collection of str
        Of the results that this run can make.
    kind : str
        What the case is, where it has no particles.

    Raises
    ------
    UserError
    """
    for target in targets:
        if "/" in target:
            _check_file(target, words, cases, folders)
        elif target not in rules:
            others = [other for other in targets if other != target]
            if kind and target in OF_PARTICLES:
                meant = typed_line(targets, words, case="short")
                raise UserError(f"{target} needs particles, and this case is {kind}; did you mean {meant}?")
            raise UserError(f"{target!r} is {_no_target(target, others, words, rules, cases)}")
    for key in words.keys() & READERS.keys():
        if not any("/" in target or target in READERS[key] for target in targets):
            meant = typed_line([READERS[key][0]], words)
            raise UserError(f"--config {key}= is of the target {READERS[key][0]}; did you mean {meant}?")


def _no_target(
    target: str, others: list[str], words: Mapping[str, Any], rules: Collection[str], cases: Collection[str]
) -> str:
    if target in cases:
        return f"a case, no target; did you mean {typed_line(others, words, case=target)}?"
    key, equals, value = target.partition("=")
    if equals and (near := near_word(key)):
        return f"no target; did you mean {typed_line(others, words, **{near: value})}?"
    near = nearest(target, [*cases, *rules])
    if near is None:
        return "no target; ./run --help lists them"
    meant = typed_line([*others, near], words) if near in rules else typed_line(others, words, case=near)
    return f"no target; did you mean {meant}?"


def _check_file(
    target: str, words: Mapping[str, Any], cases: Collection[str], folders: Collection[str]
) -> None:
    """Refuse a file of another case's results than the run's."""
    top, folder, *_ = target.split("/")
    if top != "results" or folder in folders or folder in RESERVED:
        return
    for case in sorted(cases, key=len, reverse=True):
        preset = folder.removeprefix(f"{case}-")
        if folder == case or preset != folder:
            names = {"case": case} if folder == case else {"case": case, "preset": preset}
            others = {key: value for key, value in words.items() if key == "reference"}
            meant = typed_line([target], others, **names)
            raise UserError(f"{target} is of another run; did you mean {meant}?")
    raise UserError(f"{target}: there is no case {folder!r}{guess(folder, cases)}")
