# SPDX-License-Identifier: GPL-3.0-or-later
"""The same particles for Yade: Hertz-Mindlin contacts, spheres kept in the plane y = 0, three walls.

usage: yade -n -x -j1 scripts/bedchain/studies/peers/inputs/yade_bed.py FOLDER

FOLDER holds particles.npy and bed.json; result.json comes into it.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
from yade import (
    Bo1_Sphere_Aabb,
    Bo1_Wall_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_MindlinPhys,
    Law2_ScGeom_MindlinPhys_Mindlin,
    NewtonIntegrator,
    O,
    utils,
)

folder = Path(sys.argv[1])
bed = json.loads((folder / "bed.json").read_text(encoding="utf-8"))

# --- particles and walls
material = O.materials.append(
    FrictMat(
        young=bed["young"],
        poisson=bed["poisson"],
        frictionAngle=np.arctan(bed["friction"]),
        density=bed["density"],
    )
)
for x, z, vx, vz, diameter in np.load(folder / "particles.npy").tolist():
    number = O.bodies.append(utils.sphere((x, 0, z), diameter / 2, material=material))
    O.bodies[number].state.vel = (vx, 0, vz)
    O.bodies[number].state.blockedDOFs = "yXZ"  # one layer
spheres = len(O.bodies)
for position, axis in ((0, 0), (bed["width"], 0), (0, 2)):
    O.bodies.append(utils.wall(position, axis, material=material))

# --- contacts and integration; the collider's own choice of the distance at which it sorts again
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=bed["restitution"], es=bed["restitution"])],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(gravity=(0, 0, -bed["gravity"]), damping=0),
]
O.dt = bed["dem_step"]

# --- run; the first step sorts all particles and is not timed
O.run(1, wait=True)
start = time.perf_counter()
O.run(bed["steps"], wait=True)
spent = time.perf_counter() - start
heights = [O.bodies[number].state.pos[2] for number in range(spheres)]
result = {
    "wall_s": spent,
    "steps": bed["steps"],
    "particles": spheres,
    "mean_height_m": float(np.mean(heights)),
}
(folder / "result.json").write_text(json.dumps(result), encoding="utf-8")
