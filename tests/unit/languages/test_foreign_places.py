"""Where a model says that its metamodel lies may be anything."""

import pytest

from mmrs_core.languages.foreign import read_any
from mmrs_core.languages.registry import core_registry


@pytest.mark.parametrize("place", ["9" * 400 + ".ecore", "%00.ecore", "../../gone.ecore", "/etc/x.ecore"])
def test_a_place_where_no_metamodel_can_lie_is_passed_over(tmp_path, place):
    file = tmp_path / "kite.xmi"
    file.write_text(
        '<k:Kite xmlns:k="urn:kites:1.0" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        f' xsi:schemaLocation="urn:kites:1.0 {place}"/>'
    )
    found = read_any(file, core_registry())
    assert found.found == ()
    assert [fault.code for fault in found.model.diagnostics] == ["XMI001"]
