#!/usr/bin/env python3
# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Build wheel and sdist, and run the library from each in an empty environment.

example: python3 .ci/dist.py out/dist
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import venv
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[1]
VERSION = ElementTree.parse(ROOT / "package.xml").findtext("version")
TRY = f"""
import numpy as np
import het_ros
from het_ros import Box, HierarchicalEnsembleTracker, State
assert het_ros.__version__ == {VERSION!r}, het_ros.__version__
image = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
tracker = HierarchicalEnsembleTracker()
tracker.init(image, Box(100, 80, 40, 60))
assert tracker.update(image, 1 / 30).state is State.TRACKING
print("het_ros", het_ros.__version__, "works from", het_ros.__file__)
"""


def run(*words: object, cwd: Path = ROOT) -> None:
    """Run a command; its failure is ours."""
    subprocess.run([str(word) for word in words], cwd=cwd, check=True)


def main() -> int:
    """Build, install, try."""
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out/dist").resolve()
    for old in out.glob("het_ros-*"):
        old.unlink()
    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        pip = ("-m", "pip", "--quiet", "--disable-pip-version-check")
        venv.create(place / "build", with_pip=True)
        builder = place / "build" / "bin" / "python"
        run(builder, *pip, "install", "build")
        run(builder, "-m", "build", "--outdir", out, ROOT)  # the wheel is built from the sdist
        wheel, sdist = next(out.glob("*.whl")), next(out.glob("*.tar.gz"))
        venv.create(place / "try", with_pip=True)
        python = place / "try" / "bin" / "python"
        for built in (wheel, sdist):
            run(python, *pip, "install", "--force-reinstall", "--no-deps", built)
            run(python, *pip, "install", f"{built}[opencv]")
            run(python, "-I", "-c", TRY, cwd=place)
    print(wheel, sdist, sep="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
