"""Processes killed at random moments, so that a test can look at what they leave behind."""

import os
import signal
import time
import traceback
import warnings

import numpy as np


def killed(action, moments, seed=0):
    """Run ``action`` in a child process once to its end, then ``moments`` times until a random moment, at which it is killed (SIGKILL).

    Yields after every run, the undisturbed first one included: ``moments + 1`` times. Between two yields the caller looks at what is
    left and removes it, so that the next run begins as the first did:

        for _ in killed(lambda: raceway.copy(corpus, file), moments=5):
            if file.exists():
                assert validate_corpus(file) == []
                file.unlink()

    The child is a fork of this warm process, so nothing is loaded or compiled again; its own children are killed with it.
    """
    begun = time.monotonic()
    child = _forked(action)
    status = os.waitpid(child, 0)[1]
    assert os.waitstatus_to_exitcode(status) == 0, "the action failed before anything was killed"
    duration = time.monotonic() - begun
    yield
    for share in np.random.default_rng(seed).uniform(0, 1, moments):
        child = _forked(action)
        time.sleep(share * duration)
        os.killpg(child, signal.SIGKILL)
        os.waitpid(child, 0)
        _wait_for_group(child)
        yield


def _wait_for_group(group):
    """Wait until the killed children of a child have ended too, which may hold its locks; at most a second."""
    for _ in range(100):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.01)


def _forked(action):
    """Process number of a child that runs ``action``, the leader of its own group of processes."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.12 warns of fork with threads
        child = os.fork()
    if child:
        os.setpgid(child, child)
        return child
    code = 1
    try:
        os.setpgid(0, 0)
        action()
        code = 0
    except BaseException:  # noqa: BLE001 - the child must not return into the test run
        traceback.print_exc()
    finally:
        os._exit(code)
