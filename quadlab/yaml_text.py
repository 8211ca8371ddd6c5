"""Reading and writing YAML, with libyaml where PyYAML was built with it: eight times as fast or more."""

from typing import Any

import yaml

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def load_yaml(text: str | bytes) -> Any:
    """Return the content of a YAML document.

    Raises:
        yaml.YAMLError: if it is none.
        ValueError: if a scalar of it cannot be, e.g. the 31st of February.
    """
    return yaml.load(text, Loader=LOADER)


def dump_yaml(content: Any) -> str:
    """Return dictionaries, lists and values as a YAML document; keys keep their order."""
    text: str = yaml.dump(content, Dumper=DUMPER, sort_keys=False)
    return text
