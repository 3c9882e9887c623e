# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""REP-2004 asks for a copyright statement in each source file."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
HEADER = "# Copyright 2026 het_ros maintainers\n# SPDX-License-Identifier: Apache-2.0\n"


def test_each_python_file_begins_with_copyright_and_license():
    files = [
        ROOT / "setup.py",
        *(p for d in ("het_ros", "test", "launch") for p in (ROOT / d).rglob("*.py")),
    ]
    assert len(files) > 100
    without = [
        str(p.relative_to(ROOT))
        for p in files
        if p.read_text() and not p.read_text().startswith(HEADER)
    ]
    assert not without
