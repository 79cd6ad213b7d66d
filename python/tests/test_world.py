"""World: its motions against closed forms, views that never dangle, misuse, events, queries, pickling."""

import gc
import pickle
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

import continuo
from continuo import World

G = 9.81


def ball(motion: Any = "exact", **settings: Any) -> World:
    world = World(3, gravity=G, motion=motion, **settings)
    world.add_wall([0, 0, 1], restitution=1.0)
    world.add([0, 0, 10], restitution=1.0)
    return world


def test_a_ball_returns_to_its_height() -> None:
    world = ball()
    fall = np.sqrt(2 * 9.5 / G)
    for bounces in (1, 10, 36):
        world.advance_to(2 * bounces * fall)
        assert abs(world.positions[0, 2] - 10) < 1e-9
        assert len(world.contacts.time) in (1, 9, 26)
    assert np.allclose(world.contacts.time[:1], (2 * 10 + 1) * fall, rtol=1e-12)
    assert set(world.contacts.change) == {"impact"}
    assert set(world.contacts.wall) == {0} and set(world.contacts.b) == {-1}
    assert abs(world.energy - world.masses[0] * G * 10) < 1e-9


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_gas_keeps_energy_and_momentum(seed: int, dimension: Any) -> None:
    random = np.random.default_rng(seed)
    world = World(dimension)
    cells = np.stack(np.meshgrid(*[np.arange(4.0)] * dimension), -1).reshape(-1, dimension)
    velocities = random.normal(size=cells.shape)
    radii = random.uniform(0.1, 0.4, len(cells))
    handles = world.add(cells, radii, velocity=velocities, restitution=1.0, friction=0.0)
    assert handles.shape == (len(cells),) and len(world) == len(cells)
    masses = world.masses
    assert np.allclose(masses, np.pi * radii**2 if dimension == 2 else 4 / 3 * np.pi * radii**3)
    energy, momentum = world.energy, masses @ velocities
    assert abs(energy - 0.5 * np.sum(masses[:, None] * velocities**2)) < 1e-12
    world.advance_to(3.0)
    assert len(world.contacts.time) > 10
    assert abs(world.energy - energy) < 1e-12 * energy
    assert np.allclose(world.momentum, momentum, atol=1e-12)
    distances = np.linalg.norm(world.positions[:, None] - world.positions[None], axis=-1)
    gaps = distances - radii[:, None] - radii[None]
    assert np.min(gaps[~np.eye(len(cells), dtype=bool)]) > -1e-9


def test_two_balls_collide_by_the_formula() -> None:
    world = World(3)
    a = world.add([0, 0, 0], 1.0, velocity=[2, 0, 0], mass=3.0, restitution=0.5)
    b = world.add([5, 0, 0], 1.0, velocity=[-1, 0, 0], mass=1.0, restitution=0.5)
    world.advance_to(2.0)  # they meet after 3/3 = 1
    mean = (3 * 2 - 1) / 4
    assert np.allclose(world.velocities[:, 0], [mean - 0.5 * 3 / 4, mean + 0.5 * 9 / 4], rtol=1e-12)
    contacts = world.contacts
    assert np.allclose(contacts.time, [1.0]) and {int(contacts.a[0]), int(contacts.b[0])} == {a, b}
    assert np.allclose(contacts.point[0], [3, 0, 0]) and np.allclose(np.abs(contacts.normal[0]), [1, 0, 0])
    assert np.allclose(contacts.impulse, 1.5 * 3 * 3 / 4)


def test_fast_motion_falls_as_the_exact_one_and_comes_to_rest() -> None:
    fast, exact = (World(2, gravity=[0, -10], motion=motion, step=0.01) for motion in ("fast", "exact"))
    for world in (fast, exact):
        world.add_wall([0, 1])
        world.add([0, 5], velocity=[1, 0])
        world.advance_to(0.5)
    assert np.allclose(fast.positions, exact.positions, atol=1e-9)
    fast.step(count=1000)
    assert abs(fast.positions[0, 1] - 0.5) < 0.01 and abs(fast.time - 10.5) < 1e-9
    fast.step(0.001, count=10)
    assert abs(fast.time - 10.51) < 1e-9
    exact.step(0.25, count=2)
    assert exact.time == 1.0


