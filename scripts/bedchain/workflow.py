# SPDX-License-Identifier: GPL-3.0-or-later
"""The case of a run and its keys, for the Snakefile."""

import shlex
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from bedchain.case.chosen import AUTO, is_auto, with_choice
from bedchain.case.load import load_case, with_new_names
from bedchain.case.names import case_name_problem, is_name
from bedchain.case.network_checks import NETWORK
from bedchain.case.parameters import solver_parameters
from bedchain.case.particle_free import particle_free
from bedchain.case.presets import preset_named, read_presets, with_preset
from bedchain.case.scene_checks import used_keys
from bedchain.case.schema import Case, load_schema
from bedchain.case.two_fluid import is_two_fluid
from bedchain.command_line.cluster import check_slurm, check_time_limit
from bedchain.command_line.peers import peers_options
from bedchain.command_line.targets import check_options, check_targets
from bedchain.command_line.words import as_typed, check_words
from bedchain.errors import UserError, guess, report_user_errors
from bedchain.trajectory.archive import SIMULATE, check_archive
from bedchain.trajectory.frame_files import files_of
from bedchain.trajectory.frames_of_case import measured_sections, settings_of

TABLE_SECTIONS = (
    "bed",
    "drum",
    "particles",
    "contact",
    "gas",
    "time",
    "learning",
    "comparison",
    "cells",
    "chain",
    "mixing",
)

CASES = Path("cases")


def quote_interpreter() -> None:
    """Make Python's own path a word of a shell line, where snakemake puts it as it is: it may hold blanks."""
    if Path(sys.executable).exists():
        sys.executable = shlex.quote(sys.executable)


def words_or_exit(config: Mapping[str, Any], typed: Sequence[str] | None) -> dict[str, Any]:
    """Words of ``--config``, as typed and checked, or one clear message and the end of snakemake.

    Parameters
    ----------
    config : mapping of str to value
        Snakemake's.
    typed : sequence of str, optional
        The words after ``--config`` as they were typed.
    """
    with report_user_errors():
        check_words(words := as_typed(config, typed), typed)
        return words


def options_or_exit(options: Sequence[str], cores: int | None, jobs: int | None) -> None:
    """`check_options`; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        check_options(options, cores, jobs)


def targets_or_exit(
    targets: Collection[str],
    words: Mapping[str, Any],
    rules: Collection[str],
    folders: Collection[str],
    case: Case,
) -> None:
    """`check_targets`; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        check_targets(targets, words, rules, case_names(), folders, particle_free(case))


def slurm_or_exit() -> None:
    """`check_slurm`; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        check_slurm()


def time_limits_or_exit(case: Case, limits_min: Mapping[str, int]) -> None:
    """`check_time_limit` of rules by name; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        for rule, limit_min in limits_min.items():
            check_time_limit(case, rule, limit_min)


def peers_or_exit(option: object) -> str:
    """`peers_options` of ``--config peers=``; on an error its message, and snakemake ends before any job."""
    with report_user_errors():
        return peers_options(option, case_names())


def case_names() -> list[str]:
    """Folders of ``cases/`` with a case file, sorted."""
    return sorted(file.parent.name for file in CASES.glob("*/case.yaml"))


def preset_name(config: Mapping[str, Any]) -> str | None:
    """Preset that ``--config preset=`` names, if any; its old word ``fidelity`` is understood with a hint."""
    name = with_new_names(config, "--config").get("preset")
    return str(name) if name else None


def case_or_exit(name: str, preset: str | None = None) -> Case:
    """The checked case of a name, or one clear message and the end of snakemake, before anything runs.

    Parameters
    ----------
    name : str
        A folder in ``cases/``.
    preset : str, optional
        One of ``cases/presets.yaml`` for its chains; without it the one that the case's key ``preset`` names,
        if any.

    Raises
    ------
    SystemExit
        Code 1, where there is no such case or preset, a name cannot be one, the case's file has problems, or
        the two do not go together.
    """
    with report_user_errors():
        known = case_names()
        if name not in known and is_name(name):
            message = f"there is no case {name!r}: take --config case=NAME with one of {', '.join(known)}"
            raise UserError(message + guess(name, known))
        if problem := case_name_problem(name, known, read_presets()):
            raise UserError(problem)
        measure = partial(measured_sections, cache=Path("results") / name / "frames.json")
        case = load_case(file := CASES / name / "case.yaml", measure=measure)
        preset = preset or case.get("preset")
        if NETWORK in case:
            if preset:
                raise UserError(f"{file} is a network, whose chains are written down: leave preset= out")
            from bedchain.chains.networks.page import chains_of  # late: numba and scipy take a second to load

            chains_of(case[NETWORK], str(file))
        if preset and is_two_fluid(case):
            raise UserError(f"{file} is two fluids, from which no chain is learned: leave preset= out")
        return with_preset(case, preset_named(preset)) if preset else case


