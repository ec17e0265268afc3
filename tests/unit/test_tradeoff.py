# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings, observables, presets and variants of the trade-off study."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy import stats

from bedchain.case import load_case
from bedchain.case_checks import RAYLEIGH_SHARE_MAX
from bedchain.case_numbers import is_multiple, rayleigh_time
from bedchain.diagnostics import total_variation
from bedchain.errors import UserError
from bedchain.fidelity import count_near
from bedchain.grid import Grid
from bedchain.noise import noise_floor
from bedchain.tradeoff import bed_half
from bedchain.tradeoff.bed_half import on_one_rank, simulate_all, solver_memory
from bedchain.tradeoff.bed_variants import BedVariant, bed_variants, variants_or_exit, wanted_variants
from bedchain.tradeoff.chain_half import MOMENTS, half_moments
from bedchain.tradeoff.observables import Reference, Seen, curve_errors, density_errors, scalar_errors
from bedchain.tradeoff.presets import choose, knee, nominal_cell, pareto_front, write_presets
from bedchain.tradeoff.reference import granular_temperature, mixing_time
from bedchain.tradeoff.settings import FACTORIAL, ORDER, Own, settings
from bedchain.variants import Variant, write_variant

SHORT = Path("cases/short/case.yaml")


@pytest.fixture(autouse=True)
def in_repository(monkeypatch, request):
    """Case files are named from the repository."""
    monkeypatch.chdir(request.config.rootpath)


def own(columns=10, rows=40, width=0.1, height=0.4, frames=80, **changes):
    """The short bed's own chain, or another."""
    values = {
        "lag": 1, "estimator": "pooled", "learning": slice(60, 60 + frames + 1), "compared": frames,
        "interval_s": 0.025, "diameter_m": 1e-3, "splits": (width / 2, round(0.2 * height, 6)),
    }  # fmt: skip
    return Own(Grid(width, height, columns, rows), **values | changes)


def test_every_cell_size_meets_every_lag_and_nothing_comes_twice():
    found = settings(own())
    assert len({one.key.removeprefix(one.axis) for one in found}) == len(found)
    factorial = {(one.columns, one.rows, one.lag) for one in found if one.axis == FACTORIAL}
    grids, lags = ({key[:2] for key in factorial}, {key[2] for key in factorial})
    assert lags == {1, 2, 4, 10, 20, 40, 80}
    assert {(40, 160), (20, 80), (10, 40), (2, 10)} <= grids
    assert len(factorial) == len(grids) * len(lags)
    assert {one.tracers for one in found if one.axis == "tracers"} == {10**n for n in range(2, 7)}
    assert {one.model for one in found if one.axis == ORDER} == {"dynamic"}


def test_settings_that_do_not_fit_are_left_out():
    small = settings(own(2, 6, 0.02, 0.06, frames=5, diameter_m=4e-3))
    assert small and max(one.lag for one in small) <= 5
    assert all(0.02 / one.columns >= 4e-3 and 0.06 / one.rows >= 4e-3 for one in small)
    # the second order needs two steps
    assert all(2 * one.lag <= 5 for one in small if one.model == "dynamic")
    assert not [one for one in settings(own(models=("static",))) if one.axis == ORDER]


def test_cells_divide_levels_and_keep_the_lines():
    # the paper's bed: 540 levels of half a diameter, its middle column cut by the line; its other line is not
    assert count_near(0.27, 0.01, 0.135, 27, 1e-3) == 27
    assert count_near(0.27, 0.02, 0.135, 27, 1e-3) in {12, 15}
    # 2100 levels; 0.25 m of 1.05 m stays a border: multiples of 21
    assert {count_near(1.05, cell, 0.25, 105, 1e-3) % 21 for cell in (0.0025, 0.01, 0.03, 0.05)} == {0}
    # the line was a border, so it stays one: even counts only
    assert count_near(0.1, 0.033, 0.05, 10, 1e-3) == 4


def test_nominal_cells_give_the_columns_and_rows_that_they_stand_for():
    for case in (own(), own(27, 105, 0.27, 1.05, splits=(0.135, 0.25))):
        for one in settings(case):
            if one.axis in (FACTORIAL, ORDER):
                assert case.near(nominal_cell(one.columns, one.rows, case)) == (one.columns, one.rows)