def test_a_spring_is_an_oscillator() -> None:
    world = World(2)
    body = world.add([1, 0], mass=2.0)
    world.add_spring(body, [0, 0], stiffness=8.0)
    world.advance_to(1.0)
    assert np.allclose(world.positions, [[np.cos(2), 0]], atol=1e-8)
    assert abs(world.potential_energy - 4 * np.cos(2) ** 2) < 1e-7
    world.set_drag(linear=1.0)
    energy = world.energy
    world.advance_to(2.0)
    assert world.energy < energy
    other = world.add([5, 5], mass=1.0)
    world.add_spring(body, other)
    world.remove(other)
    world.advance_to(2.5)  # the spring is gone with its body


def test_views_are_the_world() -> None:
    world = ball()
    x, v = world.positions, world.velocities
    assert x.shape == (1, 3) and x.flags.c_contiguous and x.flags.writeable and not x.flags.owndata
    world.advance_to(1.0)
    assert abs(x[0, 2] - (10 - G / 2)) < 1e-12 and abs(v[0, 2] + G) < 1e-12
    x[0, 2] = 20
    v[0] = 0
    assert world.positions[0, 2] == 20
    world.advance_to(2.0)  # the motion has seen it
    assert abs(x[0, 2] - (20 - G / 2)) < 1e-12
    world.positions += 1
    world.velocities[:] = [1, 0, 0]
    world.advance_to(2.5)
    assert np.allclose(x[0], [1.5, 1, 21 - G / 2 - G / 8])
    for array in (world.radii, world.masses):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2
    flat = World(2)
    flat.add(np.zeros((3, 2)) + [[0], [2], [4]], spin=[1.0, 2.0, 3.0])
    assert flat.spins.shape == flat.orientations.shape == (3,)
    flat.advance_to(0.5)
    assert np.allclose(flat.orientations, [0.5, 1, 1.5])


def test_views_of_before_keep_their_numbers() -> None:
    world = World(2)
    first = world.add([0.0, 0.0])
    x = world.positions
    part = x[0]
    rows = [world.positions]
    for i in range(1, 200):
        world.add([3.0 * i, 0.0], velocity=[0, 1.0])
        rows.append(world.positions)
    assert x.shape == (1, 2) and not x.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        x[0, 0] = 5
    part[0] = 7  # its own memory by now
    assert world.positions[0, 0] == 0
    assert all(len(row) == i + 1 and row[-1, 0] == 3 * i for i, row in enumerate(rows) if i)
    world.advance_to(1.0)
    assert all(np.all(row[:, 1] == 0) for row in rows[:-1]) and np.all(rows[-1][1:, 1] == 1)
    last = world.positions
    world.remove(first)
    assert len(world) == 199 and len(last) == 200 and not last.flags.writeable
    keep = world.positions
    world.restore(world.snapshot())
    assert not keep.flags.writeable
    del world
    gc.collect()
    assert keep.sum() == keep.copy().sum() and last[1, 0] == 3


def test_views_outlive_their_world() -> None:
    views = []
    for i in range(50):
        world = World(3)
        world.add(np.arange(3000.0).reshape(1000, 3) * 2 + i)
        views.append(world.positions)
    del world
    gc.collect()
    assert all(view[0, 0] == i and view[-1, -1] == 5998 + i for i, view in enumerate(views))


