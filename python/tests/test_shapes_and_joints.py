"""Bodies of every shape, joints, ground, questions and characters: against closed forms, and misuse."""

import pickle
from typing import Any

import numpy as np
import pytest

from continuo import (
    Box,
    Capsule,
    Chain,
    Character,
    Compound,
    HeightField,
    Hull,
    Limits,
    Motor,
    Part,
    Sphere,
    Spring,
    TriangleMesh,
    Wheel,
    World,
)

G = 9.81


def floor(dimension: Any = 2, motion: Any = "fast", **settings: Any) -> World:
    world = World(dimension, gravity=G, motion=motion, **{"step": 1 / 240, **settings})
    world.add_wall(np.eye(dimension)[-1])
    return world


def test_masses_and_centres_are_those_of_the_shapes() -> None:
    world = World(2)
    right = [[0, 0], [3, 0], [0, 3]]
    halves = Compound([Part(Box([1, 1]), [-0.5, 0]), Part(Box([1, 1]), [0.5, 0], np.pi / 2)])
    world.add([0, 0], shape=Box([2, 3]), density=2)
    world.add([5, 0], shape=Capsule(1, 0.5))
    world.add([10, 0], shape=Hull(right), orientation=np.pi / 2)
    world.add([[20, 0], [30, 0]], shape=halves, orientation=[0, 1])
    assert np.allclose(world.masses, [12, 1 + np.pi / 4, 4.5, 2, 2], rtol=1e-14)
    # The centre of the triangle is (1, 1) from the right angle, and is turned with it.
    assert np.allclose(world.positions[2], [9, 1], atol=1e-14)
    assert np.allclose(world.origins[2], [10, 0], atol=1e-14)
    assert np.allclose(world.orientations, [0, 0, np.pi / 2, 0, 1])
    space = World(3)
    space.add(np.zeros(3), shape=Box([1, 2, 3]), orientation=[2, 0, 0, 0])
    assert space.masses[0] == pytest.approx(6) and np.allclose(space.orientations, [[1, 0, 0, 0]])


def test_a_stack_stands_and_a_view_turns_a_body() -> None:
    world = floor()
    world.add(np.column_stack([np.zeros(10), np.arange(10) + 0.5]), shape=Box([1, 1]))
    world.step(count=240)
    assert abs(world.positions[-1, 1] - 9.5) < 1e-6
    world.orientations[-1] = 0.5
    world.positions[-1, 1] = 12
    world.step()
    assert abs(world.orientations[-1] - 0.5) < 1e-6


def test_a_rod_swings_exactly() -> None:
    # About its end a rod of length 1 has the inertia m/3: with spin 0 at the horizontal, spin^2 = 3 g sin.
    world = World(2, gravity=G)
    rod = world.add([0.5, 0], shape=Box([1, 0.01]), mass=3)
    pin = world.add_joint("hinge", rod, [0, 0])
    world.advance_to(0.3)
    inertia = (1 + 0.01**2) / 12 + 0.25
    assert abs(world.spins[0] ** 2 - G * np.sin(-pin.coordinate) / inertia) < 1e-8
    assert pin.kind == "hinge" and pin.bodies == (None, rod)


def test_limits_motor_and_loads_of_a_hinge() -> None:
    world = World(2, gravity=G, motion="fast", step=1 / 240)
    door = world.add([0.5, 0], shape=Box([1, 0.1]), mass=2)
    hinge = world.add_joint("hinge", door, [0, 0], limits=Limits(-1, 1), motor=Motor(2, 30))
    world.step(count=480)
    assert abs(hinge.coordinate - 1) < 1e-4
    assert np.allclose(hinge.force, [0, 2 * G], atol=1e-3)  # it holds the weight
    assert abs(hinge.motor_effort - 30) < 1e-6  # and pushes with all it has
    hinge.motor = Motor(-2, 30)
    hinge.limits = None
    angle = hinge.coordinate
    world.step(count=240)
    assert abs(hinge.coordinate - (angle - 2)) < 0.05
    assert hinge.limits is None and hinge.motor == (-2, 30)
    hinge.spring = Spring(2, 1, 0.5)
    assert hinge.spring == (2, 1, 0.5)


