# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a case: the same bed with some keys changed, each in a separate folder."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from bedchain.case.load import load_case
from bedchain.case.schema import Case, with_values
from bedchain.case.strict_yaml import read_yaml
from bedchain.files import write_text


@dataclass(frozen=True)
class Variant:
    """A case with some keys changed.

    Attributes
    ----------
    name : str
        Name of its folder.
    changes : mapping of str to object
        New values by dotted key, such as ``{"gas.drag_law": "beetstra"}``.
    """

    name: str
    changes: Mapping[str, Any] = field(default_factory=dict)


def write_variant(case_file: Path, variant: Variant, folder: Path) -> Case:
    """Write the case file of a variant.

    Parameters
    ----------
    case_file : Path
        The case to vary.
    variant : Variant
    folder : Path
        Gets ``case.yaml``; created where missing.

    Returns
    -------
    dict
        The variant's checked case.

    Raises
    ------
    CaseError
        The variant has problems, all listed.
    """
    content = with_values(dict(read_yaml(case_file)[0]), variant.changes)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "case.yaml"
    write_text(file, yaml.safe_dump(content, sort_keys=False))
    return load_case(file)
