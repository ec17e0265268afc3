# SPDX-License-Identifier: GPL-3.0-or-later
"""Markov chains of fluidized beds, learned from simulated particles: the library behind the stage scripts.

Terms, as this code uses them; symbols and units in brackets.

The bed and its simulation
--------------------------
bed : the particles in their box, and the gas through them; x is the width, z the height, y the thickness [m].
superficial velocity (U) : volume flow of gas over the empty bed's cross-section [m/s].
voidage (epsilon) : share of a volume that is gas [1].
minimum fluidization (u_mf) : superficial velocity at which the gas carries the bed's weight [m/s].
terminal velocity (u_t) : speed at which a single sphere falls through gas at rest [m/s].
bubble : a region almost free of particles that rises through the bed.
pressure drop (Delta p) : of the gas over the bed; weight over area where the gas carries all of it [Pa].
drag law : force of the gas on a particle, by slip velocity and voidage.
smoothing length : width over which particles are spread to the gas cells, in diameters [1].
gas cell : cell of the OpenFOAM mesh; not a cell of a chain [m].
exchange : forces between gas and particles, once a gas step.
thickness (T) : of the slab that the voidage of one layer refers to [m].
Rayleigh time (t_R) : time of a surface wave over a particle; the DEM step is a share of it [s].
restitution (e) : speed after a normal impact over the speed before it [1].
overlap : depth by which two spheres penetrate each other, in diameters [1].
granular temperature (theta) : variance of the particles' velocities about their local mean [m2/s2].
DEM : the discrete element simulation with its gas; also its curves, as against those of a chain.
segment : a piece of a run that ends in a restart of both solvers; it exists whole or not at all.
restart : state of both solvers from which a run goes on; other segments change the course by round-off (of a
    drum by one force computed anew), and so give another realisation in the end.
rank : one of the processes that share a run.
stamp : hash of all that a result depends on; the name of the folder that holds it.

Cases
-----
case : a folder of ``cases/``; ``case.yaml`` holds all numbers of a bed and its chains.
preset : settings of bed and chain by name (fast, balanced, accurate), chosen by the trade-off study.
variant : a case with some keys changed, simulated in a folder of its own.
archive : what figures need of a simulated bed, kept in ``cases/<case>/reference``.
audit : dimensionless numbers that say which physics a scene needs.

Frames and cells
----------------
frame : positions and velocities of all particles at one time; frames are `frame_interval_s` apart [s].
trajectory : all frames of a run, in the order of the particles' numbers.
cell : rectangle of the grid laid over the bed; numbered from the bottom left, row by row [1].
window : consecutive frames: the learning window and the comparison window [s].
batch : particles put in at the bottom at the start, followed by themselves (Figs. 3 and 4).
group : particles marked by their side at the start: left, right, low, up (Fig. 5).

Chains
------
state : what the next move depends on: a cell (static), two cells (dynamic), a cell and a class of velocity.
lag (tau) : time over which a move is counted [s]; in frames where a variable says so.
step : one application of the matrix, one lag long; a DEM step or gas step is named as such.
transition counts (N_ij) : particles seen in cell i that are in cell j one lag later [1].
transition matrix (P) : share of the counts of each row; P_ij is the probability to go from i to j [1].
row-stochastic : no entry is negative and each row adds up to 1, so that p_next = p P.
estimator : rule from counts to the matrix: literal (the paper's mean over steps), per_step, pooled.
leak : probability that a matrix loses, where rows do not add up to 1 [1].
closed class : states that the chain enters and never leaves.
exact : expectation, by matrix products; Monte Carlo moves every particle by chance.
tracer : particle of a Monte Carlo run.
long-run density (pi) : distribution that the chain keeps, pi = pi P [1].
implied timescale : -lag / ln |eigenvalue|; the same at all lags where the chain is Markov [s].
Chapman-Kolmogorov test : P of one lag, applied k times, against P counted at k lags.
residence time : how long a particle stays in a cell [s].
passage time : how long it needs from one height to another [s].

Mixing and errors
-----------------
mixing curve : share of a group that is still on its side, over time [1].
Lacey index : mixing of two kinds of particles; 0 apart, 1 the expected index of a random mixture [1].
dispersion coefficient (D) : half the growth of the displacements' variance over time [m2/s].
numerical dispersion : what the chain adds by forgetting where in its cell a particle is [m2/s].
total variation : half the sum of absolute differences of two distributions [1].
realisation : one run of a bed; another start, machine or number of ranks gives another one of the same bed.
repeat : realisation from a slightly perturbed state of the main run: dem_1, dem_2, ... in tables.
noise floor : spread of the realisations' curves; two realisations differ by sqrt(2) of it [1].
block error : error of a mean over time, from blocks long enough to be independent.
validation : error in parts of the learning window of a chain learned on the rest of it; the test is on the
    comparison window.
"""