def test_each_kind_of_joint_holds() -> None:
    world = World(3, gravity=G, motion="fast", step=1 / 240)
    places = {}
    for k, kind in enumerate(["ball", "slider", "weld", "distance", "wheel", "universal", "hinge"]):
        body = world.add([5.0 * k + 0.5, 0, 0], shape=Box([1, 0.2, 0.2]))
        more: dict[str, Any] = {"axle": [0, 1, 0]} if kind in ("wheel", "universal") else {}
        if kind in ("slider", "hinge"):
            more["axis"] = [1, 0, 0] if kind == "slider" else [0, 1, 0]
        if kind == "distance":
            more["anchor_b"] = [5.0 * k + 0.2, 0, 0]
        places[kind] = world.add_joint(kind, body, [5.0 * k, 0, 0], **more)
    world.step(count=60)
    assert np.allclose(world.positions[2], [10.5, 0, 0], atol=1e-5)  # the weld
    assert abs(places["distance"].coordinate - 0.2) < 1e-5
    assert np.allclose(world.positions[1, 1:], 0, atol=1e-5)  # the slider is held across its axis
    assert len(world.joints) == 7
    world.remove_joint(places["weld"])
    assert len(world.joints) == 6
    with pytest.raises(KeyError):
        _ = places["weld"].force
    world.remove(int(world.bodies[0]))
    assert len(world.joints) == 5


def test_gear_rope_and_strength() -> None:
    world = World(2, motion="fast", step=1 / 240)
    small, large = world.add([[0, 0], [2, 0]], radius=0.5, spin=[2, 0])
    for body in (small, large):
        world.add_joint("hinge", int(body))
    world.add_joint("gear", int(large), a=int(small), ratio=0.5)
    world.step(count=240)
    assert abs(world.orientations[1] + 0.5 * world.orientations[0]) < 1e-6
    falling = World(2, gravity=G, motion="fast", step=1 / 240)
    stone = falling.add([0, 0], mass=1)
    rope = falling.add_joint("distance", stone, [0, 0.5], anchor_b=[0, 0], limits=(0, 1), breaks_at=1e6)
    weak = falling.add_joint("weld", falling.add([5, 0], mass=1), breaks_at=0.5 * G)
    falling.step(count=480)
    assert abs(rope.coordinate - 1) < 1e-3 and abs(np.linalg.norm(rope.force) - G) < 0.1
    assert weak.broken and not rope.broken


def test_a_hand_pulls_a_body() -> None:
    world = World(2, motion="fast", step=1 / 240)
    crate = world.add([0, 0], shape=Box([1, 1]))
    hand = world.add_joint("pull", crate, spring=Spring(5), target=[2, 1], breaks_at=1e4)
    world.step(count=480)
    assert np.allclose(world.positions[0], [2, 1], atol=1e-3)
    hand.target = [0, 0]
    world.step(count=480)
    assert np.allclose(world.positions[0], 0, atol=1e-3) and np.all(hand.target == 0)


def test_traits() -> None:
    world = World(2, gravity=10)
    fall = {"gravity_scale": 0}
    world.add([[0, 0], [5, 0]], velocity=[3, 0], damping=[0.5, 0], **fall)
    world.add([10, 0], gravity_scale=0.25)
    world.add([20, 0], shape=Box([1, 1]), driven=True, velocity=[0, 2], spin=1.5)
    world.advance_to(1)
    assert np.allclose(world.velocities[:2, 0], [3 * np.exp(-0.5), 3], atol=1e-9)
    assert abs(world.positions[2, 1] + 1.25) < 1e-9
    assert np.allclose(world.positions[3], [20, 2]) and abs(world.orientations[3] - 1.5) < 1e-12
    held = World(2, gravity=10, motion="fast")
    held.add([0, 0], shape=Box([1, 1]), locked="y", velocity=[1, 0])
    gate = held.add([5, 0], shape=Box([3, 1]), fixed=True, sensor=True)
    held.add([5, 1.2], category=2, mask=1)
    met = False
    for _ in range(60):
        held.step()
        met = met or gate in held.contacts.a or gate in held.contacts.b
    assert abs(held.positions[0, 1]) < 1e-5 and held.positions[2, 1] < -2
    assert met


