# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of ``--config``: as they were typed, the known ones, and the line that was probably meant."""

import shlex
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from bedchain.case.load import NEW_NAMES
from bedchain.errors import UserError, guess, nearest

KNOWN = ("case", "preset", "reference", "stability", "tradeoff", "peers", "study")
INTERNAL = "studies"  # of the paper's module in the Snakefile, nobody types it
CHOICES = {
    "reference": ("archive", "simulate"),
    "stability": ("full", "reduced"),
    "study": ("verify", "peers", "stability", "benchmark_core", "bands"),  # of write_readme.py
}
# words of --config whose values are text, whatever they look like
TEXTS = ("case", "preset", "fidelity", "reference", "stability", "study")


def as_typed(config: Mapping[str, Any], typed: Sequence[str] | None) -> dict[str, Any]:
    """Words of ``--config``, where names are text: snakemake reads 2024_11_25 as the number 20241125.

    Parameters
    ----------
    config : mapping of str to value
        As snakemake read them, from the command line and from files.
    typed : sequence of str, optional
        ``key=value``, as they were typed.

    Returns
    -------
    dict of str to value

    Raises
    ------
    UserError
        A name in a configuration file is a number.
    """
    texts = dict(word.split("=", 1) for word in typed or () if "=" in word)
    words = dict(config)
    for key in TEXTS:
        if key not in words or isinstance(words[key], str):
            continue
        if key not in texts:
            raise UserError(f"--configfile: {key} is {words[key]}, not text: put it in quotes")
        words[key] = texts[key]
    return words


def check_words(config: Mapping[str, Any], typed: Sequence[str] | None) -> None:
    """Refuse words of ``--config`` that nothing reads, and values that cannot be.

    Parameters
    ----------
    config : mapping of str to value
        As snakemake read them, from the command line and from files.
    typed : sequence of str, optional
        ``key=value``, as they were typed.

    Raises
    ------
    UserError
        An unknown word, with the known ones and a near guess; a word twice, without a value, or with one that
        it cannot have.
    """
    keys = [word.split("=", 1)[0] for word in typed or ()]
    for key in (*keys, *(key for key in config if key != INTERNAL)):
        if key not in KNOWN and key not in NEW_NAMES:
            raise UserError(_unknown_word(key, config.get(key)))
        if keys.count(key) > 1:
            raise UserError(f"--config: {key} is there twice: keep one of them")
        if config.get(key) in (None, ""):
            raise UserError(f"--config: {key}= has no value: give one, or leave the word out")
        if key in NEW_NAMES and NEW_NAMES[key] in config:
            raise UserError(
                f"--config: {NEW_NAMES[key]} is there twice, once by its old name {key}: keep one of them"
            )
    for key, choices in CHOICES.items():
        if key in config and config[key] not in choices:
            near = guess(str(config[key]), choices)
            raise UserError(f"--config {key}={config[key]}: take {' or '.join(choices)}{near}")


def _unknown_word(key: str, value: Any) -> str:
    message = f"--config has no word {key!r}"
    if near := near_word(key):
        return f"{message}; did you mean {typed_line([], {}, **{near: value})}?"
    return f"{message}; known are {', '.join(KNOWN)}"


def near_word(key: str) -> str | None:
    """The known word of ``--config`` nearest to a key, by its name of today."""
    near = nearest(key, [*KNOWN, *NEW_NAMES])
    return NEW_NAMES.get(near, near) if near else None


def typed_line(targets: Collection[str], words: Mapping[str, Any], **others: Any) -> str:
    """The line of ./run with targets and words, as it is typed."""
    config = [f"{key}={_typed(value)}" for key, value in (dict(words) | others).items()]
    return shlex.join(["./run", *targets, *(["--config", *config] if config else [])])


def _typed(value: Any) -> str:
    """A value of ``--config`` as it is typed."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_typed(part)}" for key, part in value.items()) + "}"
    return f"[{', '.join(map(_typed, value))}]" if isinstance(value, list) else str(value)
