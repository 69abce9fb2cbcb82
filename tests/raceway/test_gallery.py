"""The page of the gallery, of a small corpus in place of its own."""

import shutil

from raceway.studies import gallery


def test_the_page_starts_with_the_faults_and_ends_with_the_seed_paper(tmp_path, told, tiny_corpus, monkeypatch):
    monkeypatch.setattr(gallery, "generate", lambda _, folder, progress: shutil.copytree(tiny_corpus, folder))  # noqa: ARG005
    monkeypatch.setattr(gallery, "draw_waterfall", lambda *_: None)
    monkeypatch.setattr(gallery, "draw_orbits", lambda: None)
    monkeypatch.setattr(gallery, "write_sensor_fault_pictures", lambda _: ["sensor-loose-mount.png"])
    monkeypatch.setattr(gallery, "write_paper_page", lambda folder: (folder / "ophel2025.html").touch())
    monkeypatch.setattr(gallery, "picture", lambda *_: b"picture")
    found = told("reproduce", "gallery", "-o", tmp_path / "gallery")
    page = (tmp_path / "gallery" / "index.html").read_text()
    names = [path.rpartition("/")[2] for path in found["pictures"]]
    assert names[0] == "envelopes.png"
    assert {"run-up-inner.png", "orbits.png"} <= set(names)
    assert [name for name in names if f'src="{name}"' not in page] == []
    assert page.index('href="ophel2025.html"') > max(page.index(name) for name in names)
    assert (tmp_path / "gallery" / "ophel2025.html").exists()
