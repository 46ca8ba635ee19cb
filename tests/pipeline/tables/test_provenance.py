"""Where every number comes from."""

import hashlib
import json


def record(folder):
    """Provenance of a result."""
    return json.loads((folder / "provenance.json").read_text())


def test_inputs_are_traceable(small_result):
    """Every input with its hash; the case text as it was; the way back to the case file."""
    found = record(small_result)
    case = small_result / found["case_path"]
    assert case.read_text() == found["case_text"]
    assert {i["file"] for i in found["inputs"]} == {
        "case.toml", "modes.csv", "welds.csv", "weld_nodes.csv", "nodal_forces.csv", "sine.csv", "noise.csv", "load.csv"
    }  # fmt: skip
    for entry in found["inputs"]:
        content = (case.parent / entry["file"]).read_bytes()
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()
        assert entry["bytes"] == len(content)


def test_rules_are_told(small_result):
    """Curve with source, thickness rule, residue of each event, spectrum, mission, warnings, versions."""
    found = record(small_result)
    assert "ASME" in found["curves"]["master-aluminium"]["source"]
    assert found["rules"]["thickness_rule"] == "actual"
    assert found["rules"]["residue"]["load and unload"].startswith("a single pass")
    assert found["rules"]["residue"]["sine"].startswith("the record recurs")
    assert [e["event"] for e in found["mission"]["events"]] == ["sine", "noise", "load and unload"]
    assert {"code", "where", "what", "remedy", "count"} == set(found["warnings"][0])
    assert found["software"]["fatigue"]
    assert found["modes"]["used"] == [1, 2, 7]