def test_ground() -> None:
    hill = World(2, gravity=G, motion="fast", step=1 / 240)
    x = np.linspace(-10, 10, 41)
    hill.add_mesh(Chain(np.column_stack([x, 0.1 * x])[::-1]), friction=0)
    hill.add([0, 0.5025], radius=0.5, friction=0, rolling_resistance=0)
    hill.step(count=240)
    slope = np.arctan(0.1)
    assert abs(np.linalg.norm(hill.velocities[0]) - G * np.sin(slope)) < 0.01
    field = World(3, gravity=G, motion="fast")
    heights = np.add.outer(np.arange(4) * 1.0, np.zeros(6))  # it rises along x
    named = field.add_mesh(HeightField(heights, spacing=[2, 3], origin=[0, 0, 0]))
    down = field.first_hits([[1, 1, 9], [5, 14, 9], [50, 1, 9]], [0, 0, -1])
    assert np.allclose(down.distance[:2], [8.5, 6.5]) and not np.isfinite(down.distance[2])
    assert list(down.mesh) == [0, 0, -1] and list(down.body) == [-1, -1, -1]
    field.remove_mesh(named)
    assert not np.isfinite(field.first_hits([1, 1, 9], [0, 0, -1]).distance[0])
    square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    field.add_mesh(TriangleMesh(square, [[0, 1, 2]]))
    assert field.ray([0.2, 0.2, 1], [0, 0, -1]) is not None
    with pytest.raises(ValueError, match="plane only"):
        field.add_mesh(Chain([[0, 0], [1, 0]]))


def test_questions_about_shapes() -> None:
    world = World(2)
    box = world.add([3, 0], shape=Box([1, 1]))
    hit = world.first_contact(Sphere(0.5), [0, 0], [10, 0])
    assert hit is not None and hit.body == box and abs(hit.distance - 2) < 1e-4
    assert world.first_contact(Sphere(0.5), [0, 0], [-10, 0]) is None
    assert world.in_shape(Box([2, 2]), [2, 0]).bodies == [box]
    assert world.in_shape(Box([1, 1]), [0, 0], 0.3) == ([], [], [])
    (near,) = world.near_shape(Capsule(1, 0.25), [0, 0], 5)
    assert near.body == box and abs(near.distance - 2.25) < 1e-12 and abs(near.point[0] - 1.375) < 1e-12
    assert world.near_shape(Capsule(1, 0.25), [0, 0], 2) == []


def test_a_character_walks_up_steps() -> None:
    world = floor(3)
    for k in range(1, 4):
        world.add([k * 1.0 + 5, 0, k * 0.1], shape=Box([10, 4, k * 0.2]), fixed=True)
    hero = Character([-1, 0, 0.005])
    for _ in range(180):
        hero = world.walk(hero, [1.5, 0, 0], 1 / 60)
    position = np.asarray(hero.position)
    assert abs(position[0] - 3.5) < 0.02 and hero.on_ground
    assert abs(position[2] - 0.6) < 0.02 and hero.ground == int(world.bodies[2])


def on_wheels(dimension: int, **more: Any) -> tuple[World, Any]:
    world = floor(dimension)
    size = [4, 0.6] if dimension == 2 else [4, 1.8, 0.6]
    body = world.add(np.eye(dimension)[-1] * 0.75, shape=Box(size), mass=1200)
    sides = [[]] if dimension == 2 else [[0.8], [-0.8]]
    wheels = [Wheel([x, *side, -0.5], **more) for x in (1.3, -1.3) for side in sides]
    return world, world.add_vehicle(body, wheels)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_vehicle_is_borne_driven_and_stopped(dimension: int) -> None:
    world, car = on_wheels(dimension, greatest_drive=300)
    assert car.wheels == []
    for _ in range(1200):
        car.drive()
        world.step()
    n = len(car.wheels)
    for wheel in car.wheels:
        assert wheel.load == pytest.approx(1200 * G / n, rel=1e-6) and wheel.ground is None
        assert wheel.compression == pytest.approx(1200 * G / n / 30_000, rel=1e-6)
    assert np.abs(world.velocities).max() < 1e-5
    for _ in range(480):
        car.drive(throttle=1)
        world.step()
    before = world.velocities[0, 0]
    for _ in range(240):
        car.drive(throttle=1)
        world.step()
    gained = n * 300 / 0.35 / (1200 + n * 1.2 / 0.35**2)
    assert world.velocities[0, 0] - before == pytest.approx(gained, rel=1e-3)
    other = world.copy()
    copied = car.copy(other)
    for of, vehicle in ((world, car), (other, copied)):
        for _ in range(960):
            vehicle.drive(brake=1)
            of.step()
        assert abs(of.velocities[0, 0]) < 1e-3
    assert np.array_equal(world.positions, other.positions)