def realisations(number=4, frames=30, cells=12, seed=3):
    rng = np.random.default_rng(seed)
    curves = 0.5 + rng.normal(0, 0.05, (number, frames, 4))
    densities = rng.dirichlet(np.full(cells, 5.0), (number, 2))
    scalars = {"bed_height": tuple(rng.normal(0.06, 1e-3, number))}
    return Reference(curves, number > 1, densities, scalars)


def test_curve_errors_are_those_of_a_loop_in_noise_floors():
    found = realisations()
    model = np.full((30, 4), 0.47)
    row = curve_errors(found, model[None, None])
    floor = noise_floor(found.curves)[0]
    for column, name in enumerate(("left", "right", "low", "up")):
        total = [np.mean((model[:, column] - one[:, column]) ** 2) for one in found.curves]
        error = np.sqrt(np.mean(total))
        assert row[f"{name}_error_1"] == pytest.approx(error)
        assert row[f"{name}_floors_1"] == pytest.approx(error / floor[column])
        assert row[f"{name}_ci_low_1"] <= error <= row[f"{name}_ci_high_1"]
    whole = np.sqrt(np.mean((model - found.curves) ** 2) / np.mean(floor**2))
    assert row["mixing_floors_1"] == pytest.approx(whole)


def test_the_mean_of_all_realisations_has_one_floor_and_another_bed_sqrt_two():
    many = realisations(number=400)
    exact = curve_errors(many, many.curves.mean(axis=0)[None, None])
    assert exact["mixing_floors_1"] == pytest.approx(1.0, rel=0.01)
    draws = np.stack([realisations(1, seed=seed).curves for seed in range(10, 30)])
    assert curve_errors(many, draws)["mixing_floors_1"] == pytest.approx(np.sqrt(2), rel=0.02)


def test_without_repeats_there_is_an_error_and_no_floor():
    found = realisations()
    alone = Reference(found.curves, False, found.densities[:1], {"bed_height": (0.06,)})
    row = curve_errors(alone, np.full((1, 1, 30, 4), 0.47))
    assert row["mixing_error_1"] > 0 and np.isnan(row["mixing_floors_1"])
    assert np.isfinite(row["mixing_ci_low_1"])  # over starts
    height = scalar_errors(alone, {"bed_height": 0.061})
    assert height["bed_height_error_m"] == pytest.approx(1e-3)
    assert np.isnan(height["bed_height_floors_1"]) and np.isnan(height["bed_height_ci_low_m"])


def test_further_realisations_join_the_reference():
    whole = realisations(number=6)
    first = Reference(
        whole.curves[:4], True, whole.densities[:4], {"bed_height": whole.scalars["bed_height"][:4]}
    )
    others = [
        Seen(whole.curves[at], whole.densities[at], {"bed_height": whole.scalars["bed_height"][at]})
        for at in (4, 5)
    ]
    joined = first.joined(others)
    assert joined.floors() == pytest.approx(whole.floors(), nan_ok=True)
    assert first.joined([]) is first
    # curves of several starts are no realisations
    alone = replace(first, repeated=False).joined(others)
    assert len(alone.curves) == 4 and len(alone.densities) == 6


def test_a_realisation_is_not_compared_with_itself(monkeypatch, tmp_path):
    reference = realisations(number=3)
    known = {"base": 0.05, "seed_1": 0.07, "friction_0": 0.08}

    def bed_row(case_file, one, folder):
        name = one.variant.name
        bed = Seen(reference.curves[0], reference.densities[0], {"bed_height": known[name]})
        return {"variant": name, "cost_s": 1.0, "problem": ""}, bed

    monkeypatch.setattr(bed_half, "bed_row", bed_row)
    variants = bed_variants(load_case(SHORT))
    rows = simulate_all(SHORT, [variants[name] for name in known], tmp_path, reference, at_once=1)
    own = list(reference.scalars["bed_height"])
    for row, pool in zip(rows, ([0.07], [0.05], [0.05, 0.07]), strict=True):
        error = known[row["variant"]] - np.mean(own + pool)
        assert row["bed_height_error_m"] == pytest.approx(error)
        assert row["bed_height_floors_1"] == pytest.approx(error / np.std(own + pool, ddof=1))


def test_densities_are_compared_half_by_half():
    found = realisations(number=3)
    row = density_errors(found, found.densities[:1])
    wanted = [
        total_variation(found.densities[0, half], found.densities[run, half])
        for run in range(3)
        for half in range(2)
    ]
    assert row["density_error_1"] == pytest.approx(np.mean(wanted))
    others = [
        total_variation(found.densities[run, half], np.delete(found.densities[:, half], run, 0).mean(axis=0))
        for run in range(3)
        for half in range(2)
    ]
    assert row["density_floors_1"] == pytest.approx(np.mean(wanted) / np.mean(others))


