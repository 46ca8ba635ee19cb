"""Groups of welds: cut by their stations, their forces opened once."""

import numpy as np

from fatigue.case import load_case
from fatigue.pipeline.solve import weld_groups as module
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import read_model, solve_group
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.small_case import small_case
from tests.test_assess import element_form, write_element_form


def test_element_forces_are_read_once_for_all_groups(tmp_path, monkeypatch):
    """The file of all elements is read when the groups are opened; each group then has the stress of its welds."""
    case = small_case(pairs=4)
    path = write_element_form(case, tmp_path, *element_form(case))
    whole = read_model(load_case(path), strict=False)
    reads = []
    read = module.read_element_forces
    monkeypatch.setattr(module, "read_element_forces", lambda *given, **named: reads.append(1) or read(*given, **named))
    groups = weld_groups(read_body(load_case(path), strict=False), tmp_path / "scratch")
    assert len(groups) > 1
    solved = [solve_group(groups, number) for number in range(len(groups))]
    assert len(reads) == 1
    np.testing.assert_allclose(
        np.concatenate([m.stations.treated.membrane for m in solved]), whole.stations.treated.membrane, rtol=1e-12
    )
