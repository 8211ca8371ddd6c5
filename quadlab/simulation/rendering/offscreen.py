"""Drawing a MuJoCo scene into an array, on machines without a display.

MuJoCo picks its OpenGL back end from an environment variable when it is imported, which is too early and too global
for a library. The context is therefore made here, by name, at the moment when a picture is asked for: EGL, else
OSMesa. A program that never draws needs neither.
"""

import ctypes
import importlib
import sys
from types import TracebackType
from typing import Any, Self

import mujoco
import numpy as np
from numpy.typing import NDArray

from quadlab.errors import MissingDependencyError

Frame = NDArray[np.uint8]
"""A picture, (height, width, 3), red, green, blue in 0 to 255, first row on top."""

BACK_ENDS = {"egl": ("libEGL.so.1",), "osmesa": ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")}
"""Back ends for Linux in order of preference, and the names of the library that each needs."""

HELP = "on Debian or Ubuntu run: apt-get install libegl1 libopengl0 libgl1-mesa-dri"
MAX_GEOMS = 4000


def create_context(width: int, height: int) -> Any:
    """Return an OpenGL context that needs no display; outside of Linux, MuJoCo's usual one.

    Raises:
        MissingDependencyError: if the system has neither EGL nor OSMesa; says what to install.
    """
    module = f"mujoco.{_back_end()}" if sys.platform == "linux" else "mujoco"
    try:
        return importlib.import_module(module).GLContext(width, height)
    except (ImportError, AttributeError, OSError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        raise MissingDependencyError(f"rendering without a display failed in {module} ({reason}); {HELP}") from error


def _back_end() -> str:
    """Return the first back end whose library loads; OpenGL is bound to it for the rest of the process."""
    for name, libraries in BACK_ENDS.items():
        if any(_loads(library) for library in libraries):
            return name
    raise MissingDependencyError(f"rendering needs EGL (libEGL.so.1) or OSMesa, and neither is installed; {HELP}")


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


class OffscreenRenderer:
    """Draws one model; use it in a ``with`` statement.

    Attributes:
        scene: what is drawn; overlays may append geoms between ``update`` and ``draw``.
    """

    def __init__(self, model: Any, width: int, height: int) -> None:
        """Make the OpenGL context and send meshes and textures of ``model`` to it.

        Raises:
            MissingDependencyError: if no OpenGL for drawing without a display is installed.
        """
        self._model = model
        self._rectangle = mujoco.MjrRect(0, 0, width, height)
        self._shape = (height, width, 3)
        self._options = mujoco.MjvOption()
        self._options.geomgroup[:] = [1, 1, 1, 0, 0, 0]
        self._options.sitegroup[:] = 0
        self.scene = mujoco.MjvScene(model=model, maxgeom=MAX_GEOMS)
        self.scene.flags[mujoco.mjtRndFlag.mjRND_FOG.value] = 1
        self._context = create_context(width, height)
        self._context.make_current()
        self._drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._drawing)

    def update(self, data: Any, camera: Any) -> None:
        """Put the bodies of ``data`` (an ``MjData`` with computed kinematics) and the lights into the scene."""
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._options, None, camera, everything, self.scene)

    def draw(self) -> Frame:
        """Return the picture of the scene, (height, width, 3)."""
        self._context.make_current()
        pixels = np.empty(self._shape, np.uint8)
        mujoco.mjr_render(self._rectangle, self.scene, self._drawing)
        mujoco.mjr_readPixels(pixels, None, self._rectangle, self._drawing)
        return np.ascontiguousarray(pixels[::-1])

    def close(self) -> None:
        """Free the OpenGL context."""
        self._context.make_current()
        self._drawing.free()
        self._context.free()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
