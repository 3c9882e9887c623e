# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What can be compared: every tracker behind the same two methods, and how to name one."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any, Protocol, cast

import cv2
import numpy as np
from numpy.typing import NDArray

import het_ros.tracking
from het_ros.evaluation import network_peers, opencv_peers
from het_ros.evaluation.answers import HORIZONS, Answer
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.paper.tracker import PaperTracker
from het_ros.tracking.parameter import Parameter, parameters_of
from het_ros.tracking.tracker import HierarchicalEnsembleTracker


class Tracker(Protocol):
    """The two methods of everything that is measured. It gets images and nothing else."""

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Start on ``box`` in an (H, W, 3) uint8 BGR image."""

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Follow into the next image, ``dt`` s later."""


@dataclass(frozen=True)
class TrackerSpec:
    """A tracker that can be built anywhere: in this process, in another, on a cluster.

    Attributes:
        name: what tables call it.
        build: makes the tracker from a seed; picklable.
        fingerprint: changes whenever the results may: configuration, source, library version.
        random: whether the seed matters, so that several seeds are worth their time.
        source: for het, the hash of the tracking package that it must run with; else "".
    """

    name: str
    build: Callable[[int], Tracker]
    fingerprint: str
    random: bool = True
    source: str = ""

    @property
    def folder(self) -> str:
        """The name as a folder's name."""
        return folder_name(self.name)


def folder_name(tracker: str) -> str:
    """A tracker's name as a folder's name."""
    return re.sub(r"[^\w.=+-]+", "_", tracker)


Config = TrackerConfig | PaperConfig


def tracker_of(config: Config) -> HierarchicalEnsembleTracker | PaperTracker:
    """The tracker that a configuration is of."""
    if isinstance(config, PaperConfig):
        return PaperTracker(config)
    return HierarchicalEnsembleTracker(config)


class Het:
    """The Hierarchical Ensemble Tracker, the default or the paper's."""

    def __init__(self, config: Config) -> None:
        self._tracker = tracker_of(config)

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Start on a box."""
        self._tracker.reset()
        self._tracker.init(image, box)

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Follow into the next image."""
        return answer_of(self._tracker.update(image, dt))


def answer_of(e: Estimate) -> Answer:
    """What an estimate says, with its own prediction where it has one."""
    return Answer(e.box.as_tuple(), e.state.value, e.score, e.velocity, e.covariance, predicted(e))


def predicted(estimate: Any) -> NDArray[np.float64] | None:
    """(3, 2) centres px, ``HORIZONS`` ahead, of an estimate that has ``predict(dt)``, or None.

    ``predict`` gives a Box, or an estimate that has one.
    """
    predict = getattr(estimate, "predict", None)
    if predict is None:
        return None
    found = (predict(seconds) for seconds in HORIZONS)
    return np.array([getattr(one, "box", one).centre for one in found])


class Identity:
    """Says that nothing ever moves: what any tracker has to beat."""

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Keep the box."""
        self._box = box.as_tuple()

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Return the first box."""
        return Answer(self._box)


def seeded_het(config: Config, seed: int) -> Het:
    """Het with the configuration's seed moved on by ``seed``."""
    return Het(dataclasses.replace(config, seed=config.seed + seed))


@cache
def tracking_source() -> str:
    """Hash of the tracking package's source, as it was when this process first asked."""
    folder = Path(het_ros.tracking.__file__).parent
    digest = hashlib.sha256()
    for file in sorted(folder.rglob("*.py")):
        digest.update(file.relative_to(folder).as_posix().encode() + file.read_bytes())
    return digest.hexdigest()[:16]


# Compared is what one thread of each can do.
BASES: dict[str, Config] = {
    "het": TrackerConfig(network_thread=False),
    "het-paper": PaperConfig(),
}
WITH_NETWORK = "het-network"  # needs the folder of the networks' files
DEFAULT = ("het", "het-paper", *opencv_peers.PEERS)


def split_names(text: str) -> list[str]:
    """Split a comma-separated list of trackers, keeping the commas inside a configuration.

    >>> split_names("het,het:sub_patches=5,seed=3,csrt")
    ['het', 'het:sub_patches=5,seed=3', 'csrt']
    """
    names: list[str] = []
    for piece in (part.strip() for part in text.split(",")):
        if names and "=" in piece and ":" not in piece and ":" in names[-1]:
            names[-1] += f",{piece}"
        elif piece:
            names.append(piece)
    return names