def test_scalars_have_students_interval_of_one_more_realisation():
    found = realisations()
    values = np.array(found.scalars["bed_height"])
    row = scalar_errors(found, {"bed_height": 0.07, "unknown": 1.0})
    half = stats.t.ppf(0.975, 3) * values.std(ddof=1) * np.sqrt(1.25)
    assert row["bed_height_error_m"] == pytest.approx(0.07 - values.mean())
    assert row["bed_height_ci_high_m"] - row["bed_height_ci_low_m"] == pytest.approx(2 * half)
    assert not [name for name in row if name.startswith(("unknown", "pressure"))]


def test_halves_of_a_window_have_rising_moments_inside():
    for length in (2, 3, 80, 81):
        first, second = half_moments(length)
        assert len(first) == len(second) == MOMENTS
        assert first[0] >= 1 and first[-1] <= second[0] and second[-1] == length
        assert (np.diff(first) >= 0).all() and (np.diff(second) >= 0).all()


def test_mixing_time_of_an_exponential_is_its_time_constant():
    time = 0.025 * np.arange(100)
    apart = np.exp(-time / 0.4)
    one, other = 0.6 + 0.4 * apart, 0.4 + 0.6 * apart
    assert mixing_time(one, other, 0.025) == pytest.approx(0.4, rel=1e-3)
    assert np.isnan(mixing_time(one[:10], other[:10], 0.025))


def test_granular_temperature_is_that_of_a_loop_and_of_the_theory():
    rng = np.random.default_rng(4)
    cells = rng.integers(0, 30, (5, 2000)).astype(np.int32)
    drift = rng.normal(0, 1.0, 30)[cells]
    vx, vz = (drift + rng.normal(0, 0.2, cells.shape) for _ in range(2))
    found = granular_temperature(cells, vx, vz, 40)
    squares, freedom = 0.0, 0
    for frame in range(5):
        for cell in range(40):
            inside = cells[frame] == cell
            for v in (vx[frame, inside], vz[frame, inside]):
                squares += ((v - v.mean()) ** 2).sum() if v.size else 0.0
            freedom += max(int(inside.sum()) - 1, 0)
    assert found == pytest.approx(squares / (2 * freedom))
    # sampling error of 20 000 squares is 1 %
    assert found == pytest.approx(0.04, rel=0.05)
    assert np.isnan(granular_temperature(np.array([[0, 1]], np.int32), vx[:1, :2], vz[:1, :2], 2))


def front_table():
    """Chains with a front of five, a dominated one, a shape that may not be chosen, one not validated."""
    table = pd.DataFrame(
        {
            "axis": [FACTORIAL, FACTORIAL, ORDER, FACTORIAL, FACTORIAL, FACTORIAL, "cell shape", FACTORIAL],
            "cost_s": [1e-3, 4e-3, 1.0, 1e-2, 0.1, 0.2, 1e-3, 1e-3],
            "validation_error_1": [0.30, 0.09, 0.050, 0.06, 0.055, 0.07, 0.01, np.nan],
        }
    )
    table["model"] = ["dynamic" if axis == ORDER else "static" for axis in table["axis"]]
    table["cell_width_m"], table["cell_height_m"], table["lag_s"] = 0.01, 0.01, 0.025
    table["density_floors_1"] = 1.5
    table["mixing_floors_1"] = np.linspace(3, 1, len(table))
    return table


def test_presets_are_chosen_by_validation_and_cost():
    table = front_table()
    assert pareto_front(table.iloc[:6]).index.tolist() == [0, 1, 3, 4, 2]
    # two floors allow 0.09; the knee between it and the best is the one where the curve turns
    assert choose(table, 0.045) == {"fast": 1, "balanced": 3, "accurate": 2}
    # without a floor, half as much again as the lowest; what is between lies above the chord
    assert choose(table, np.nan) == {"fast": 3, "balanced": 2, "accurate": 2}
    assert choose(table.iloc[:1], 0.001) == {"fast": 0, "balanced": 0, "accurate": 0}
    with pytest.raises(UserError, match="no chain could be validated"):
        choose(table.iloc[6:], 0.045)


def test_errors_of_the_comparison_window_choose_nothing():
    table = front_table()
    assert choose(table.assign(mixing_floors_1=table["mixing_floors_1"].to_numpy()[::-1]), 0.045) == choose(
        table, 0.045
    )


