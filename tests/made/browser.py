# SPDX-License-Identifier: GPL-3.0-or-later
"""Chromium without a screen: as installed, or from Debian unpacked into a folder."""

import os
import shutil
import subprocess
from pathlib import Path

FETCH_S, OPEN_S = 600, 300


def chromium(folder: Path) -> list[str]:
    """Command that starts Chromium without a screen and without a network.

    Raises
    ------
    OSError, subprocess.SubprocessError
        It is not there, and its packages cannot be had.
    """
    program, libraries = shutil.which("chromium"), ""
    if not program:
        archives, root = folder / "archives", folder / "root"
        (archives / "partial").mkdir(parents=True)
        options = ["Debug::NoLocking=1", f"Dir::Cache::archives={archives}", "APT::Install-Recommends=0"]
        words = [word for option in options for word in ("-o", option)]
        subprocess.run(
            ["apt-get", *words, "install", "--yes", "--download-only", "chromium"],
            check=True, capture_output=True, timeout=FETCH_S,
        )  # fmt: skip
        for package in archives.glob("*.deb"):
            subprocess.run(["dpkg", "-x", package, root], check=True, capture_output=True)
        libraries = f"{root}/usr/lib/x86_64-linux-gnu:{root}/lib/x86_64-linux-gnu"
        program = f"{root}/usr/lib/chromium/chromium"
    variables = [f"LD_LIBRARY_PATH={libraries}", f"HOME={folder}"]
    # a page of the tests' own is opened, so Chromium's sandbox, which root may not use, is not missed
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile"]
    return ["env", *variables, program, *options, "--host-resolver-rules=MAP * ~NOTFOUND"]


def opened(command: list[str], page: Path, picture: Path) -> str:
    """The page's elements after it has loaded, with a picture of its first screen."""
    page_url = page.resolve().as_uri()
    size = "--window-size=1200,1600"
    subprocess.run(
        [*command, size, f"--screenshot={picture}", page_url], check=True, capture_output=True, timeout=OPEN_S
    )
    done = subprocess.run(
        [*command, size, "--virtual-time-budget=20000", "--dump-dom", page_url],
        check=True, capture_output=True, text=True, timeout=OPEN_S, env=os.environ,
    )  # fmt: skip
    return done.stdout