def tracker_spec(name: str, models: Path | None = None) -> TrackerSpec:
    """The tracker called ``name``.

    Names: ``het``, ``het-paper``, ``het-network`` (with NanoTrack v3 of ``models``),
    ``identity``, a peer of OpenCV (``csrt``...), a network (``nanotrack-v3``...; its files are
    looked for in ``models``), or a base with changes: ``het:sub_patches=5,seed=3`` or
    ``het:file.yaml`` (also JSON; a mapping of fields, or a ROS parameter file).
    ``label@het:...`` calls it ``label`` in the tables.

    Raises:
        ValueError: there is no such tracker, field or file, or a value is out of its range.
    """
    label, _, described = name.rpartition("@")
    base, _, changes = described.partition(":")
    if base in BASES or base == WITH_NETWORK:
        config = _changed(_base(base, models), changes)
        values = json.dumps(dataclasses.asdict(config), sort_keys=True)
        libraries = f"numpy {np.__version__} opencv {cv2.__version__}"
        fingerprint = _hash(f"{values} {tracking_source()} {libraries}")
        return TrackerSpec(
            label or described, partial(seeded_het, config), fingerprint, source=tracking_source()
        )
    if base == "identity":
        return TrackerSpec(label or name, _identity, "identity", random=False)
    if base in opencv_peers.PEERS:
        opencv_peers.require(base)
        peer = opencv_peers.PEERS[base]
        build = partial(opencv_peers.OpenCvTracker, base)
        fingerprint = _hash(f"{base} {opencv_peers.version()}")
        return TrackerSpec(label or name, build, fingerprint, random=peer.random)
    if base in network_peers.NAMES:
        return TrackerSpec(
            label or name,
            cast("Callable[[int], Tracker]", network_peers.builder(base, models)),
            network_peers.fingerprint(base, models),
            random=False,
        )
    known = ", ".join((*DEFAULT, WITH_NETWORK, *network_peers.NAMES, "identity"))
    raise ValueError(f"no tracker is called {base!r}; there are {known}")


def _base(name: str, models: Path | None) -> Config:
    """The configuration of one of ours, ``het-network`` with NanoTrack v3 of a folder."""
    if name == WITH_NETWORK:
        backbone, *_ = network_peers.files_of("nanotrack-v3", models)
        return TrackerConfig(network=str(backbone.parent), network_thread=False)
    return BASES[name]


def _identity(seed: int) -> Identity:
    return Identity()


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _changed(config: Config, changes: str) -> Config:
    if not changes:
        return config
    table = {p.name: p for p in parameters_of(type(config))}
    if Path(changes).suffix in {".yaml", ".yml", ".json"}:
        values = _read_file(Path(changes))
    else:
        pairs = [pair.partition("=") for pair in changes.split(",")]
        values = {key.strip(): text.strip() for key, _, text in pairs}
    unknown = [key for key in values if key not in table]
    if unknown:
        kind = type(config).__name__
        raise ValueError(f"{kind} has no {', '.join(unknown)}; it has {', '.join(table)}")
    return dataclasses.replace(
        config, **{key: parsed(table[key], value) for key, value in values.items()}
    )


def parsed(declared: Parameter, value: Any) -> Any:
    """A parameter's value from text (a tuple's items joined by ``+``) or from a file."""
    kind = type(declared.default)
    if isinstance(value, list):
        return tuple(value)
    if not isinstance(value, str) or kind is str:
        return float(value) if kind is float and isinstance(value, int) else value
    if kind is tuple:
        return tuple(item for item in value.split("+") if item)
    if kind is bool:
        words = {"true": True, "1": True, "false": False, "0": False}
        if value.lower() not in words:
            raise ValueError(f"{declared.name} takes true or false, not {value!r}")
        return words[value.lower()]
    try:
        return kind(value)
    except ValueError:
        raise ValueError(f"{declared.name} takes a {kind.__name__}, not {value!r}") from None


def _read_file(file: Path) -> dict[str, Any]:
    import yaml  # only needed for configurations in files

    if not file.is_file():
        raise ValueError(f"there is no configuration file {file}")
    content = yaml.safe_load(file.read_text())
    while isinstance(content, dict) and len(content) == 1:
        inner = next(iter(content.values()))  # ROS: {node: {ros__parameters: {...}}}
        if not isinstance(inner, dict):
            break
        content = inner
    if not isinstance(content, dict):
        raise ValueError(f"{file} is no mapping of fields to values")
    return content
