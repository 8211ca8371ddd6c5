"""The robots that come with quadlab, for use without the command line: tests, notebooks, scripts."""

import yaml
from pydantic import ValidationError

from quadlab.errors import ConfigurationError, RobotDescriptionError
from quadlab.paths import CONF_DIR
from quadlab.robots.config import RobotConfig

_ROBOTS = CONF_DIR / "robot"


def robot_names() -> tuple[str, ...]:
    """Return the names of the robots in ``conf/robot``."""
    return tuple(sorted(path.stem for path in _ROBOTS.glob("*.yaml")))


def robot_config(name: str) -> RobotConfig:
    """Return the configuration of the robot ``name``.

    Raises:
        RobotDescriptionError: if there is no such robot.
        ConfigurationError: if its file does not describe a robot.
    """
    path = _ROBOTS / f"{name}.yaml"
    if not path.is_file():
        raise RobotDescriptionError(f"unknown robot '{name}'; known: {', '.join(robot_names())}")
    try:
        return RobotConfig.model_validate(yaml.safe_load(path.read_text()))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ConfigurationError(f"conf/robot/{name}.yaml: {where}: {first['msg']}") from error
