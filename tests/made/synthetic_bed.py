# SPDX-License-Identifier: GPL-3.0-or-later
"""Beds whose motion is known, written as LIGGGHTS writes them: two rolls, and a random walk on top."""

import json
import struct
from pathlib import Path

import numpy as np

COLUMNS = ["id", "x", "z", "vx", "vz"]
STAMP = "a1b2c3"
# scatter of the pressure drop about its mean, as a share of it
SERIES_NOISE = 0.1


def roll_velocity(x, z, width, height, speed):
    """Velocity of two rolls that fill the bed, up in the middle, with no flow through its sides [m/s]."""
    along, across = 2 * np.pi * x / width, np.pi * z / height
    vx = speed * np.sin(along) * np.cos(across) * width / (2 * height)
    vz = -speed * np.cos(along) * np.sin(across)
    return vx, vz


def rolling_bed(number, width, height, times, speed=0.3, diffusivity=1e-4, seed=1):
    """Frames (n_frames, 4, number) of particles carried by two rolls and a reflected random walk."""
    rng = np.random.default_rng(seed)
    x, z = rng.uniform(0, width, number), rng.uniform(0, height, number)
    frames, interval = [], np.diff(times).mean()
    for _ in times:
        vx, vz = roll_velocity(x, z, width, height, speed)
        frames.append(np.array([x, z, vx, vz]))
        for _ in range(10):
            vx, vz = roll_velocity(x, z, width, height, speed)
            kick = rng.normal(0, np.sqrt(2 * diffusivity * interval / 10), (2, number))
            x = reflected(x + vx * interval / 10 + kick[0], width)
            z = reflected(z + vz * interval / 10 + kick[1], height)
    return np.array(frames)


def reflected(position, upper):
    """Position mirrored back into 0 to ``upper``."""
    folded = np.mod(position, 2 * upper)
    return np.where(folded > upper, 2 * upper - folded, folded)


def dump_table(frame, rng):
    """Rows id, x, z, vx, vz in an arbitrary order of particles, as a dump has them."""
    table = np.column_stack([np.arange(1, frame.shape[1] + 1), frame.T])
    return rng.permutation(table)


def write_binary_dump(path, step, table, box, ranks=2):
    """Native binary dump: the header, then for each rank a count of doubles and the doubles."""
    parts = np.array_split(table, ranks)
    with path.open("wb") as stream:
        stream.write(struct.pack("<qqi6i6d", step, len(table), 0, *[1] * 6, *np.ravel(box)))
        stream.write(struct.pack("<ii", table.shape[1], ranks))
        for part in parts:
            stream.write(struct.pack("<i", part.size))
            stream.write(part.astype("<f8").tobytes())


def write_text_dump(path, step, table, box):
    """Text dump: six digits, and a blank at the end of each line."""
    lines = [
        "ITEM: TIMESTEP",
        str(step),
        "ITEM: NUMBER OF ATOMS",
        str(len(table)),
        "ITEM: BOX BOUNDS ff ff ff",
    ]
    lines += [f"{lower:g} {upper:g}" for lower, upper in box]
    lines += [f"ITEM: ATOMS {' '.join(COLUMNS)} "]
    lines += [f"{row[0]:.0f} " + " ".join(f"{value:g}" for value in row[1:]) + " " for row in table]
    path.write_text("\n".join(lines) + "\n")


def write_run(folder, frames, times, width, height, dem_step=2e-5, segment=0.5, form="binary", seed=2):
    """A run as run_dem leaves it: frames in segments, and their manifest; path of dem.json."""
    rng = np.random.default_rng(seed)
    suffix = {"binary": "bin", "text": "txt"}[form]
    box = [(0, width), (-0.001, 0.001), (0, height)]
    entries, ends = [], np.arange(segment, times[-1] + segment / 2, segment)
    for frame, time in zip(frames, times, strict=True):
        index = min(int(np.searchsorted(ends, time - 1e-9)), len(ends) - 1)
        step = round(time / dem_step)
        file = Path("dem") / STAMP / f"segment_{index + 1:04d}" / f"frame_{step}.{suffix}"
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        writer = write_binary_dump if form == "binary" else write_text_dump
        writer(path, step, dump_table(frame, rng), box)
        size = path.stat().st_size
        entries.append({"step": step, "time_s": float(time), "file": str(file), "bytes": size})
    segments = [
        {
            "index": index + 1, "start_s": float(end - segment), "end_s": float(end),
            "folder": f"dem/{STAMP}/segment_{index + 1:04d}",
            "wall_s": 9.0, "dem_s": 7.0, "exchange_s": 0.5, "gas_s": 1.5,
        }
        for index, end in enumerate(ends)
    ]  # fmt: skip
    manifest = {
        "stamp": STAMP, "ranks": 2, "dem_step_s": dem_step, "frame_interval_s": float(np.diff(times).mean()),
        "number": frames.shape[2], "columns": COLUMNS, "frames": entries, "segments": segments,
    }  # fmt: skip
    (folder / "dem.json").write_text(json.dumps(manifest))
    return folder / "dem.json"


def write_series(folder, times, pressure_drop, mean_height, number):
    """bed_series.csv of a bed whose pressure drop swings about a mean; path of it."""
    names = "time_s,inlet_velocity_m_s,pressure_drop_Pa,mean_height_m,kinetic_energy_J,particles_1,"
    names += "smallest_voidage_1,voidage_clips_1,volume_balance_1,exchange_error_1"
    swing = np.random.default_rng(7).normal(1, SERIES_NOISE, len(times))
    rows = [
        f"{t:.6g},1.5,{pressure_drop * s:.8g},{mean_height:.6g},1e-3,{number},0.4,0,1e-15,1e-14"
        for t, s in zip(times, swing, strict=True)
    ]
    path = folder / "bed_series.csv"
    path.write_text("\n".join([names, *rows]) + "\n")
    return path
