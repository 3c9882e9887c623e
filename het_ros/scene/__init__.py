# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A rendered street with exact truth: frames, the target's box and how much of it is seen."""

from het_ros.scene.camera import CameraState, Lens
from het_ros.scene.config import SceneConfig
from het_ros.scene.scene import Frame, Scene
from het_ros.scene.stories import STORIES, Story

__all__ = ["STORIES", "CameraState", "Frame", "Lens", "Scene", "SceneConfig", "Story"]
