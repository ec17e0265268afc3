# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of the code: how many arguments a function takes."""

import ast

from made import ROOT

MOST_ARGUMENTS = 8
# compiled kernels: arrays and numbers one by one, since numba takes no dataclasses
KERNELS = {"jump._jump", "synthetic._advance"}


def crowded(tree):
    """Names of the functions of a module with more arguments than those, besides self and cls."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            arguments = node.args.posonlyargs + node.args.args + node.args.kwonlyargs
            if (
                len([argument for argument in arguments if argument.arg not in ("self", "cls")])
                > MOST_ARGUMENTS
            ):
                yield getattr(node, "name", "lambda")


def test_functions_but_kernels_take_at_most_eight_arguments():
    files = sorted((ROOT / "scripts").rglob("*.py"))
    names = {
        f"{file.stem}.{name}"
        for file in files
        for name in crowded(ast.parse(file.read_text(encoding="utf-8")))
    }
    assert names == KERNELS