def test_bodies_have_names_that_stay() -> None:
    world = World(2)
    handles = world.add([[0, 0], [2, 0], [4, 0]])
    world.remove(handles[0])
    assert handles[0] not in world and handles[2] in world and "x" not in world and -1 not in world
    assert world.positions[world.index(handles[2]), 0] == 4 and list(world.bodies) == [handles[2], handles[1]]
    new = world.add([9, 9])
    assert new not in handles
    for body in (handles[0], 10**6, -1):
        with pytest.raises(KeyError):
            world.remove(body)
        with pytest.raises(KeyError):
            world.index(body)
        with pytest.raises(KeyError):
            world.add_spring(body, [0, 0])
    with pytest.raises(TypeError):
        world.remove("a")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "arguments",
    [
        {"radius": -1.0}, {"radius": 0.0}, {"radius": np.nan},
        {"mass": -1.0}, {"mass": 0.0}, {"mass": np.inf},
        {"position": [0, 0]}, {"position": [[[0, 0, 0]]]}, {"position": [np.nan, 0, 0]}, {"position": 1.0},
        {"velocity": [1, 2]}, {"velocity": [np.inf, 0, 0]}, {"spin": [1, 2]}, {"restitution": 1.5},
        {"restitution": -0.1}, {"friction": -1.0}, {"rolling_resistance": np.nan},
        {"group": 32}, {"group": 0.5},
        {"radius": [1.0, 2.0]}, {"density": 0.0},
    ],
)  # fmt: skip
def test_bodies_that_cannot_be(arguments: dict[str, Any]) -> None:
    world = World(3)
    world.add([9, 9, 9])
    with pytest.raises(ValueError):
        world.add(**{"position": [0, 0, 0], **arguments})
    assert len(world) == 1


def test_all_bodies_of_an_array_or_none() -> None:
    world = World(2)
    with pytest.raises(ValueError, match="body 2"):
        world.add(np.zeros((4, 2)), [1.0, 1.0, -1.0, 1.0])
    assert len(world) == 0
    with pytest.raises(TypeError, match="numbers"):
        world.add(["a", "b"])
    assert world.add(np.zeros((0, 2))).shape == (0,)
    assert world.positions.shape == (0, 2)
    world.advance_to(1.0)


def test_numbers_that_are_none() -> None:
    world = ball()
    for make in (
        lambda: World(3, gravity="a"),  # type: ignore[arg-type]
        lambda: world.advance_to("a"),  # type: ignore[arg-type]
        lambda: world.set_drag("a"),  # type: ignore[arg-type]
        lambda: world.step(0.1, 1.5),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match="^(gravity|t|linear|count) is "):
            make()


def test_misuse() -> None:
    world = ball()
    for make in (
        lambda: World(4),  # type: ignore[arg-type]
        lambda: World(3, motion="slow"),  # type: ignore[arg-type]
        lambda: World(3, step=0),
        lambda: World(3, substeps=0),
        lambda: World(3, tolerance=-1),
        lambda: World(3, gravity=[0, 1]),
        lambda: World(3, gravity=np.nan),
        lambda: world.add_wall([0, 0, 0]),
        lambda: world.add_wall([0, 1]),
        lambda: world.add_wall([0, 0, 1], restitution=2),
        lambda: world.add_container([0, 0, 0], [1, 1, -1]),
        lambda: world.set_drag(-1),
        lambda: world.set_attraction(np.nan),
        lambda: world.ignore(0, 32),
        lambda: world.add_spring(int(world.bodies[0]), int(world.bodies[0])),
        lambda: world.advance_to(-1),
        lambda: world.advance_to(np.nan),
        lambda: world.step(-1),
        lambda: world.step(0.1, count=-1),
        lambda: world.ray([0, 0, 0], [0, 0, 0]),
        lambda: world.in_sphere([0, 0, 0], -1),
        lambda: world.in_box([1, 1, 1], [0, 0, 0]),
        lambda: world.nearest([0, np.nan, 0]),
        lambda: world.add_spring(int(world.bodies[0]), [0, 0, 0], stiffness=-1),
    ):
        with pytest.raises(ValueError):
            make()  # type: ignore[no-untyped-call]
    for motion in ("exact", "fast"):
        other = ball(motion)
        other.advance_to(0.1)
        other.velocities[0, 0] = np.nan
        with pytest.raises(ValueError, match="body 0 is not finite"):
            other.advance_to(0.2)
        other.velocities[0, 0] = 0
        other.advance_to(0.2)
    for state in (b"", b"x" * 100, ball().snapshot()[:-3]):
        with pytest.raises((ValueError, RuntimeError)):
            world.restore(state)
    assert world.positions[0, 2] == 10


