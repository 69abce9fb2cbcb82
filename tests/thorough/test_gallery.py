"""The gallery, written once."""

from gen.corpus import check_result_folder


def test_the_gallery_shows_every_fault_the_run_ups_and_the_seed_paper(tmp_path, told):
    found = told("reproduce", "gallery", "-o", tmp_path / "gallery")
    check_result_folder(tmp_path / "gallery")  # which may be written again
    page = (tmp_path / "gallery" / "index.html").read_text()
    names = [path.rpartition("/")[2] for path in found["pictures"]]
    assert names[0] == "envelopes.png"
    assert {"run-up-inner.png", "run-up-ball.png", "orbits.png", "sensor-loose-mount.png"} <= set(names)
    for name in names:
        assert f'src="{name}"' in page
        assert (tmp_path / "gallery" / name).read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "gallery" / "ophel2025.html").exists()
