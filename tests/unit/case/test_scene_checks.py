# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that cannot be built, each refused with key and remedy."""

import math
import tracemalloc

import pytest
import yaml

from bedchain.case.load import load_case
from bedchain.case.scene_checks import drum_sites, surely_fit
from bedchain.errors import CaseError
from made import ROOT

DRUM = ROOT / "cases" / "drum" / "case.yaml"


@pytest.fixture
def changed(tmp_path):
    """Function that writes the drum's case with changes by section, None for a section to leave out."""

    def change(**changes):
        case = yaml.safe_load(DRUM.read_text(encoding="utf-8"))
        for section, keys in changes.items():
            if keys is None:
                del case[section]
            else:
                case.setdefault(section, {}).update(keys)
        file = tmp_path / "case.yaml"
        file.write_text(yaml.safe_dump(case), encoding="utf-8")
        return file

    return change


DRUM_MISTAKES = [
    ({"drum": None}, "gas.model", "add drum: {revolution_s: ...}"),
    ({"gas": {"model": "coupled"}}, "gas.model", "does not go with a drum"),
    ({"gas": {"model": "nothing"}}, "gas.model", "coupled, two_fluid, none"),
    ({"bed": {"height_m": 0.25}}, "bed.height_m", "take bed.width_m (0.24 m)"),
    ({"bed": {"layers": "many", "thickness_m": 0.03}}, "bed.layers", "take one"),
    ({"drum": {"revolution_s": 5.25}}, "drum.revolution_s", "multiple of time.frame_interval_s"),
    ({"drum": {"revolution_s": -5.2}}, "drum.revolution_s", "at least 0.001"),
    ({"drum": {"revolution": 5.2}}, "drum.revolution", "did you mean revolution_s?"),
    ({"particles": {"number": 3800}}, "particles.number", "sites in a drum"),
    ({"run": {"dump_format": "text"}}, "run.dump_format", "take binary"),
    ({"comparison": {"repeats": 2, "start_s": 20.8, "end_s": 36.4}}, "comparison.repeats", "take 0"),
    ({"time": {"frame_interval_s": 0.1001}}, "time.frame_interval_s", "multiple of time.dem_step_s"),
]


@pytest.mark.parametrize(("changes", "key", "said"), DRUM_MISTAKES)
def test_a_drum_that_cannot_be_is_refused_with_key_and_remedy(changed, changes, key, said):
    with pytest.raises(CaseError) as caught:
        load_case(changed(**changes))
    found = [f"{problem.wrong}; {problem.remedy}" for problem in caught.value.problems if problem.key == key]
    assert found and said in found[0], caught.value


def test_keys_of_the_gas_and_its_steps_are_not_asked_of_a_drum(changed):
    free = changed(gas={"cell_size_m": 0.007}, time={"gas_step_s": 3.3e-4, "ramp_s": 99.0})
    assert load_case(free)["gas"]["cell_size_m"] == 0.007


def test_as_many_fit_as_the_lattice_has_sites(changed):
    spacing, radius, reach = 1.15 * 3e-3, 0.12, 0.12 - 1.5e-3
    sites = 0
    for column in range(100):
        for row in range(100):
            x, z = (column + 0.5) * spacing - radius, (row + 0.5) * spacing - radius
            sites += math.sqrt(x * x + z * z) <= reach
    assert drum_sites(0.24, 3e-3) == sites
    load_case(changed(particles={"number": sites}))
    with pytest.raises(CaseError, match=f"take at most {sites}"):
        load_case(changed(particles={"number": sites + 1}))


@pytest.mark.parametrize(("diameter", "particle"), [(0.24, 3e-3), (0.1, 3e-3), (0.0101, 1e-3), (1e-3, 9e-4)])
def test_particles_that_surely_fit_are_no_more_than_the_sites(diameter, particle):
    assert not surely_fit(drum_sites(diameter, particle) + 1, diameter, particle)


def test_a_drum_in_millimetres_is_asked_about_and_takes_no_memory(changed):
    file = changed(bed={"width_m": 240.0, "height_m": 240.0})
    tracemalloc.start()
    with pytest.raises(CaseError, match="240 m wide: were millimetres meant"):
        load_case(file)
    assert tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()
    assert drum_sites(24.0, 3e-3) > 37e6  # by rows: a table of all sites would have 0.8 GB
