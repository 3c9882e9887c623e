# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A siamese network (NanoTrack v2, v3) over cv2.dnn: crop, forward pass and decoding.

The backbone maps the target's crop and a larger crop around a place to features, the head
compares the two: for each of n x n points of the search crop it says whether the target is there,
and how far the sides of its box are away. How a tracker moves by these maps is its own matter.

The scheme is that of Li et al., "SiamRPN++", CVPR 2019, with the distances of Chen et al.,
"Siamese Box Adaptive Network", CVPR 2020; the networks are those of github.com/HonglinChu/
SiamTrackers (NanoTrack), which are given as ONNX files.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.resemblance import Resemblance, middle_of
from het_ros.tracking.box import Box

Image = NDArray[np.uint8]
Floats = NDArray[np.float32]

TEMPLATE = 127  # px, side of the target's crop
SEARCH = 255  # px, side of the search crop
STRIDE = 16  # px of the search crop between two points
CONTEXT = 0.5  # of w + h, added to both sides of the box
VERSIONS = {16: "v2", 15: "v3"}  # by the points along a side


class Siamese:
    """A network with its template.

    Args:
        backbone, head: the two ONNX files.

    Raises:
        ValueError: they are no such network, or do not fit each other.
    """

    def __init__(self, backbone: Path, head: Path) -> None:
        self._files = backbone, head
        self._backbone, self._head = _net(backbone), _net(head)
        self._outputs = self._head.getUnconnectedOutLayersNames()
        try:
            self._template = self._features(np.zeros((TEMPLATE, TEMPLATE, 3), np.uint8))
            score, _ = self._maps(np.zeros((SEARCH, SEARCH, 3), np.uint8))
        except (cv2.error, StopIteration) as error:
            raise ValueError(f"{backbone} and {head.name} are no NanoTrack network") from error
        self.places = len(score)
        self._crop = (0.0, 0.0), 1.0

    def __getstate__(self) -> dict[str, Any]:
        return {"files": self._files, "template": self._template}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """OpenCV's networks cannot be copied: their files are read again."""
        self.__init__(*state["files"])  # type: ignore[misc]
        self._template = state["template"]

    @classmethod
    def read(cls, folder: Path) -> Siamese:
        """Read ``*backbone*.onnx`` and ``*head*.onnx`` of a folder.

        Raises:
            ValueError: the folder does not hold one of each, or they are no such network.
        """
        found = [sorted(folder.glob(f"*{part}*.onnx")) for part in ("backbone", "head")]
        if [len(files) for files in found] != [1, 1]:
            raise ValueError(
                f"{folder} needs one NanoTrack network: *backbone*.onnx and *head*.onnx "
                "(github.com/HonglinChu/SiamTrackers, NanoTrack/models)"
            )
        return cls(found[0][0], found[1][0])

    @property
    def version(self) -> str:
        """Which NanoTrack it is, "v2" or "v3"; "" for another number of places."""
        return VERSIONS.get(self.places, "")

    def template(self, image: Image, box: Box) -> None:
        """Take the target in ``box`` of an (H, W, 3) uint8 BGR image as what is looked for."""
        x, y, w, h = box.as_tuple()
        side = crop_side(w, h)
        self._template = self._features(crop(image, (x + w / 2, y + h / 2), side, TEMPLATE))

    def look(
        self, image: Image, centre: tuple[float, float], size: tuple[float, float]
    ) -> tuple[Floats, Floats]:
        """Look for the target around a place.

        Args:
            image: (H, W, 3) uint8 BGR.
            centre: x, y of the search crop, px.
            size: width and height of the target as it is known, px; the crop is 255/127 times
                as large as the template's would be.

        Returns:
            The target's probability at each place, (n, n) float32 in 0..1, rows first; and the
            boxes seen from there, (4, n, n) float32, x, y, w, h in px of the image.
        """
        side = crop_side(*size) * SEARCH / TEMPLATE
        self._crop = centre, side / SEARCH
        score, sides = self._maps(crop(image, centre, side, SEARCH))
        return score, placed(sides, centre, side / SEARCH)

    def resemblance(self) -> Resemblance:
        """How much the places of the last search crop are like the template."""
        centre, step = self._crop
        return Resemblance(middle_of(self._template[0]), self._seen[0], centre, STRIDE * step)

    def _features(self, pixels: Image) -> Floats:
        self._backbone.setInput(cv2.dnn.blobFromImage(pixels))
        return np.array(self._backbone.forward(), np.float32)  # the net uses its buffer again

    def _maps(self, pixels: Image) -> tuple[Floats, Floats]:
        """Probabilities (n, n) and distances (4, n, n), px of the search crop."""
        self._head.setInput(self._template, "input1")
        self._seen = self._features(pixels)
        self._head.setInput(self._seen, "input2")
        outputs = [np.asarray(out[0]) for out in self._head.forward(self._outputs)]
        classes = next(out for out in outputs if len(out) == 2)
        sides = next(out for out in outputs if len(out) == 4)
        return probability(classes), sides


def _net(file: Path) -> Any:
    try:
        return cv2.dnn.readNet(str(file))
    except cv2.error as error:
        raise ValueError(
            f"{file} cannot be read as an ONNX network by OpenCV {cv2.__version__}; "
            "NanoTrack needs 4.7 or newer"
        ) from error


def crop_side(w: float, h: float) -> float:
    """Side of the template's crop, px: the geometric mean of the sides with their context."""
    context = CONTEXT * (w + h)
    return float(np.sqrt((w + context) * (h + context)))


def crop(image: Image, centre: tuple[float, float], side: float, out: int) -> Image:
    """Cut a square and scale it; beyond the image is its mean colour.

    Args:
        image: (H, W, 3) uint8.
        centre: x, y of the square, px from the corner of the first pixel.
        side: of the square, px.
        out: side of the result, px.

    Returns:
        (out, out, 3) uint8.
    """
    (x, y), half = centre, side / 2
    height, width = image.shape[:2]
    inside = x >= half and y >= half and x + half <= width and y + half <= height
    step = side / out
    first = step / 2 - half - 0.5  # the first pixel's middle; pixels lie at whole numbers
    source = np.array([[step, 0, x + first], [0, step, y + first]])
    return np.asarray(
        cv2.warpAffine(
            image,
            source,
            (out, out),
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE if inside else cv2.BORDER_CONSTANT,
            borderValue=(0.0,) * 4 if inside else cv2.mean(image),
        ),
        np.uint8,
    )


def probability(classes: Floats) -> Floats:
    """Softmax of (2, n, n) class scores, of which the second is the target's: (n, n)."""
    apart = np.clip(classes[0] - classes[1], -80, 80)
    return np.asarray(1 / (1 + np.exp(apart)), np.float32)


def placed(sides: Floats, centre: tuple[float, float], step: float) -> Floats:
    """Boxes in the image from distances in the search crop.

    Args:
        sides: (4, n, n) distances of left, top, right and bottom from each point, px of the crop.
        centre: x, y of the crop in the image, px.
        step: px of the image in one of the crop.

    Returns:
        (4, n, n) float32 x, y, w, h, px.
    """
    left, top, right, bottom = sides
    n = sides.shape[1]
    points = (np.arange(n, dtype=np.float32) - n // 2) * STRIDE
    x = centre[0] + step * (points - left)
    y = centre[1] + step * (points[:, None] - top)
    return np.stack([x, y, step * (left + right), step * (top + bottom)]).astype(np.float32)
