"""The gallery, written once."""

from gen.corpus import check_result_folder


def test_the_gallery_shows_the_paper_every_fault_and_the_run_ups(tmp_path, told):
    found = told("reproduce", "gallery", "-o", tmp_path / "gallery")
    check_result_folder(tmp_path / "gallery")  # which may be written again
    page = (tmp_path / "gallery" / "index.html").read_text()
    names = [path.rpartition("/")[2] for path in found["pictures"]]
    assert names[:6] == [f"figure{number}.png" for number in (1, 2, 3, 5, 4, 6)]  # system, healthy, cracked
    assert {"envelopes.png", "run-up-inner.png", "run-up-ball.png", "orbits.png", "sensor-loose-mount.png"} <= set(
        names
    )
    for name in names:
        assert f'src="{name}"' in page
        assert (tmp_path / "gallery" / name).read_bytes().startswith(b"\x89PNG")
    assert page.index(">Ophel et al., cracked<") < page.index("figure4.png") < page.index("figure6.png")
    assert "3 BPFI" in page  # why a statement of the paper does not hold
    assert "shaft_rate 44.66 -&gt; 43 Hz" in page  # and the change with which it holds
