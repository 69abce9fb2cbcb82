"""Pictures of sensor faults: one for each, and each shows its fault beside the clean record."""

from raceway.studies.sensor_faults import VIEWS, write_sensor_fault_pictures
from tests.sensor_faults import SENSOR_FAULTS


def test_every_sensor_fault_and_the_gear_have_a_picture_of_their_own(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr("raceway.studies.sensor_faults.draw_beside", lambda *given: drawn.append(given))
    monkeypatch.setattr("raceway.studies.sensor_faults.picture", lambda *_: b"")
    names = write_sensor_fault_pictures(tmp_path)
    assert set(VIEWS) == {*SENSOR_FAULTS, "gear_mesh"}
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    assert len(names) == len(VIEWS)
    for clean, shown, _, view in drawn:
        assert clean.shape == shown.shape
        assert (clean != shown).any(), f"the picture {view.title} shows no fault"
