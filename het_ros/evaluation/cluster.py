# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster for joblib, checked before jobs are sent to it."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator
from typing import Any

import joblib

PATIENCE = 60  # for the first worker, s


@contextlib.contextmanager
def connected(scheduler: str) -> Iterator[None]:
    """Send joblib's tasks to the workers of a Dask scheduler, "tcp://host:8786".

    Raises:
        ValueError: Dask is not installed here, nobody answers, there is no worker, or het_ros is
            missing there. Left to Dask, most of these would wait for ever.
    """
    try:
        distributed: Any = importlib.import_module("dask.distributed")
    except ImportError:
        raise ValueError("--scheduler needs Dask: pip install distributed") from None
    try:
        client = distributed.Client(scheduler, timeout=PATIENCE)
    except (OSError, TimeoutError, ValueError) as error:
        raise ValueError(f"no Dask scheduler answers at {scheduler}: {error}") from None
    with client:
        _check(client, scheduler)
        with joblib.parallel_config("dask"):
            yield


def _check(client: Any, scheduler: str) -> None:
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except Exception as error:
        raise ValueError(
            f"{scheduler} has no worker: dask worker {scheduler} --nthreads 1 ({error})"
        ) from None
    missing = {
        **client.run(_import_error),
        "the scheduler": client.run_on_scheduler(_import_error),
    }
    for place, reason in missing.items():
        if reason:
            raise ValueError(
                f"{place} of the cluster cannot import het_ros ({reason}): install it there, with "
                "its extras evaluate and cluster, or start Dask where it is installed"
            )


def _import_error() -> str:
    """What keeps this process from running jobs, or ""."""
    import importlib

    try:
        importlib.import_module("het_ros.evaluation.jobs")
    except ImportError as error:
        return str(error)
    return ""


# Sent by value, as functions of a script are: where het_ros is missing, a reference to it could
# not be read, and that is what is to be found out.
_import_error.__module__ = "__main__"