def test_questions() -> None:
    world = World(3)
    world.add_wall([0, 0, 1])
    a, b = world.add([[0, 0, 2], [0, 0, 5]], 1.0)
    hit = world.ray([0, 0, 10], [0, 0, -1])
    assert hit is not None and hit.body == b and hit.distance == 4 and np.array_equal(hit.normal, [0, 0, 1])
    assert [(h.body, h.wall, h.distance) for h in world.rays([0, 0, 10], [0, 0, -2])] == [
        (b, None, 4), (a, None, 7), (None, 0, 10)]  # fmt: skip
    assert world.ray([0, 0, 10], [0, 0, 1]) is None and world.ray([0, 0, 10], [0, 0, -1], reach=3) is None
    assert world.in_sphere([0, 0, 0], 1.5) == ([a], [0])
    assert world.in_box([-1, -1, 3.5], [1, 1, 9]) == ([b], [])
    assert world.nearest([0, 0, 9], 5) == [(b, 3.0), (a, 6.0)]


@pytest.mark.parametrize("motion", ["exact", "fast"])
def test_a_copy_goes_on_to_the_same_bits(motion: Any) -> None:
    random = np.random.default_rng(1)
    world = World(2, gravity=1.0, motion=motion)
    world.add_container([0, 0], [20, 20], restitution=0.9)
    places = random.permutation(np.stack(np.meshgrid(range(1, 20, 2), range(1, 20, 2)), -1).reshape(-1, 2))
    velocities = random.normal(size=(100, 2))
    world.add(places, random.uniform(0.3, 0.9, 100), velocity=velocities, restitution=0.9)
    world.advance_to(1.0)
    copies = [world.copy(), pickle.loads(pickle.dumps(world))]
    for each in (world, *copies):
        each.advance_to(3.0)
    for each in copies:
        assert each.time == world.time and np.array_equal(each.positions, world.positions)
        assert np.array_equal(each.velocities, world.velocities) and each.motion == motion
    world.motion = "fast" if motion == "exact" else "exact"
    world.advance_to(3.5)


def test_threads_move_their_worlds_at_once_and_not_the_same() -> None:
    worlds = [ball("fast") for _ in range(4)]
    threads = [threading.Thread(target=world.step, kwargs={"count": 500}) for world in worlds]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({world.positions.tobytes() for world in worlds}) == 1
    world = ball("fast")
    mover = threading.Thread(target=lambda: world.step(count=60_000))
    mover.start()
    refused = 0
    while mover.is_alive():
        try:
            world.add([100.0 + 3 * refused, 0, 0])
            break
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
        time.sleep(0.001)
    mover.join()
    assert refused > 0


@pytest.mark.parametrize("motion", ["exact", "fast"])
def test_ctrl_c_ends_a_move(motion: Any) -> None:
    world = ball(motion)
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.2, signal.raise_signal, [signal.SIGINT])
    timer.start()
    begin = time.perf_counter()
    try:
        with pytest.raises(KeyboardInterrupt):
            world.advance_to(1e7)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, handler)
    assert time.perf_counter() - begin < 2
    now = world.time
    assert 0 < now < 1e7
    world.advance_to(now + 1)
    assert np.all(np.isfinite(world.positions))


def test_plot() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    ax = ball().plot()
    assert ax.get_ylabel() == "z" and len(ax.collections) == 1


def test_repr() -> None:
    assert repr(ball()) == "<continuo.World: 1 bodies in 3 dimensions, exact, t=0>"
    assert continuo.World is World
