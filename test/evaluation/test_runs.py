# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from functools import partial

import numpy as np
import pytest

pytest.importorskip("joblib", reason="running trackers needs the extra `evaluate`")

from het_ros.evaluation import jobs, runs
from het_ros.evaluation.cache import Cache
from het_ros.evaluation.runs import Plan, carry_out_plan
from het_ros.evaluation.trackers import Identity, tracker_spec

from .doubles import spec, write_sequence


class Jitter(Identity):
    """Moves its box at random, by its seed."""

    def __init__(self, seed):
        self.draw = np.random.default_rng(seed)

    def init(self, image, box):
        self._box = box.as_tuple()

    def update(self, image, dt):
        x, y, w, h = self._box
        self._box = (x + self.draw.normal(), y, w, h)
        return super().update(image, dt)


class Aborts(Identity):
    """Dies as native code dies, on the sequence whose images are 32 px high."""

    def update(self, image, dt):
        if image.shape[0] == 32:
            os.abort()
        return super().update(image, dt)


def build(kind, seed):
    return kind(seed) if kind is Jitter else kind()


JITTER = spec("jitter", partial(build, Jitter), random=True)
STILL = spec("still", partial(build, Identity))
ABORTS = spec("aborts", partial(build, Aborts))


@pytest.fixture
def two(tmp_path):
    boxes = [(5 + 3 * i, 10, 10, 12) for i in range(8)]
    return [
        write_sequence(tmp_path / "one", boxes),
        write_sequence(tmp_path / "two", boxes, image=(32, 64)),
    ]


def tracks(found):
    return {(r.tracker, r.sequence, r.seed, r.variant): r.track for r in found}


def same(a, b):
    return a.keys() == b.keys() and all(np.array_equal(a[k].boxes, b[k].boxes) for k in a)


def test_random_trackers_run_with_every_seed_and_others_once(two, tmp_path):
    found = carry_out_plan(Plan([JITTER, STILL], two, seeds=3), Cache(tmp_path / "c"), quiet=True)
    assert len(found) == 2 * (3 + 1)
    by = tracks(found)
    boxes = [by["jitter", "one", seed, "ope"].boxes for seed in range(3)]
    assert not np.array_equal(boxes[0], boxes[1])
    assert not np.array_equal(boxes[1], boxes[2])


def test_results_do_not_depend_on_the_number_of_processes(two, tmp_path):
    plan = Plan([JITTER, tracker_spec("het")], two, seeds=2)
    alone = carry_out_plan(plan, Cache(tmp_path / "a"), workers=1, quiet=True)
    both = carry_out_plan(plan, Cache(tmp_path / "b"), workers=2, quiet=True)
    assert same(tracks(alone), tracks(both))


def test_a_crash_in_native_code_is_a_recorded_failure_of_its_run_only(two, tmp_path):
    found = carry_out_plan(Plan([STILL, ABORTS], two), Cache(tmp_path / "c"), quiet=True)
    by = tracks(found)
    assert len(by) == 4
    dead = by.pop(("aborts", "two", 0, "ope"))
    assert "the process died" in dead.error
    assert dead.boxes.tolist() == [list(two[1].truth[0])] * 8
    assert all(track.error == "" for track in by.values())


class Unbuilt(Identity):
    """Needs what is not there."""

    def __init__(self):
        raise OSError("no weights")


def test_a_tracker_that_cannot_be_built_fails_on_record(two, tmp_path):
    broken = spec("unbuilt", partial(build, Unbuilt))
    found = carry_out_plan(Plan([broken, STILL], two[:1]), Cache(tmp_path / "c"), quiet=True)
    assert [run.track.error for run in found] == ["it cannot be built: OSError: no weights", ""]
    np.testing.assert_array_equal(found[0].track.boxes, found[1].track.boxes)


def test_what_was_run_is_not_run_again(two, tmp_path, monkeypatch):
    cache = Cache(tmp_path / "c")
    first = carry_out_plan(Plan([JITTER], two, seeds=2), cache, quiet=True)
    ran = []

    def recorded(todo, *arguments):
        ran.extend(todo)
        return jobs.carry_out(todo, *arguments)

    monkeypatch.setattr(runs, "carry_out", recorded)
    again = carry_out_plan(Plan([JITTER], two, seeds=2), cache, quiet=True)
    assert ran == []
    assert same(tracks(first), tracks(again))
    carry_out_plan(Plan([JITTER], two, seeds=3), cache, quiet=True)
    assert [(job.sequence, job.seed) for job in ran] == [("one", 2), ("two", 2)]
    ran.clear()
    changed = spec("jitter", JITTER.build, random=True)
    changed = type(changed)(**{**vars(changed), "fingerprint": "another configuration"})
    carry_out_plan(Plan([changed], two), cache, quiet=True)
    assert len(ran) == 2


