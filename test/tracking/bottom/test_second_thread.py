# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread that is there where it may be, hands answers and errors back, and always ends."""

import copy
import gc
import pickle
import subprocess
import sys
import threading

import pytest

from het_ros.tracking.bottom import second_thread
from het_ros.tracking.bottom.second_thread import SecondThread, processors

PATIENCE = 60  # s: how long something that must happen may take on a busy machine


@pytest.fixture
def two(monkeypatch):
    """Two processors, wherever this runs."""
    monkeypatch.setattr(second_thread, "processors", lambda: 2)


def here():
    return threading.get_ident()


def test_one_thread_answers_all_calls(two):
    thread = SecondThread(True)
    places = {thread.begin(here)() for _ in range(5)}
    assert len(places) == 1
    assert here() not in places
    assert thread.begin(divmod, 7, 2)() == (3, 1)


def test_the_caller_goes_on_meanwhile(two):
    go = threading.Event()
    answer = SecondThread(True).begin(go.wait, PATIENCE)
    go.set()  # it would never be set by a caller who waits
    assert answer() is True


@pytest.mark.parametrize(("allowed", "count"), [(False, 2), (True, 1), (False, 1)])
def test_without_a_second_processor_there_is_no_second_thread(monkeypatch, allowed, count):
    monkeypatch.setattr(second_thread, "processors", lambda: count)
    assert SecondThread(allowed).begin(here)() == here()


@pytest.mark.parametrize("allowed", [True, False])
def test_what_a_call_raises_is_raised_where_its_answer_is_asked_for(two, allowed):
    thread = SecondThread(allowed)
    answer = thread.begin(divmod, 1, 0)
    with pytest.raises(ZeroDivisionError):
        answer()
    assert thread.begin(divmod, 7, 2)() == (3, 1), "and the next call is made"


def test_the_thread_ends_with_its_owner(two):
    thread = SecondThread(True)
    name = thread.begin(threading.current_thread)()
    assert name.is_alive()
    del thread
    gc.collect()
    name.join(PATIENCE)
    assert not name.is_alive()


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_copy_has_a_thread_of_its_own(two, copied):
    thread = SecondThread(True)
    place = thread.begin(here)()
    other = copied(thread)
    assert other.begin(here)() not in (place, here())


@pytest.mark.skipif(not hasattr(second_thread.os, "sched_getaffinity"), reason="Linux has it")
def test_processors_are_those_this_process_may_use():
    code = (
        "import os; from het_ros.tracking.bottom.second_thread import processors\n"
        "os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}); print(processors())"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=PATIENCE)
    assert done.stdout.strip() == b"1"
    assert processors() >= 1


EXIT = """
import threading, time
from het_ros.tracking.bottom import second_thread
second_thread.processors = lambda: 2
thread = second_thread.SecondThread(True)
answer = thread.begin(threading.get_ident)
{more}
"""
FORK = """answer()
import os
if child := os.fork():
    raise SystemExit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
assert thread.begin(divmod, 7, 2)() == (3, 1)
"""


@pytest.mark.parametrize(
    "more",
    ["answer()", "thread.begin(time.sleep, 0.2)", FORK],
    ids=["idle", "at work", "after a fork"],
)
def test_the_interpreter_ends(more):
    code = EXIT.format(more=more)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr.decode()
