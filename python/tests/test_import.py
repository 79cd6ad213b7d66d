"""The package is found, and says which one it is."""

import continuo


def test_version() -> None:
    assert continuo.__version__.count(".") == 2
