# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of what refuses."""

import pytest

from bedchain.errors import UserError


def message_of(check, *arguments):
    """The message of a check that refuses, in one line."""
    with pytest.raises(UserError) as caught:
        check(*arguments)
    assert "\n" not in str(caught.value)
    return str(caught.value)
