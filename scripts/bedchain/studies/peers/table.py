# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the comparison: a row for each bed and code, ratios between codes, and both in markdown."""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from bedchain.provenance import debian_packages
from bedchain.studies.peers.bed import PeerBed
from bedchain.studies.peers.peer import Peer
from bedchain.studies.peers.study import PeerRun

BUSY = 0.2  # processors used by other programs, above which a time is unreliable
GAS_SHARE, TWO_RANKS, FASTER = 0.2, 1.6, 5.0  # targets for a bed as large as the paper's
LARGE = 81_000  # particles
SHOWN = {
    "code": "code",
    "wall_s_per_simulated_s": "wall s per simulated s (range)",
    "relative_to_bedfoam_1": "times bedFoam's",
    "particle_steps_per_s": "10^6 particle-steps per s",
    "pressure_drop_Pa": "pressure drop [Pa] (of the weight)",
    "mean_height_m": "mean height [mm]",
    "dem_step_s": "step [us]",
    "simulated_s": "simulated [ms] x runs",
    "differences": "differs by",
}


def summary(runs: Iterable[PeerRun], beds: dict[str, PeerBed], peers: Iterable[Peer]) -> pd.DataFrame:
    """Medians over the repeats, with a row for each bed and code.

    Parameters
    ----------
    runs : iterable of PeerRun
    beds : dict of str to PeerBed
        By name.
    peers : iterable of Peer
        In the order of the table.

    Returns
    -------
    DataFrame
        Units in the names of the columns; ``note`` has the reason where a code has no run.
    """
    runs, peers = list(runs), list(peers)
    rows = []
    for name, bed in beds.items():
        for peer in peers:
            of_peer = [run for run in runs if (run.bed, run.code) == (name, peer.name)]
            if of_peer:
                rows.append(_row(of_peer, bed, peer))
    table = pd.DataFrame(rows)
    bedfoam_time = table[table["code"] == "bedFoam"].set_index("bed")["wall_s_per_simulated_s"]
    relative = table["wall_s_per_simulated_s"] / table["bed"].map(bedfoam_time)
    table.insert(table.columns.get_loc("wall_s_per_simulated_s") + 1, "relative_to_bedfoam_1", relative)
    return table


def _row(runs: list[PeerRun], bed: PeerBed, peer: Peer) -> dict[str, object]:
    done = [run.outcome for run in runs if run.outcome]
    frame = pd.DataFrame([vars(outcome) for outcome in done] or [{}], dtype=float)
    frame = frame.reindex(columns=list(_FIELDS))
    cost = frame["wall_s"] / frame["simulated_s"]
    middle = frame.median()
    step = middle["simulated_s"] / middle["dem_steps"]
    drop = middle["pressure_drop"]
    others = [run.others for run in runs if run.outcome]
    return {
        "bed": bed.name,
        "code": peer.name,
        "version": debian_packages((peer.package,)).get(peer.package, "") if peer.package else "this one",
        "ranks": peer.ranks,
        "particles": middle["particles"],
        "dem_steps": middle["dem_steps"],
        "dem_step_s": step,
        "gas_step_s": bed.value("gas_step") if peer.gas else np.nan,
        "simulated_s": middle["simulated_s"],
        "repeats": len(done),
        "wall_s_per_simulated_s": cost.median(),
        "fastest_s_per_simulated_s": cost.min(),
        "slowest_s_per_simulated_s": cost.max(),
        "particle_steps_per_s": middle["particles"] / (step * cost.median()),
        "gas_and_exchange_per_dem_1": ((frame["exchange_s"] + frame["gas_s"]) / frame["dem_s"]).median(),
        "pressure_drop_Pa": drop,
        "pressure_drop_per_weight_1": drop / bed.weight_per_area,
        "mean_height_m": middle["mean_height_m"],
        "others_processors_1": float(np.median(others)) if others else np.nan,
        "differences": peer.differences,
        "note": "; ".join(dict.fromkeys(run.note for run in runs if run.note)),
    }


