"""What drawing asks of OpenGL: objects, programs, and clear words where it cannot."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.errors import RenderingError
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.canvas import COLOURS, LABELS, Canvas
from adamo_vh.runtime.graphics import in_graphics_thread, load_mujoco, open_gl
from adamo_vh.runtime.opengl import call
from adamo_vh.runtime.shading import VERTEX, fragment
from adamo_vh.runtime.shadows import view_matrix


@pytest.fixture(scope="module")
def inside() -> Iterator[Callable[[Callable[[], Any]], Any]]:
    """Has a job done in a context of OpenGL of its own."""
    load_mujoco()
    context = in_graphics_thread(lambda: open_gl(1, 1))

    def run(job: Callable[[], Any]) -> Any:
        def there() -> Any:
            context.make_current()
            try:
                return job()
            finally:
                assert call("GetError", "", "u")() == 0

        return in_graphics_thread(there)

    yield run
    in_graphics_thread(context.free)


Inside = Callable[[Callable[[], Any]], Any]


def test_a_call_that_is_missing_says_what_to_update(inside: Inside) -> None:
    with pytest.raises(RenderingError, match=r"no glFlyToTheMoon.*4\.5.*driver"):
        inside(lambda: call("FlyToTheMoon"))


@pytest.mark.parametrize("texture", [False, True])
@pytest.mark.parametrize("shadow", [False, True])
def test_every_program_compiles(inside: Inside, texture: bool, shadow: bool) -> None:
    source = fragment(texture=texture, shadow=shadow)
    assert source.startswith("#version 120\n")
    assert ("#define TEXTURE" in source, "#define SHADOW" in source) == (texture, shadow)
    made = inside(lambda: gl.program(VERTEX.lstrip(), source))
    assert made > 0
    assert inside(lambda: gl.uniform(made, "part")) >= 0


@pytest.mark.parametrize(
    ("vertex", "pixel"),
    [("nonsense", fragment(texture=True, shadow=True)), (VERTEX.lstrip(), "void main() { a; }")],
)
def test_a_program_that_is_refused_is_told(inside: Inside, vertex: str, pixel: str) -> None:
    with pytest.raises(RenderingError, match="OpenGL refuses"):
        inside(lambda: gl.program(vertex, pixel))


def test_objects_are_made_and_known(inside: Inside) -> None:
    def known() -> tuple[int, ...]:
        names = gl.made("Textures", 2)
        for name in names:
            call("BindTexture", "uu")(gl.TEXTURE_2D, name)
        assert all(call("IsTexture", "u", "b")(name) for name in names)
        return names

    first, second = inside(known)
    assert first != second
    assert not inside(lambda: call("IsTexture", "u", "b")(second + 40))


def filled(canvas: Canvas, size: tuple[int, int], *which: int) -> list[NDArray[np.uint8]]:
    """Start a picture and fill one or both with grey."""
    canvas.begin(*size)
    canvas.draw_into(*which)
    call("ClearColor", "ffff")(0.5, 0.5, 0.5, 1.0)
    call("Clear", "u")(gl.COLOR_BUFFER_BIT)
    return [canvas.read(picture).copy() for picture in (COLOURS, LABELS)]


def test_each_picture_of_a_canvas_is_drawn_on_alone(inside: Inside) -> None:
    def draw() -> list[list[NDArray[np.uint8]]]:
        canvas = Canvas()
        return [filled(canvas, (30, 20), which) for which in (COLOURS, LABELS)]

    (colours, empty), (blank, labels) = inside(draw)
    assert colours.shape == labels.shape == (20, 30, 4)
    assert (colours[:, :, 0] == 128).all()
    assert (labels[:, :, 0] == 128).all()
    assert not empty.any()
    assert not blank.any()


@pytest.mark.parametrize("sizes", [((10, 10), (40, 5), (5, 40)), ((64, 36), (8, 8), (64, 36))])
def test_a_canvas_takes_any_sizes_in_turn(
    inside: Inside, sizes: tuple[tuple[int, int], ...]
) -> None:
    def draw() -> list[NDArray[np.uint8]]:
        canvas = Canvas()
        return [filled(canvas, size, COLOURS, LABELS)[COLOURS] for size in sizes]

    for size, picture in zip(sizes, inside(draw), strict=True):
        assert picture.shape == (size[1], size[0], 4)
        assert (picture[:, :, :3] == 128).all()


def test_a_picture_beyond_all_room_is_an_error(inside: Inside) -> None:
    def draw() -> None:
        try:
            Canvas().begin(200_000, 4)
        finally:
            call("GetError", "", "u")()

    with pytest.raises(RenderingError, match="no room for a picture of 200000x4"):
        inside(draw)


def test_a_camera_sees_what_lies_ahead_in_the_middle() -> None:
    eye = np.array([1.0, 2.0, 3.0], np.float32)
    ahead = np.array([2.0, -1.0, 0.5], np.float32)
    matrix = view_matrix(eye, ahead, np.array([0.0, 0.0, 1.0], np.float32))
    np.testing.assert_allclose(matrix @ [*eye, 1.0], [0, 0, 0, 1], atol=1e-6)
    seen = matrix @ np.append(eye + ahead, 1.0)
    np.testing.assert_allclose(seen[:3], [0, 0, -float(np.linalg.norm(ahead))], atol=1e-6)
    above = matrix @ np.append(eye + np.array([0, 0, 1]), 1.0)
    assert above[1] > 0.9
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-6)
