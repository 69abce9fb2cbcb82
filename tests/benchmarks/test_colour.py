"""The benchmark of colour: every recording is compared with another healthy one, and a change of gain is none."""

from benchmarks.colour import distances


def test_recordings_are_compared_with_another_healthy_one(tiny_corpus):
    found = distances(tiny_corpus)
    assert {fault: len(values) for fault, values in found.items()} == {
        "healthy": 12, "inner": 12, "outer": 12, "ball": 12
    }  # fmt: skip
    assert min(map(min, found.values())) > 0
