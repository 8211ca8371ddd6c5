"""Settings of pictures and videos."""

from typing import Annotated

from pydantic import Field

from quadlab.configuration import NonNegative, Positive, StrictModel


class ViewConfig(StrictModel):
    """Where the camera stands, relative to the robot and its heading at the start.

    Attributes:
        azimuth_deg: direction from the robot to the camera, counter-clockwise seen from above; 0 is straight ahead.
        elevation_deg: of the camera above the horizon.
        distance_sizes: distance from the robot as a multiple of the robot's size.
        smoothing_s: the camera follows the base averaged over about this time in [s]; 0 follows every motion.
    """

    azimuth_deg: float = -50.0
    elevation_deg: Annotated[float, Field(gt=-90.0, lt=90.0)] = 16.0
    distance_sizes: Positive = 2.4
    smoothing_s: NonNegative = 0.5


class RenderConfig(StrictModel):
    """How a trial is drawn; nothing here changes a result.

    Attributes:
        width: of a frame in pixels, even.
        height: of a frame in pixels, even.
        fps: frames per second of the video in [Hz].
        slow_down: seconds of video per second of the trial.
        snapshots: pictures in the strip.
        strip_columns: pictures side by side in the strip.
        mesh_cell_sizes: vertices of meshes are merged in cells of this edge, as a multiple of the robot's size; 0
            keeps all.
        shadow_pixels: edge of the shadow map; more is sharper and slower.
        samples: per pixel, against jagged edges; 0 for none.
        show_foot_forces: draw contact forces as arrows, if the record has them.
        show_com_reference: draw the reference of the centre of mass as a line, if the record has it.
        view: camera.
    """

    width: Annotated[int, Field(ge=16, le=3840, multiple_of=2)] = 640
    height: Annotated[int, Field(ge=16, le=2160, multiple_of=2)] = 400
    fps: Positive = 25.0
    slow_down: Positive = 1.0
    snapshots: Annotated[int, Field(ge=1)] = 8
    strip_columns: Annotated[int, Field(ge=1)] = 4
    mesh_cell_sizes: NonNegative = 0.0075
    shadow_pixels: Annotated[int, Field(ge=16, le=16384)] = 1024
    samples: Annotated[int, Field(ge=0, le=16)] = 4
    show_foot_forces: bool = True
    show_com_reference: bool = True
    view: ViewConfig = ViewConfig()