def reference_or_exit(wanted: str | None, name: str, case: Case) -> Path | None:
    """The archive that a case is taken from, or one clear message and the end of snakemake.

    Parameters
    ----------
    wanted : {"archive", "simulate"}, optional
        ``--config reference=``; without it the archive, where the case has one.
    name : str
        Of the case.
    case : dict
        A checked case.

    Returns
    -------
    Path or None
        ``cases/<name>/reference``; None where the bed is to be simulated.

    Raises
    ------
    SystemExit
        Code 1, where the word is another, there is no archive, or it does not serve the case.
    """
    folder = CASES / name / "reference"
    with report_user_errors():
        if wanted not in (None, "archive", "simulate"):
            raise UserError(f"--config reference={wanted}: take archive or simulate")
        if wanted and NETWORK in case:
            raise UserError(f"the case {name} is a network, which has no particles: leave reference= out")
        if wanted == "simulate" or (wanted is None and not folder.exists()):
            return None
        if not folder.exists():
            raise UserError(f"the case {name} has no archive, {folder}: leave the word out, {SIMULATE}")
        check_archive(folder, case, load_schema())
    return folder


def network_figures(section: Case) -> list[str]:
    """Figures of a case that is a network, by what its page has."""
    from bedchain.chains.networks.page import starts_and_exits  # late, as above

    opened, placed = starts_and_exits(section, CASES)
    return [
        "fig_states",
        *(["fig_residence"] if opened else []),
        *(["fig_path"] if placed else []),
        *(
            ["fig_pulses"]
            if placed and (section["moments_s"] or any("moments_s" in chain for chain in section["chains"]))
            else []
        ),
        *(["fig_mixtures"] if section["mixtures"] else []),
        *(["fig_axial"] if "axial" in section else []),
        *(["fig_conversion"] if "conversion" in section else []),
    ]


def network_inputs(name: str, section: Case) -> list[str]:
    """Files that a network page names: cases of beds, and curves to stand beside its own."""
    beds = {chain["bubbling_bed"]["case"] for chain in section["chains"] if "bubbling_bed" in chain}
    beside = [str(CASES / name / section["axial"]["beside"])] if "axial" in section else []
    return [*(str(CASES / bed / "case.yaml") for bed in sorted(beds)), *beside]


def frame_files(name: str, case: Case) -> list[str]:
    """Files that the frames of a case are in, as inputs of a rule; empty for a simulated bed."""
    if "frames" not in case:
        return []
    return [str(file) for file in files_of(settings_of(case["frames"]).files, CASES / name)]


def cell_size(case: Case) -> float:
    """Side of a square as large as a cell of a case [m]."""
    bed, cells = case["bed"], case["cells"]
    return float((bed["width_m"] * bed["height_m"] / (cells["columns"] * cells["rows"])) ** 0.5)


def pick(case: Case, *keys: str) -> dict[str, Any]:
    """The values of dotted keys by their last name, or of a whole section: ``params: **pick(CASE, "cells")``.

    Parameters
    ----------
    case : dict
        A checked case.
    *keys : str
        Such as ``"bed.width_m"``, or a section such as ``"cells"``.

    Raises
    ------
    KeyError
        Where the case has no such key, or two of them share a last name.
    """
    picked: dict[str, Any] = {}
    for key in keys:
        section, _, name = key.partition(".")
        part = {name: case[section][name]} if name else dict(case[section])
        part = {last: _value(case, section, last, value) for last, value in part.items()}
        if shared := picked.keys() & part.keys():
            raise KeyError(f"{key}: {', '.join(sorted(shared))} is picked twice")
        picked |= part
    return picked


def _value(case: Case, section: str, name: str, value: Any) -> Any:
    return settled(case, lambda chosen: chosen[section][name]) if value == AUTO else value


def settled(case: Case, value: Callable[[Case], Any]) -> Any:
    """A param that rests on the lag or the cells of a case.

    Parameters
    ----------
    case : dict
        A checked case.
    value : callable
        From a case with numbers for its lag and cells.

    Returns
    -------
    object
        The value; where the case leaves them to choose_chain a function of the rule's input, choice.csv, of
        which snakemake knows that the value is known once the file is there.
    """
    if not is_auto(case):
        return value(case)
    return lambda wildcards, input: value(with_choice(case, input.choice))


def solver_values(case: Case) -> dict[str, str]:
    """Every number that the solvers get, by name; the particles run again where one changes."""
    parameters = solver_parameters(case, load_schema())
    return {
        parameter.name: f"{parameter.name} = {parameter.value} [{parameter.unit}]" for parameter in parameters
    }


def table_values(case: Case) -> dict[str, Any]:
    """Dotted key -> value, of the sections that Table 1 shows and the case uses, without models not built."""
    used = used_keys(case)
    values: dict[str, Any] = {}
    for section in filter(used.__contains__, TABLE_SECTIONS):
        for key, value in used[section].items():
            if not isinstance(value, dict):
                values[f"{section}.{key}"] = value
            elif key in case["chain"]["models"]:
                values |= {f"{section}.{key}.{name}": option for name, option in value.items()}
    return values
