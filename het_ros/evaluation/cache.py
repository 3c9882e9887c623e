# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Results of runs on disk, so that nothing is run twice and an interrupted run goes on."""

from __future__ import annotations

import hashlib
import os
import zipfile
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from het_ros.evaluation.answers import Track

FORMAT = 1  # count up when a protocol changes what is recorded


def key_of(*parts: object) -> str:
    """Hash of everything that a result depends on."""
    return hashlib.sha256(repr((FORMAT, *parts)).encode()).hexdigest()[:20]


class Cache:
    """One file a run: FOLDER/TRACKER/SEQUENCE/VARIANT_SEED_KEY.npz."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def load(self, name: str) -> Track | None:
        """The result called ``name``, or None when there is none that can be read."""
        file = self._file(name)
        try:
            with np.load(file, allow_pickle=False) as saved:
                values = {f.name: saved[f.name] for f in fields(Track)}
        except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
            return None
        for name_ in ("starts", "failures"):
            values[name_] = values[name_].tolist()
        return Track(**{**values, "error": str(values["error"])})

    def save(self, name: str, track: Track) -> None:
        """Write a result in one stroke: whoever interrupts leaves the old file or the new one."""
        file = self._file(name)
        file.parent.mkdir(parents=True, exist_ok=True)
        draft = file.with_suffix(f".{os.getpid()}.part")
        with draft.open("wb") as out:
            rows: dict[str, Any] = {f.name: getattr(track, f.name) for f in fields(Track)}
            np.savez_compressed(out, **rows)
        draft.replace(file)

    def _file(self, name: str) -> Path:
        return self._folder / f"{name}.npz"