def test_a_vehicle_says_what_makes_no_sense() -> None:
    world, car = on_wheels(3, radius=-1)
    with pytest.raises(ValueError, match="radius"):
        car.drive()
    world, car = on_wheels(3)
    with pytest.raises(ValueError, match="throttle"):
        car.drive(2)
    with pytest.raises(ValueError, match=r"\(3,\)"):
        world.add_vehicle(0, [Wheel([0, 0])])
    with pytest.raises(KeyError):
        world.add_vehicle(99, [])
    car.drive()
    car.release()
    world.remove(car.chassis)
    with pytest.raises(ValueError, match="no body"):
        car.drive()


def test_sleep_and_joints_that_wake() -> None:
    world = floor(sleep_after=0.2)
    wheel = world.add([0, 0.5], radius=0.5, rolling_resistance=0)
    crate = world.add([0, 2], shape=Box([1, 1]), fixed=True)
    axle = world.add_joint("hinge", wheel, [0, 0.5], a=crate)
    world.step(count=240)
    assert world.asleep == 1
    axle.motor = Motor(3, 100)
    world.step()
    assert world.asleep == 0
    world.step(count=120)
    assert abs(world.spins[world.index(wheel)] - 3) < 0.1


def test_a_copy_goes_on_to_the_same_bits() -> None:
    world = floor(3)
    shape = Compound([Part(Sphere(0.3), [0, 0, 0.5]), Part(Box([1, 0.5, 0.4]))])
    bodies = world.add(np.array([[0, 0, 1.5], [0.3, 0.1, 3], [1, 0, 2]]), shape=shape, spin=[0.5, 1, 0])
    world.add_joint("ball", int(bodies[0]), [0, 0, 2], a=int(bodies[1]))
    world.step(count=30)
    other = pickle.loads(pickle.dumps(world))
    for one in (world, other):
        one.step(count=60)
    assert np.array_equal(world.positions, other.positions)
    assert np.array_equal(world.orientations, other.orientations)


def test_mistakes_name_the_argument() -> None:
    world = World(2)
    body = world.add([0, 0], shape=Box([1, 1]))
    for act, error, said in [
        (lambda: world.add([0, 0], shape=Box([1, 1, 1])), ValueError, "size of a box must have 2"),
        (lambda: world.add([0, 0], shape=Box([1, -1])), ValueError, "box"),
        (lambda: world.add([0, 0], shape=Hull([[0, 0], [1, 1], [2, 2]])), ValueError, "hull"),
        (lambda: world.add([0, 0], shape="box"), TypeError, "shape is 'box'"),
        (lambda: world.add([0, 0], shape=Compound([])), ValueError, ""),
        (lambda: world.add([0, 0], locked="z"), ValueError, "locked has 'z'"),
        (lambda: world.add([0, 0], orientation=np.nan), ValueError, "orientation"),
        (lambda: world.add([0, 0], mask=-1), ValueError, "mask"),
        (lambda: world.add_joint("hing", body), ValueError, "kind is 'hing'"),
        (lambda: world.add_joint("hinge", body, [0, 0, 0]), ValueError, "anchor must have 2"),
        (lambda: world.add_joint("hinge", body, limits=(1, 0)), ValueError, "limits"),
        (lambda: world.add_joint("hinge", body, motor=3), TypeError, "motor"),  # type: ignore[arg-type]
        (lambda: world.add_joint("hinge", body, a=body), ValueError, ""),
        (lambda: world.add_joint("hinge", 77), KeyError, "no such body"),
        (lambda: world.near_shape(Sphere(-1), [0, 0], 1), ValueError, ""),
        (lambda: World(3).add([0, 0, 0], orientation=[0, 0, 0, 0]), ValueError, "orientation"),
    ]:
        with pytest.raises(error, match=said):
            act()
    assert len(world) == 1 and world.joints == []


def test_plot_draws_the_shapes() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    world = floor(3)
    turned = [np.cos(np.pi / 8), 0, np.sin(np.pi / 8), 0]  # by 45 degrees about y
    two = Compound([Part(Box([1, 1, 1])), Part(Box([1, 1, 1]), [3, 0, 0])])
    world.add([0, 0, 1], shape=two, orientation=turned)
    world.add([9, 0, 1], radius=0.5)
    paths = world.plot().collections[0].get_paths()
    assert len(paths) == 3
    # A square that stands on its corner, seen from the front.
    corners = paths[0].vertices - [0, 1]
    assert np.allclose(np.max(np.abs(corners), axis=0), np.sqrt(0.5)) and len(corners) == 5
