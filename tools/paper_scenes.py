"""Scenes of the paper's chapter on collision, for make_scenes.py. The laboratory plays them with rollback
(`hooke run --stepper declared`), the solver with contacts; both keep what they promise."""
import math

from scene_kit import DT, G, body, box, fall, ground, promise, scene, weight_energy


def laboratory(**changes):
    return {"laboratory": {"stepper": "rk4"} | changes}


def ball(radius):
    return {"sphere": {"radius": radius}}


def fig5():
    radius, height, bounce = 0.25, 1.0, 0.8
    hit = math.sqrt(2 * height / G)
    top = hit * (1 + bounce)  # s, of the first bounce
    step = round(top / DT)
    late = step * DT - top
    return scene(
        "Figure 5 of the paper",
        f"A ball falls 1 m and is found in the ground: the step is canceled and taken again, shorter, until it "
        f"ends at the hit, after sqrt(2 h / g) = {hit:.4f} s. It comes back to e^2 h = 0.64 m.", 3,
        [0, 1.2, 4.5], [0, 0.7, 0], {"ground": {}, "clay": {"restitution": bounce, "friction": 0}}, [
            ground(),
            body("ball", "clay", ball(radius), [0, radius + height, 0], mass=1)
        ], [
            fall("ball", radius + height, 24),
            promise("height", "==", radius + bounce**2 * height - G * late**2 / 2, "ball", 0.01, step),
            promise("x", "==", 0, "ball", 1e-4)
        ], **laboratory(rollback="halving", epsilon=1e-4))


def fig6():
    radius, half, aside = 0.5, 1.0, 1.25
    y0 = 2.6
    # It hits the edge where (y - half)^2 + (aside - half)^2 = radius^2.
    touch = half + math.sqrt(radius**2 - (aside - half)**2)
    step = int(math.sqrt(2 * (y0 - touch) / G) / DT) - 1
    return scene(
        "Figure 6 of the paper",
        "A ball comes down on the edge of a box: its center is beside the top, so a test of faces alone misses "
        "it. It must hit the edge, and is thrown aside: without friction it leaves the column in which it fell.",
        2, [0.6, 2.2, 7], [0.6, 1.0, 0], {
            "ground": {"friction": 0}, "sand": {"friction": 0}, "clay": {"friction": 0}
        }, [
            ground(),
            body("box", "sand", box(half, half / 2, half), [0, half / 2, 0], "static"),
            body("ball", "clay", ball(radius), [aside, y0, 0], mass=1)
        ], [
            fall("ball", y0, step),
            promise("x", "==", aside, "ball", 1e-4, step),
            promise("x", ">", half + radius, "ball"),
            promise("height", "==", radius, "ball", 0.01)
        ], **laboratory(rollback="event"))


def wall():
    # In a step a ball flies 4 m, through a wall of 2 cm.
    speed, radius = 240.0, 0.1
    back = 0.5
    steps = 30
    hit = (4 - 0.01 - radius) / speed
    x = 4 - 0.01 - radius - back * speed * (steps * DT - hit)
    return scene(
        "A ball and a wall",
        "240 m/s, 4 m a step, against a wall of 2 cm. It must not pass: it is thrown back with e = 0.5 of its "
        "speed. With the sweep of the laboratory set to none it passes, as in the paper.", 0.5, [0, 4, 14],
        [0, 1, 0], {"sand": {"restitution": back, "friction": 0}, "steel": {"restitution": back, "friction": 0}}, [
            body("wall", "sand", box(0.01, 2, 2), [4, 0, 0], "static"),
            body("ball", "steel", ball(radius), [0, 0, 0], velocity=[speed, 0, 0], mass=1)
        ], [
            promise("x", "==", x, "ball", 2, steps),
            promise("speed", "==", back * speed, "ball", 0.5, steps),
            promise("height", "==", -G * (steps * DT)**2 / 2, "ball", 0.02, steps),
            promise("x", "<", 4, "ball")
        ], **laboratory(rollback="event", sweep="extruded"))


def rollback_room():
    bounce, mass, half = 0.6, 2.0, 0.2
    walls = [body(name, "sand", shape, place, "static") for name, shape, place in [
        ("left", box(0.1, 1.5, 2), [-2.1, 1.5, 0]), ("right", box(0.1, 1.5, 2), [2.1, 1.5, 0]),
        ("back", box(2.2, 1.5, 0.1), [0, 1.5, -2.1])]]
    things = []
    for i in range(6):
        place = [-1.25 + 0.5 * i, 0.6 + 0.45 * i, 0.4 * (-1)**i]
        name, shape = ("ball", ball(half)) if i % 2 else ("crate", box(half, half, half))
        things.append(body(f"{name}{i}", "clay" if i % 2 else "moss", shape, place, mass=mass,
                           velocity=[1.5 - 0.6 * i, 0, 0.3 * (i - 2)], angular_damping=1.0))
    return scene(
        "Rollback in a room",
        "Balls and crates are thrown into a room; each hit is a step that was canceled and taken again, and only "
        "those that meet take it again. At the end all rest on the ground: m g r each.", 12, [0, 3.4, 6.5],
        [0, 0.8, 0], {
            "ground": {"friction": 0.5, "rolling_friction": 0.01}, "sand": {"friction": 0.5},
            "clay": {"friction": 0.5, "restitution": bounce, "rolling_friction": 0.01},
            "moss": {"friction": 0.5, "restitution": bounce / 2}, "glass": {"friction": 0.5}
        }, [ground(), body("front", "glass", box(2.2, 0.3, 0.1), [0, 0.3, 2.1], "static")] + walls + things, [
            promise("height", "==", 2.85 - G * (9 * DT)**2 / 2, "ball5", 0.004, 9),  # before it hits
            weight_energy([(mass, half)] * len(things), 0.01),
            promise("kinetic_energy", "<", 0.05)
        ], **laboratory(rollback="event"))
