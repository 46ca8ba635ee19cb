"""A hash is that of the bytes."""

from fatigue.files.hashes import sha256


def test_published_digest(tmp_path):
    """SHA-256 of ``abc``, FIPS 180-4; a path may be text."""
    (tmp_path / "f").write_bytes(b"abc")
    assert sha256(tmp_path / "f") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert sha256(str(tmp_path / "f")) == sha256(tmp_path / "f")