_FIELDS = (
    *("simulated_s", "wall_s", "particles", "dem_steps", "mean_height_m", "pressure_drop"),
    *("dem_s", "exchange_s", "gas_s"),
)


def ratios(table: pd.DataFrame) -> pd.DataFrame:
    """Ratios of each bed: quantity, value, and for a large bed the target and whether it is met.

    Parameters
    ----------
    table : DataFrame
        Of `summary`.

    Returns
    -------
    DataFrame
        ``target`` and ``met`` are empty where there is no target; without a code its ratios are left out.
    """
    rows = []
    for name, of_bed in table.groupby("bed", sort=False):
        by_code = of_bed.set_index("code").reindex(["bedFoam", "bedFoam, 2 ranks", "DPMFoam", "LIGGGHTS"])
        one_rank, two_ranks, dpm, alone = by_code["wall_s_per_simulated_s"]
        gain, share = one_rank / two_ranks, by_code["gas_and_exchange_per_dem_1"].iloc[0]
        height, drop = by_code["mean_height_m"], by_code["pressure_drop_Pa"]
        rows += [
            (name, "gas and exchange over DEM, one rank [1]", share, "<= 0.2", share <= GAS_SHARE),
            (name, "one rank's time over that of 2 ranks [1]", gain, ">= 1.6", gain >= TWO_RANKS),
            (name, "DPMFoam's time over bedFoam's [1]", dpm / one_rank, ">= 5", dpm / one_rank >= FASTER),
            (name, "bedFoam's time over that of LIGGGHTS alone [1]", one_rank / alone, "", None),
            (name, "DPMFoam's mean height over bedFoam's [1]", height.iloc[2] / height.iloc[0], "", None),
            (name, "DPMFoam's pressure drop over bedFoam's [1]", drop.iloc[2] / drop.iloc[0], "", None),
        ]
    result = pd.DataFrame(rows, columns=["bed", "quantity", "value", "target", "met"])
    result["met"] = ["" if met is None else "yes" if met else "no" for met in result["met"]]
    large = table.groupby("bed")["particles"].max() >= LARGE
    result.loc[~result["bed"].map(large), ["target", "met"]] = ""
    return result.dropna(subset="value", ignore_index=True)


def markdown(table: pd.DataFrame, ratio_rows: pd.DataFrame) -> str:
    """Both tables in markdown, with the codes that could not run and the times that are unreliable."""
    parts = []
    for name, of_bed in table.groupby("bed", sort=False):
        lines = [_line(row) for row in of_bed[of_bed["repeats"] > 0].to_dict("records")]
        parts += [f"{name}:\n", _grid(list(SHOWN.values()), lines), ""]
        parts += [f"- {row.code}: {row.note}" for row in of_bed.itertuples() if row.note]
        busy = of_bed[of_bed["others_processors_1"] > BUSY]["code"]
        if len(busy):
            parts.append(f"- other programs were at work during {', '.join(busy)}: their times are too long")
        parts.append("")
    shown = [
        [row.bed, row.quantity, f"{row.value:.4g}", row.target, row.met] for row in ratio_rows.itertuples()
    ]
    return "\n".join([*parts, _grid(["bed", "quantity", "value", "target", "met"], shown)])


def _line(row: dict[str, float]) -> list[str]:
    low, high = row["fastest_s_per_simulated_s"], row["slowest_s_per_simulated_s"]
    drop = f"{row['pressure_drop_Pa']:.0f} ({row['pressure_drop_per_weight_1']:.2f})"
    return [
        str(row["code"]),
        f"{row['wall_s_per_simulated_s']:.0f} ({low:.0f}-{high:.0f})",
        f"{row['relative_to_bedfoam_1']:.3g}",
        f"{row['particle_steps_per_s'] / 1e6:.2f}",
        drop if np.isfinite(row["pressure_drop_Pa"]) else "-",
        f"{1e3 * row['mean_height_m']:.3f}",
        f"{1e6 * row['dem_step_s']:.3g}",
        f"{1e3 * row['simulated_s']:.3g} x {row['repeats']:.0f}",
        str(row["differences"]) or "-",
    ]


def _grid(heads: list[str], rows: list[list[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
