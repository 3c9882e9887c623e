# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from functools import lru_cache

import pytest

from het_ros.scene import Scene, SceneConfig

RATE = 10.0


@pytest.fixture(scope="session")
def tell():
    """Scenes by story and seed; the last few are kept, for a street takes 40 MB."""

    @lru_cache(maxsize=5)
    def scene(story: str, seed: int = 3) -> Scene:
        return Scene(SceneConfig(story=story, seed=seed, rate=RATE))

    return scene
