# SPDX-License-Identifier: GPL-3.0-or-later
"""What every stage script shares: its log, its errors, and files that appear only when they are complete."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bedchain.errors import DataError, UserError, report_user_errors

LOG = logging.getLogger("bedchain")


@contextmanager
def stage(log: Path | str) -> Iterator[None]:
    """Run a stage: what it reports goes to stderr and to its log, a user's error is one clear message.

    Parameters
    ----------
    log : path
        The rule's log file.

    Raises
    ------
    SystemExit
        Code 1, after a `UserError` or a `DataError`.
    """
    Path(log).parent.mkdir(parents=True, exist_ok=True)
    handlers: list[logging.Handler] = [logging.StreamHandler(), logging.FileHandler(log, mode="w")]
    for handler in handlers:
        handler.setFormatter(logging.Formatter("%(asctime)s %(message)s", "%H:%M:%S"))
        LOG.addHandler(handler)
    LOG.setLevel(logging.INFO)
    try:
        with report_user_errors(log):
            try:
                yield
            except DataError as error:
                raise UserError(str(error)) from error
    except Exception:
        LOG.exception("failed")
        raise
    finally:
        for handler in handlers:
            LOG.removeHandler(handler)
            handler.close()
