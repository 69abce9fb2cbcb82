"""Progress of a long call, for the one who waits for it."""

from collections.abc import Callable

Progress = Callable[[int, int], None]
"""Called with the number of items done, such as records, and with the number of all."""


def counter(progress: Progress | None, total: int) -> Callable[[int], None]:
    """Function that takes the number of items done since its last call, and reports the sum, ``total`` at most and once.

    >>> done = counter(lambda count, total: print(count, "of", total), 8)
    >>> done(3); done(6); done(1)
    3 of 8
    8 of 8
    """
    so_far = 0

    def done(count: int) -> None:
        nonlocal so_far
        before, so_far = so_far, min(so_far + count, total)
        if progress is not None and so_far > before:
            progress(so_far, total)

    return done
