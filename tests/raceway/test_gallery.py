"""The gallery, written once."""


def test_the_gallery_shows_the_paper_every_fault_and_the_run_ups(tmp_path, told):
    found = told("gallery", "-o", tmp_path / "gallery")
    page = (tmp_path / "gallery" / "index.html").read_text()
    names = [path.rpartition("/")[2] for path in found["pictures"]]
    assert {
        "figure3.png",
        "figure6.png",
        "envelopes.png",
        "run-up-inner.png",
        "run-up-ball.png",
        "sensor-loose-mount.png",
    } <= set(names)
    for name in names:
        assert f'src="{name}"' in page
        assert (tmp_path / "gallery" / name).read_bytes().startswith(b"\x89PNG")
    assert "3 BPFI" in page  # why a statement of the paper does not hold