@pytest.mark.filterwarnings("ignore:.*tasks which were still being processed")
def test_an_interrupted_run_goes_on_where_it_stopped(two, tmp_path, monkeypatch):
    cache = Cache(tmp_path / "c")
    plan = Plan([JITTER], two, seeds=3)

    def interrupted(todo, *arguments):
        for count, result in enumerate(jobs.carry_out(todo, *arguments)):
            if count == 4:
                raise KeyboardInterrupt
            yield result

    monkeypatch.setattr(runs, "carry_out", interrupted)
    with pytest.raises(KeyboardInterrupt):
        carry_out_plan(plan, cache, quiet=True)
    left = []

    def counted(todo, *arguments):
        left.extend(todo)
        return jobs.carry_out(todo, *arguments)

    monkeypatch.setattr(runs, "carry_out", counted)
    resumed = carry_out_plan(plan, cache, quiet=True)
    assert len(left) == 2
    monkeypatch.undo()
    whole = carry_out_plan(plan, Cache(tmp_path / "other"), quiet=True)
    assert same(tracks(resumed), tracks(whole))


def test_a_broken_file_in_the_cache_is_run_again(two, tmp_path):
    cache = Cache(tmp_path / "c")
    first = carry_out_plan(Plan([JITTER], two), cache, quiet=True)
    for file in (tmp_path / "c").rglob("*.npz"):
        file.write_bytes(file.read_bytes()[:50])
    assert same(tracks(first), tracks(carry_out_plan(Plan([JITTER], two), cache, quiet=True)))


def test_a_result_from_before_a_field_was_recorded_is_run_again(two, tmp_path):
    plan, cache = Plan([tracker_spec("het")], two[:1]), Cache(tmp_path / "c")
    first = carry_out_plan(plan, cache, quiet=True)
    (file,) = (tmp_path / "c").rglob("*.npz")
    with np.load(file) as saved:
        older = {name: saved[name] for name in saved.files if name != "velocity_covariances"}
    np.savez_compressed(file, **older)
    again = carry_out_plan(plan, cache, quiet=True)
    assert same(tracks(first), tracks(again))
    assert np.isfinite(again[0].track.velocity_covariances[1:]).all()
    with np.load(file) as saved:
        assert "velocity_covariances" in saved.files


def test_the_cache_keeps_every_field(two, tmp_path):
    cache = Cache(tmp_path / "c")
    (found,) = carry_out_plan(Plan([tracker_spec("het")], two[:1]), cache, quiet=True)
    (file,) = (tmp_path / "c").rglob("*.npz")
    kept = cache.load(str(file.relative_to(tmp_path / "c").with_suffix("")))
    for name, value in vars(found.track).items():
        np.testing.assert_array_equal(getattr(kept, name), value)


def test_a_worker_with_another_source_of_the_tracker_refuses(two):
    het = tracker_spec("het")
    other = type(het)(**{**vars(het), "source": "another"})
    ((job, _), *_) = Plan([other], two).jobs()
    with pytest.raises(jobs.SourceChangedError, match="start it again"):
        jobs.run_job(job)


@pytest.fixture
def cluster():
    distributed = pytest.importorskip(
        "dask.distributed", reason="clusters need the extra `cluster`"
    )
    workers = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**workers) as started:
        yield started


def test_a_dask_cluster_gives_the_same_results(two, tmp_path, cluster):
    plan = Plan([tracker_spec("het"), tracker_spec("identity")], two, seeds=2)
    here = carry_out_plan(plan, Cache(tmp_path / "a"), quiet=True)
    cache = Cache(tmp_path / "b")
    there = carry_out_plan(plan, cache, scheduler=cluster.scheduler_address, quiet=True)
    assert same(tracks(here), tracks(there))


def test_a_crash_on_a_cluster_is_a_recorded_failure_too(two, tmp_path, cluster):
    cache = Cache(tmp_path / "c")
    plan = Plan([STILL, ABORTS], two)
    found = carry_out_plan(plan, cache, scheduler=cluster.scheduler_address, quiet=True)
    errors = {(r.tracker, r.sequence): r.track.error for r in found}
    assert len(errors) == 4
    assert "the process died" in errors.pop(("aborts", "two"))
    assert set(errors.values()) == {""}


def test_a_cluster_without_het_ros_is_told_so(two, tmp_path, cluster, monkeypatch):
    def broken():
        return "No module named 'het_ros'"

    broken.__module__ = "__main__"
    monkeypatch.setattr("het_ros.evaluation.cluster._import_error", broken)
    with pytest.raises(ValueError, match=r"of the cluster cannot import het_ros \(No module"):
        carry_out_plan(
            Plan([STILL], two), Cache(tmp_path), scheduler=cluster.scheduler_address, quiet=True
        )


def test_a_scheduler_that_is_not_there_is_an_error(two, tmp_path, monkeypatch):
    pytest.importorskip("dask.distributed", reason="clusters need the extra `cluster`")
    monkeypatch.setattr("het_ros.evaluation.cluster.PATIENCE", 1)
    with pytest.raises(ValueError, match=r"no Dask scheduler answers at tcp://127.0.0.1:1"):
        carry_out_plan(
            Plan([STILL], two), Cache(tmp_path), scheduler="tcp://127.0.0.1:1", quiet=True
        )
