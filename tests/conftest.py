# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties are tried on the same examples each time, and on few of them; a killed ./test ends its tests."""

import sys

import pytest
from hypothesis import HealthCheck, settings

from bedchain.lifetime import end_with_run

end_with_run()
PYTHON = sys.executable


@pytest.fixture(autouse=True)
def python_by_its_path():
    """The interpreter's path as it is; a Snakefile that is read in this process quotes it for shell lines."""
    sys.executable = PYTHON


settings.register_profile(
    "bedchain",
    derandomize=True,
    deadline=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("bedchain")
