import pytest

from het_ros.scene import Scene, SceneConfig

RATE = 20.0


@pytest.fixture(scope="session")
def tell():
    """Scenes by story and seed, each built once for all tests."""
    told = {}

    def scene(story: str, seed: int = 3) -> Scene:
        if (story, seed) not in told:
            told[story, seed] = Scene(SceneConfig(story=story, seed=seed, rate=RATE))
        return told[story, seed]

    return scene
