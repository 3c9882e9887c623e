# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Installed by colcon as an ament_python package; ``pip install .`` works as well.

Name, version, description, people, license and addresses are those of package.xml: colcon and
bloom read them there.
"""

import runpy
import sys
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

ROOT = Path(__file__).parent
PACKAGE = ElementTree.parse(ROOT / "package.xml").getroot()
NAME = PACKAGE.findtext("name")
COMMANDS = runpy.run_path(str(ROOT / NAME / "commands.py"))["COMMANDS"]
# colcon and Debian's builds run `setup.py install` or `develop`, pip does not. `ros2 run` takes
# plain names; on a pip user's PATH they carry the package's.
PREFIX = "" if {"install", "develop"} & set(sys.argv) else f"{NAME}_"

# What scoring, tables and pictures of `evaluate` and `bench` need beside a cv2.
SCORING = [
    "joblib>=1.4",
    "threadpoolctl>=3.0",
    "jinja2>=3.0",
    "pyyaml>=5.4",
    "tqdm>=4.60",
    "matplotlib>=3.5",
    "av>=10",
]

# Real robots take ROS and OpenCV from apt (package.xml); `make` takes them from PyPI.
EXTRAS = {
    # ROS 2 Jazzy itself, for machines without apt's.
    "ros": [
        "ros-jazzy-rclpy>=7.1,<8",
        "ros-jazzy-common-interfaces>=5.3,<6",
        "ros-jazzy-rmw-fastrtps-cpp>=8.4,<9",
        "threadpoolctl>=3.0",
    ],
    # One cv2 package an environment: this one, or the contrib one of `evaluate`.
    "opencv": ["opencv-python-headless>=4.6"],
    # Reading, writing, playing and drawing bags.
    "bags": ["rosbags>=0.10,<0.12", "tqdm>=4.60", "matplotlib>=3.5", "av>=10"],
    # Comparison with OpenCV's trackers, in an environment of its own.
    "evaluate": ["opencv-contrib-python-headless>=4.6", *SCORING],
    # Harnesses of the field, in an environment of its own: one brings another cv2 package.
    "harnesses": [
        "got10k>=0.1.3",
        "vot-toolkit>=0.9,<0.10",
        "vot-trax>=4,<5",
        "attributee<0.1.10",  # vot-toolkit 0.9 breaks with newer ones on Python 3.11
        *SCORING,
    ],
    # The page on which a target is picked; segno draws its address as a QR code.
    "operator": ["aiohttp>=3.8", "jsonschema>=4.10", "segno>=1.4"],
    # Fitting the constants of `make fit`.
    "fit": ["scikit-learn>=1.3", *SCORING],
    # Scoring on a Dask cluster.
    "cluster": ["distributed>=2023.1"],
    # colcon still needs `setup.py develop`, which setuptools 80 took away.
    "build": ["colcon-common-extensions>=0.3", "setuptools>=65,<80"],
    "test": [
        "pytest>=8",
        "pytest-xdist>=3",  # the tests without ROS on all processors
        "hypothesis>=6.80",
        "ruff>=0.6",
        "mypy>=1.10",
        "import-linter>=2.0",
        "catkin-pkg>=1.0",
        "rosdep>=0.22",
        "distributed>=2023.1",
        "onnx>=1.16",  # writes a tiny network
        "playwright>=1.40",  # drives the system's Chromium; brings none
        *SCORING,
    ],
}

MAINTAINER = PACKAGE.find("maintainer")


def _files(folder: str) -> list[str]:
    """Files of one folder, relative to the package, as setuptools wants them."""
    return sorted(str(p.relative_to(ROOT)) for p in (ROOT / folder).glob("*.*") if p.is_file())


setup(
    name=NAME,
    version=PACKAGE.findtext("version"),
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={
        NAME: ["py.typed", "evaluation/*.csv", "evaluation/templates/*", "operator/static/*"]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/config", _files("config")),
        (f"share/{NAME}/launch", _files("launch")),
    ],
    python_requires=">=3.10",
    install_requires=["numpy>=1.26", "filterpy>=1.4.5"],
    extras_require=EXTRAS,
    zip_safe=True,
    author=MAINTAINER.text,
    author_email=MAINTAINER.get("email"),
    maintainer=MAINTAINER.text,
    maintainer_email=MAINTAINER.get("email"),
    description=" ".join(PACKAGE.findtext("description").split()),
    license=PACKAGE.findtext("license"),
    project_urls={url.get("type"): url.text for url in PACKAGE.findall("url")},
    entry_points={
        "console_scripts": [f"{PREFIX}{name} = {NAME}.commands:{name}" for name in COMMANDS]
    },
)