def test_the_knee_is_below_the_chord():
    straight = pd.DataFrame({"cost_s": [1, 10, 100], "validation_error_1": [1.0, 0.5, 0.25]})
    assert knee(straight) == 2
    assert knee(straight.assign(validation_error_1=[1.0, 0.3, 0.25])) == 1
    assert knee(straight.assign(validation_error_1=[1.0, 0.9, 0.25])) == 2


def test_presets_are_written_as_a_case_reads_them(tmp_path):
    table, path = front_table(), tmp_path / "presets.yaml"
    table.loc[2, "mixing_floors_1"] = np.nan
    write_presets(table, choose(table, 0.045), own(), "a bed; a machine", path)
    found = yaml.safe_load(path.read_text())
    assert list(found) == ["fast", "balanced", "accurate"]
    assert found["fast"] == {
        "cell_m": 0.01, "lag_s": 0.025, "model": "static", "cost_s": 0.004, "error_floors": 2.71,
        "density_floors": 1.5, "measured_on": "a bed; a machine",
    }  # fmt: skip
    assert found["accurate"]["model"] == "dynamic" and found["accurate"]["error_floors"] is None


@pytest.mark.parametrize("name", ["short", "drum"])
def test_every_variant_of_a_case_is_a_case(name, tmp_path):
    file = Path("cases") / name / "case.yaml"
    case = load_case(file)
    variants = bed_variants(case)
    assert "base" in variants and {"seed_1", "stiffness_10"} <= set(variants)
    for one in variants.values():
        found = write_variant(file, on_one_rank(one.variant), tmp_path / one.variant.name)
        assert one.variant.name == "base" or found | {"run": 0} != case | {"run": 0}
        if one.axis == "stiffness and step":
            contact, particles = found["contact"], case["particles"]
            rayleigh = rayleigh_time(
                contact["young_modulus_Pa"], contact["poisson_ratio_1"], particles["density_kg_m3"],
                particles["diameter_m"] / 2,
            )  # fmt: skip
            assert 0.1 < found["time"]["dem_step_s"] / rayleigh <= RAYLEIGH_SHARE_MAX
        if "gas" in one.axis:
            assert is_multiple(found["time"]["frame_interval_s"], found["time"]["gas_step_s"])
    assert ("drag_koch_hill" in variants) == (case["gas"]["model"] == "coupled")


def test_variants_are_named_or_all_or_none():
    case = load_case(SHORT)
    everything = list(bed_variants(case))
    assert wanted_variants(None, case, archived=False) == everything
    assert wanted_variants(None, case, archived=True) == wanted_variants({"dem": "none"}, case, False) == []
    assert wanted_variants({"dem": "all"}, case, archived=True) == everything
    assert set(wanted_variants({"dem": ["base", "friction_0"]}, case, True)) == {"base", "friction_0"}
    assert wanted_variants({"dem": "base"}, case, True) == ["base"]


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ({"dem": ["base", "friktion_0"]}, r"no variant friktion_0; take of .*friction_0"),
        ({"dme": "all"}, "tradeoff has no dme"),
        ({"dem": 3}, "tradeoff.dem 3: take"),
        ("all", "tradeoff=all: take"),
    ],
)
def test_a_wrong_option_is_told_the_right_ones(option, said, capsys):
    with pytest.raises(UserError, match=said):
        wanted_variants(option, load_case(SHORT), archived=False)
    with pytest.raises(SystemExit):
        variants_or_exit(option, load_case(SHORT), False)
    assert "Traceback" not in capsys.readouterr().err


def test_a_variant_that_cannot_run_is_a_row_with_its_reason(tmp_path):
    wrong = [
        BedVariant("ablation", Variant("long_step", {"time.dem_step_s": 1e-4})),
        BedVariant("ablation", Variant("no_bed", {"bed.width_m": -1.0})),
    ]
    rows = simulate_all(SHORT, wrong, tmp_path, realisations(), at_once=2)
    assert [row["variant"] for row in rows] == ["long_step", "no_bed"]
    assert "Rayleigh" in rows[0]["problem"] and "bed.width_m" in rows[1]["problem"]
    assert rows[0]["changed"] == "time.dem_step_s 0.0001"
    assert not {"cost_s", "mixing_error_1"} & set(rows[0])


def test_memory_is_that_of_solvers_with_the_folder_in_their_command():
    # this very process runs, but is no solver
    assert solver_memory(sys.argv[0]) == 0.0
