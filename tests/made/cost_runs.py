# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the DEM that took a given time, as the estimate reads them."""

import json
from pathlib import Path

from bedchain.studies.cost import machine_speed
from bedchain.studies.cost.machine_speed import BedSize

PAPER = BedSize(81000, 2, 54 * 210, 3.125e-5, 5e-4)


def write_run(folder: Path, seconds, bed=PAPER, spans=((0, 0.5), (0.5, 1.0)), cells=(54, 1, 210)):
    """A run whose solver took so many seconds for each second simulated."""
    segments = []
    for index, (start, end) in enumerate(spans):
        (folder / f"dem/stamp/segment_{index}").mkdir(parents=True)
        spent = {f"{name}_s": seconds[name] * (end - start) for name in machine_speed.SOLVERS}
        segments.append(
            {"start_s": start, "end_s": end, "folder": f"dem/stamp/segment_{index}"}
            | spent
            | {"wall_s": sum(spent.values())}
        )
    manifest = {"number": bed.number, "ranks": bed.ranks, "segments": segments}
    (folder / "dem.json").write_text(json.dumps(manifest))
    numbers = {"dem_step": bed.dem_step_s, "gas_step": bed.gas_step_s}
    numbers |= {f"gas_cells_{axis}": count for axis, count in zip("xyz", cells, strict=True)}
    (folder / "parameters.lig").write_text(
        "".join(f"variable {name} equal {value}  # [x]\n" for name, value in numbers.items())
    )
    return folder / "dem.json"
