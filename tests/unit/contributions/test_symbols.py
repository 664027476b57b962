"""Symbols are found by metaclass, and only those that maps can show are made."""

import pytest

from mmrs_core.contributions.symbols import MapSymbol, has_symbol, symbol_of

MOORING, BUOY = ("urn:test:sea:1.0", "MooringBuoy"), ("urn:test:sea:1.0", "Buoy")
OF_MOORING, OF_BUOY = MapSymbol(MOORING, "mooring", "#aa0000", "M"), MapSymbol(BUOY, "buoy", "#00aa00", "B")


def test_the_most_specific_symbol_counts():
    both = {BUOY: OF_BUOY, MOORING: OF_MOORING}
    assert symbol_of((MOORING, BUOY), both) == OF_MOORING
    assert symbol_of((BUOY,), both) == OF_BUOY


def test_the_symbol_of_a_general_metaclass_serves_special_ones():
    assert symbol_of((MOORING, BUOY), {BUOY: OF_BUOY}) == OF_BUOY


def test_what_nobody_knows_is_called_by_its_metaclass_and_has_no_icon():
    found = symbol_of((MOORING, BUOY), {})
    assert (found.label, found.icon) == ("mooring buoy", "")
    assert not has_symbol((MOORING, BUOY), {})


@pytest.mark.parametrize("colour", ["red", "#12345", "#1234567", "#12345g", "url(#forbidden)"])
def test_a_colour_that_is_none_is_refused(colour):
    with pytest.raises(ValueError, match="written #rrggbb"):
        MapSymbol(BUOY, "buoy", colour, "B")


def test_an_icon_of_three_characters_is_refused():
    with pytest.raises(ValueError, match="two characters at most"):
        MapSymbol(BUOY, "buoy", "#00aa00", "buo")
