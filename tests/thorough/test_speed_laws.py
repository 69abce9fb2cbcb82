"""False alarms of the estimated shaft speed over recordings of several windows."""

from tests.features.table.test_speed_laws import clear_in_noise


def test_noise_of_eight_windows_is_clear_in_less_than_one_per_cent():
    assert clear_in_noise(8) <= 2
