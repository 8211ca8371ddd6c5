"""Hints that a person can read."""

from quadlab.trials.problems import suggestion


def test_nearest_name_and_what_exists() -> None:
    assert suggestion("trto", ["walk", "trot"]) == "did you mean 'trot'?; known: trot, walk"
    assert suggestion("zzz", []) == "known: none"


def test_of_many_names_the_first_are_shown_and_the_nearest_is_found() -> None:
    shown = suggestion("key_299x", [f"key_{number}" for number in range(300)])
    assert shown.startswith("did you mean 'key_299'?; known: key_0, key_1, ")
    assert shown.endswith(" and 275 more")
    assert len(shown) < 300
