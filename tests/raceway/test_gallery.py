"""The page of the gallery, of a small corpus in place of its own."""

import shutil

from raceway.studies import gallery


def test_the_page_shows_every_picture_beside_the_statements_of_the_paper(tmp_path, told, tiny_corpus, monkeypatch):
    monkeypatch.setattr(gallery, "generate", lambda _, folder, progress: shutil.copytree(tiny_corpus, folder))  # noqa: ARG005
    monkeypatch.setattr(gallery, "draw_waterfall", lambda *_: None)
    monkeypatch.setattr(gallery, "draw_orbits", lambda: None)
    monkeypatch.setattr(gallery, "write_sensor_fault_pictures", lambda _: ["sensor-loose-mount.png"])
    monkeypatch.setattr(gallery, "picture", lambda *_: b"picture")
    found = told("reproduce", "gallery", "-o", tmp_path / "gallery")
    page = (tmp_path / "gallery" / "index.html").read_text()
    names = [path.rpartition("/")[2] for path in found["pictures"]]
    assert names[:6] == [f"figure{number}.png" for number in (1, 2, 3, 5, 4, 6)]  # system, healthy, cracked
    assert {"envelopes.png", "run-up-inner.png", "orbits.png"} <= set(names)
    assert [name for name in names if f'src="{name}"' not in page] == []
    assert "3 BPFI" in page  # why a statement of the paper does not hold
