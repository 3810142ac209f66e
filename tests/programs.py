"""Programs that tests of extras need: installed from Debian's packages where they may be."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from contextlib import suppress

import pytest


def need(programs: Sequence[str], packages: Sequence[str]) -> None:
    """Make sure that programs are there, after an attempt to install them; the test fails without.

    Args:
        programs: By their names on the PATH.
        packages: That bring them.
    """
    if not all(map(shutil.which, programs)):
        with suppress(OSError, subprocess.SubprocessError):
            subprocess.run(["apt-get", "update", "-qq"], check=False, timeout=300)
            command = ["apt-get", "install", "-qq", "-y", "--no-install-recommends", *packages]
            subprocess.run(command, check=False, timeout=900, stdout=subprocess.DEVNULL)
    if missing := [program for program in programs if not shutil.which(program)]:
        pytest.fail(f"{', '.join(missing)} is missing: apt-get install {' '.join(packages)}")
