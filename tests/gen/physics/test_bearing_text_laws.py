"""Laws of bearings given as text: by designation, by dimensions, and by the fault orders that makers print."""

import pytest

from gen.physics.bearing import FaultOrders, orders
from gen.physics.bearing_text import bearing_from_text
from gen.physics.catalogue import CATALOGUE
from gen.support.errors import CorpusError
from tests.cases import for_each

every_bearing = for_each(CATALOGUE.values(), lambda bearing: bearing.designation)


def printed(of: FaultOrders) -> str:
    """Orders as a table of a maker prints them."""
    return ",".join(f"{name}={order:.3f}" for name, order in of._asdict().items())


@every_bearing
def test_printed_orders_of_any_bearing_are_taken_as_they_are(bearing):
    exact = orders(bearing)
    taken = bearing_from_text(printed(exact))
    assert taken.n_balls == bearing.n_balls
    assert orders(taken) == tuple(round(order, 3) for order in exact)


@every_bearing
def test_orders_of_no_bearing_are_refused_with_the_one_that_is_wrong(bearing):
    exact = orders(bearing)
    for wrong, said in (
        (exact._replace(bsf=2 * exact.bsf), "2 BSF"),
        (exact._replace(bpfo=exact.bpfi, bpfi=exact.bpfo), "ftf is not bpfo"),
        (exact._replace(ftf=0.9 * exact.ftf), "ftf is not bpfo"),
        (exact._replace(bpfi=exact.bpfi + 0.4), "no number of balls"),
    ):
        with pytest.raises(CorpusError, match=said):
            bearing_from_text(printed(wrong))


@pytest.mark.parametrize("text", ["NU 205", "nu205", "SKF NU 205 ECP", "N U 205-C3"])
def test_spaces_maker_and_suffixes_do_not_hide_a_designation(text):
    assert bearing_from_text(text) is CATALOGUE["NU205"]


def test_a_bearing_that_the_catalogue_lacks_can_be_given_in_two_other_ways():
    with pytest.raises(CorpusError, match=r"n_balls=.*bpfo="):
        bearing_from_text("22220 E")
