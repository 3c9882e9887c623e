# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import signal
import subprocess
import sys
import threading

import pytest
from graph import PATIENCE

from het_ros.ros.start import ended_by_ctrl_c

CTRL_C_IN_THE_IMPORT_OF = """
import os, signal, sys

class Finder:
    def find_spec(name, path=None, target=None):
        if name.startswith({name!r}):
            print("there", flush=True)
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Finder)
from het_ros.ros.tracker import main
main([])
"""


@pytest.mark.parametrize("name", ["cv2.", "het_ros.ros.tracker_node"])
def test_ctrl_c_while_it_still_imports_ends_the_tracker(name):
    ended = subprocess.run(
        [sys.executable, "-c", CTRL_C_IN_THE_IMPORT_OF.format(name=name)],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert ended.stdout == "there\n"
    assert ended.returncode == -signal.SIGINT
    assert "Traceback" not in ended.stderr


def test_ctrl_c_is_python_s_own_again_afterwards():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ImportError), ended_by_ctrl_c():
        assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL
        raise ImportError
    assert signal.getsignal(signal.SIGINT) is before


def test_another_thread_leaves_signals_alone():
    seen = []

    def look():
        with ended_by_ctrl_c():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGINT)]
