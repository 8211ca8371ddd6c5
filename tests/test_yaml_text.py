"""YAML is read and written by libyaml where it is there, as PyYAML does it alone."""

from typing import Any

import yaml

from quadlab import yaml_text
from quadlab.trials.compose import compose_trial

ODD: dict[str, Any] = {
    "long": "x" * 200,
    "number": "1e3",
    "hook": "${a}",
    "comment": "# b",
    "none": None,
    "float": 1e-9,
}


def test_libyaml_is_used_where_it_is_there() -> None:
    assert (yaml_text.LOADER is not yaml.SafeLoader) == yaml.__with_libyaml__
    assert (yaml_text.DUMPER is not yaml.SafeDumper) == yaml.__with_libyaml__


def test_yaml_is_read() -> None:
    assert yaml_text.load_yaml("a: [1, 2.5, null, true, x]") == {"a": [1, 2.5, None, True, "x"]}


def test_what_is_written_is_the_same_without_libyaml_and_is_read_back() -> None:
    for content in (ODD, compose_trial(["scenario=push"]).model_dump(mode="json")):
        text = yaml_text.dump_yaml(content)
        assert text == yaml.safe_dump(content, sort_keys=False)
        assert yaml_text.load_yaml(text) == content
