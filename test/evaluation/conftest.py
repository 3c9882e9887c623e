# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from pathlib import Path

import pytest

from .doubles import write_sequence

DATA = Path(os.environ.get("HET_SEQUENCES", Path(__file__).parents[2] / "../shared/sequences"))


@pytest.fixture(scope="session")
def data():
    if not DATA.is_dir():
        pytest.skip(f"no sequences at {DATA}: set HET_SEQUENCES to their folder")
    return DATA


@pytest.fixture(scope="session")
def published():
    folder = DATA.parent / "published"
    if not folder.is_dir():
        pytest.skip(f"no published figures at {folder}")
    return folder


@pytest.fixture
def moving(tmp_path):
    """A square that moves 3 px a frame to the right, 12 frames of 64 x 48 px."""
    return write_sequence(tmp_path / "moving", [(5 + 3 * i, 20, 10, 12) for i in range(12)])
