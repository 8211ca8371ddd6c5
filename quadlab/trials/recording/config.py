"""How a trial is logged."""

from typing import Annotated

from pydantic import Field

from quadlab.configuration import Positive, StrictModel


class LogConfig(StrictModel):
    """What goes into ``trial.mcap``; none of it changes what happens in the trial.

    Attributes:
        scene_rate_hz: rate of everything that is only drawn, in simulated [1/s]; scalars have the control rate.
        chunk_size_kib: amount of log in [KiB] that is compressed and written together; a killed trial loses at most
            one chunk and what came after the last drawing, smaller chunks compress less.
        wall_times: whether computing times are logged (/timing and the plan's report); without them equal records
            and attachments give the same file, byte for byte.
    """

    scene_rate_hz: Positive
    chunk_size_kib: Annotated[int, Field(ge=1, le=16384)]
    wall_times: bool
