"""Scenes of bodies that hooks join, for make_scenes.py."""
import math

from scene_kit import (DT, G, TONES, X, Y, Z, add, body, box, cross, fall, ground, hook, product, low_sun, promise,
                       rotated, scaled, scene, turn)

MATERIALS = {"ground": {"friction": 0.6}} | {tone: {"friction": 0.6} for tone in TONES}


def swing(rate, start, seconds):
    """Solution of x'' = -rate sin(x), at rest at the start, by Runge and Kutta."""
    x, v, parts = start, 0.0, 20000
    h = seconds / parts
    for _ in range(parts):
        a = [v, -rate * math.sin(x)]
        b = [v + h / 2 * a[1], -rate * math.sin(x + h / 2 * a[0])]
        c = [v + h / 2 * b[1], -rate * math.sin(x + h / 2 * b[0])]
        d = [v + h * c[1], -rate * math.sin(x + h * c[0])]
        x += h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        v += h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
    return x, v


# ---- Doors ------------------------------------------------------------------------------------------------


def door():
    half, mass = [0.4, 0.95, 0.02], 20
    lever = half[0] + 0.05  # of the center from the hinge
    inertia = mass * ((half[0]**2 + half[2]**2) / 3 + lever**2)
    friction, speed = 6.0, 3.0
    stop = inertia * speed**2 / (2 * friction)  # the work of friction is the energy
    beta, start = math.radians(15), math.radians(35)  # lean of the gate's axis, and how far it is opened
    axis = [0, math.cos(beta), math.sin(beta)]
    upright = product(turn(X, beta), turn(Y, -math.pi / 2))  # the gate in its lowest place
    opened = product(turn(axis, start), upright)
    foot = [2.6, 1.3, -0.6]
    rate = mass * G * lever * math.sin(beta) / inertia
    after = {step: swing(rate, start, step * DT)[0] - start for step in (40, 80)}
    closer = 4.0  # N m / rad
    return scene(
        "Three doors",
        f"Left: pushed with 3 rad/s against a friction of 6 N m, it turns by I w^2 / (2 M) = {stop:.3f} rad. "
        "Middle: a closer, a spring of 4 N m/rad with critical damping, shuts it from 60 degrees against its "
        "stop. Right: a gate whose axis leans by 15 degrees swings as a pendulum of g sin(15). Each hinge "
        "carries its door.", 8, [1.1, 2.3, 6.2], [0.5, 0.95, -0.2], {
            "ground": {"friction": 0.6}, "oak": {}, "clay": {}, "moss": {}, "steel": {}
        }, [
            ground(),
            body("post", "steel", box(0.04, 1, 0.04), [-2.2, 1, 0], "static",
                 array={"list": [[0, 0, 0], [2, 0, 0]]}),
            body("leaning_post", "steel", box(0.04, 1, 0.04), foot, "static", rotation=turn(X, beta)),
            body("rubbing", "oak", box(*half), [-2.2 + lever, 1, 0], mass=mass,
                 angular_velocity=[0, speed, 0], velocity=[0, 0, -speed * lever]),
            body("closing", "clay", box(*half),
                 add([-0.2, 1, 0], rotated(turn(Y, math.radians(60)), [lever, 0, 0])), mass=mass,
                 rotation=turn(Y, math.radians(60))),
            body("gate", "moss", box(*half), add(foot, rotated(opened, [lever, 0, 0])), mass=mass,
                 rotation=opened, can_sleep=False)
        ], [
            promise("angle", "==", stop, "friction", 0.01),
            promise("force", "within", mass * G, "friction", 0.001),
            promise("torque", "within", mass * G * lever, "friction", 0.001),
            promise("angle", "==", -math.radians(60), "closer", 0.01),
            *(promise("angle", "==", angle, "gate_hinge", 0.01, step) for step, angle in after.items()),
            promise("gap", "<", 1e-4)
        ], hooks=[
            hook("friction", "hinge", "rubbing", [-2.2, 1, 0], "post[0]", axis=Y,
                 motor={"max_force": friction}),
            hook("closer", "hinge", "closing", [-0.2, 1, 0], "post[1]", axis=Y,
                 spring={"stiffness": closer, "damping": 2 * math.sqrt(closer * inertia),
                         "target": -math.radians(70)}, limits={"lower": -math.radians(60)}),
            hook("gate_hinge", "hinge", "gate", foot, "leaning_post", axis=axis)
        ])


# ---- Chains -----------------------------------------------------------------------------------------------


def wrecking_ball():
    links, length, ball_mass, radius = 10, 0.4, 1000, 0.45
    link_mass = 4
    top, start = [0, 6, 0], math.radians(65)
    down = [-math.sin(start), -math.cos(start), 0]
    along = turn(Z, -start)
    reach = links * length + radius
    columns, rows, brick = 7, 6, [0.2, 0.2, 0.25]
    wall = [radius + 0.35, brick[1], -(columns - 1) * brick[2]]
    # Light links: a pendulum of its moments about the top.
    moment = ball_mass * (reach**2 + 0.4 * radius**2)
    pull = ball_mass * reach
    for i in range(links):
        center = (i + 0.5) * length
        moment += link_mass * (center**2 + length**2 / 12)
        pull += link_mass * center
    step = 1
    while swing(pull * G / moment, start, step * DT)[0] > 0:
        step += 1
    step -= 2
    angle, rate = swing(pull * G / moment, start, step * DT)
    return scene(
        "Wrecking ball",
        "A ball of 1 t on ten links of 4 kg falls as one pendulum, passes the lowest point with "
        f"{abs(rate) * reach:.1f} m/s, and hits a wall of columns whose bricks are glued to each other. "
        "Until then the chain is as long as it was; glue breaks where the ball hits, and not at the edges.",
        6, [-4.0, 6.4, 7.2], [-0.1, 2.9, 0], {
            "ground": {"friction": 0.6}, "steel": {"friction": 0.4}, "clay": {"friction": 0.6},
            "sand": {"friction": 0.6}
        }, [
            ground(),
            body("crane", "steel", box(0.3, 0.1, 0.1), add(top, [0, 0.1, 0]), "static"),
            body("link", "steel", {"capsule": {"radius": 0.05, "half_height": length / 2 - 0.05}},
                 add(top, scaled(length / 2, down)), rotation=along, mass=link_mass,
                 array={"list": [scaled(i * length, down) for i in range(links)]}),
            body("ball", "steel", {"sphere": {"radius": radius}}, add(top, scaled(reach, down)),
                 mass=ball_mass, rotation=along),
            *(body(f"column_{i}", ["clay", "sand"][i % 2], box(*brick), add(wall, [0, 0, 2 * i * brick[2]]),
                   density=1800, array={"grid": [1, rows, 1], "spacing": [1, 2 * brick[1], 1]})
              for i in range(columns))
        ], [
            promise("x", "==", top[0] - reach * math.sin(angle), "ball", 0.03, step),
            promise("speed", "within", abs(rate) * reach, "ball", 0.005, step),
            promise("force", "within", force_at_top(ball_mass, reach, link_mass, links, length, angle, rate),
                    "hook", 0.02, step),
            promise("gap", "<", 1e-3, at_step=step),
            promise("broken", "==", 0, at_step=step),
            promise("broken", ">", 2),
            promise("broken", "==", 0, "glue_0[0]"),
            promise("broken", "==", 0, "hook"),
            promise("speed", "<", abs(rate) * reach / 2, "ball")
        ], hooks=[
            hook("hook", "ball", "link[0]", top, "crane"),
            hook("joint", "ball", "link[1]", add(top, scaled(length, down)), "link[0]",
                 array={"list": [scaled(i * length, down) for i in range(links - 1)]}),
            hook("shackle", "ball", "ball", add(top, scaled(links * length, down)), f"link[{links - 1}]"),
            *(hook(f"glue_{i}", "fixed", f"column_{i}[1]", add(wall, [0, brick[1], 2 * i * brick[2]]),
                   f"column_{i}", break_force=20000, break_torque=4000, collide=True,
                   array={"grid": [1, rows - 1, 1], "spacing": [1, 2 * brick[1], 1]}) for i in range(columns))
        ], fov_deg=42, **low_sun([0.7, -0.6, -0.5]))


def force_at_top(ball, reach, link, links, length, angle, rate):
    """Along the chain: weight and centripetal force of everything that hangs on it."""
    masses = [(ball, reach)] + [(link, (i + 0.5) * length) for i in range(links)]
    return sum(m * (G * math.cos(angle) + rate**2 * r) for m, r in masses)


def plank_bridge():
    planks, length, span, mass, load = 21, 0.5, 10.0, 25, 100

    def angles(horizontal, middle_load):
        """Lean of each plank, from the bank to the middle: tan = vertical over horizontal force in it."""
        half = planks // 2
        return [math.atan((mass * (half - i) + middle_load / 2) * G / horizontal) for i in range(half)]

    def solve(middle_load):
        low, high = 1.0, 1e6  # N
        for _ in range(200):
            middle = (low + high) / 2
            wide = 2 * sum(length * math.cos(a) for a in angles(middle, middle_load)) + length
            low, high = (middle, high) if wide < span else (low, middle)
        return middle

    def shape(lean):
        lean = [-a for a in lean] + [0] + lean[::-1]
        place, centers = [-span / 2, 0, 0], []
        for a in lean:
            centers.append(add(place, [length / 2 * math.cos(a), length / 2 * math.sin(a), 0]))
            place = add(place, [length * math.cos(a), length * math.sin(a), 0])
        return centers, [turn(Z, a) for a in lean]

    height = 3.0
    empty, turns = shape(angles(solve(0), 0))
    pull = solve(load)
    loaded, _ = shape(angles(pull, load))
    end_force = math.hypot(pull, (planks * mass + load) * G / 2)
    half, hooks = planks // 2, []
    edge = [-span / 2, height, 0]
    ends = [add(add(c, rotated(q, [length / 2, 0, 0])), [0, height, 0]) for c, q in zip(empty, turns)]
    hooks.append(hook("left", "hinge", "plank[0]", edge, "bank[0]", axis=Z))
    hooks.append(
        hook("joint", "hinge", "plank[1]", ends[0], "plank", axis=Z,
             array={"list": [add(e, scaled(-1, ends[0])) for e in ends[:-1]]}))
    hooks.append(hook("right", "hinge", f"plank[{planks - 1}]", ends[-1], "bank[1]", axis=Z))
    crate = 0.4
    return scene(
        "Plank bridge",
        "21 planks of 25 kg on hinges, 10.5 m over a gap of 10 m. A crate of 100 kg drops onto the middle one. "
        "By statics each plank leans by the ratio of the vertical to the horizontal force in it: the middle "
        f"then hangs {-loaded[half][1]:.3f} m below the banks, and each end holds {end_force:.0f} N.", 14,
        [-4.2, 4.6, 8.5], [0, 1.9, 0],
        {"ground": {"friction": 0.6}, "sand": {"friction": 0.6}, "oak": {"friction": 0.6},
         "crate": {"friction": 0.6}}, [
             ground(),
             body("bank", "sand", box(2, height / 2, 1.2), [-span / 2 - 2, height / 2, 0], "static",
                  array={"list": [[0, 0, 0], [span + 4, 0, 0]]}),
             body("plank", "oak", box(0.48 * length, 0.03, 0.7), [0, height, 0], mass=mass,
                  linear_damping=1.5, angular_damping=1.5, array={"list": empty, "rotations": turns}),
             body("load", "crate", box(crate / 2, crate / 2, crate / 2),
                  [0, height + empty[half][1] + 0.3 + crate / 2, 0], mass=load, linear_damping=0.5)
         ], [
             promise("height", "==", height + loaded[half][1], f"plank[{half}]", 0.01),
             promise("height", "==", height + loaded[half][1] + 0.03 + crate / 2, "load", 0.015),
             promise("force", "within", end_force, "left", 0.01),
             promise("force", "within", end_force, "right", 0.01),
             promise("gap", "<", 1e-3)
         ], world={"sleeping": False}, hooks=hooks)


def table_glued_legs():
    top, leg, top_mass, leg_mass, load = [0.6, 0.03, 0.4], [0.04, 0.4, 0.04], 20, 4, 40
    height = 0.7
    holds = 300.0  # N
    first, second = (top_mass + load) * G / 4, (top_mass + 3 * load) * G / 4
    corners = [[sx * (top[0] + leg[0]), 0, sz * (top[2] - leg[2])] for sx in (-1, 1) for sz in (-1, 1)]
    crate = [0.2, 0.15, 0.2]
    heights = [height + top[1] + crate[1] * (2 * i + 1) for i in range(3)]
    return scene(
        "Table with glued legs",
        f"Each leg holds the top by glue that gives way above 300 N. One crate of 40 kg: (20 + 40) g / 4 = "
        f"{first:.0f} N, it holds. After two seconds two more are put on it: {second:.0f} N, all four let go, "
        "and the top falls to the floor.", 5, [1.5, 1.5, 2.3], [0, 0.5, 0],
        {"ground": {"friction": 0.6}, "oak": {"friction": 0.6}, "clay": {"friction": 0.6},
         "crate": {"friction": 0.6}}, [
             ground(),
             body("top", "oak", box(*top), [0, height, 0], mass=top_mass),
             body("leg", "clay", box(*leg), [0, leg[1], 0], mass=leg_mass, array={"list": corners}),
             body("crate", "crate", box(*crate), [0, heights[0], 0], mass=load)
         ], [
             *(promise("force", "within", first, f"glue[{i}]", 0.02, 110) for i in range(4)),
             promise("broken", "==", 0, at_step=119),
             promise("height", "==", height, "top", 0.002, 119),
             promise("broken", "==", 4),
             promise("height", "==", top[1], "top", 0.01)
         ], timeline=[{
             "at_step": 120, "add": {
                 "bodies": [body("more", "crate", box(*crate), [0, heights[1], 0], mass=load,
                                 array={"grid": [1, 2, 1], "spacing": [1, 2 * crate[1], 1]})]
             }
         }], hooks=[
             hook("glue", "fixed", "leg[0]", [0, height, 0], "top", break_force=holds,
                  array={"list": [add(c, [-leg[0] if c[0] > 0 else leg[0], 0, 0]) for c in corners]})
         ])


# ---- Dolls ------------------------------------------------------------------------------------------------


def limb(name, material, radius, start, end, **more):
    """A capsule between the centers of its ends."""
    way = add(end, scaled(-1, start))
    length = math.sqrt(sum(x * x for x in way))
    axis = cross(Y, scaled(1 / length, way))
    sine = math.sqrt(sum(x * x for x in axis))
    lean = {"rotation": turn(scaled(1 / sine, axis), math.atan2(sine, way[1] / length))} if sine > 1e-9 else {}
    return body(name, material, {"capsule": {"radius": radius, "half_height": length / 2}},
                scaled(0.5, add(start, end)), **lean, **more)


def limp_doll(name, material, array, **more):
    """Eleven capsules and ten balls without limits, the feet at the origin, the arms spread."""
    parts = {"pelvis": (0.12, [-0.05, 0.95, 0], [0.05, 0.95, 0]), "torso": (0.14, [0, 1.15, 0], [0, 1.35, 0]),
             "head": (0.10, [0, 1.6, 0], [0, 1.68, 0])}
    joints = {"waist": ("pelvis", "torso", [0, 1.03, 0]), "neck": ("torso", "head", [0, 1.49, 0])}
    for side, s in (("left", -1), ("right", 1)):
        parts |= {
            f"{side}_upper_arm": (0.05, [s * 0.22, 1.4, 0], [s * 0.44, 1.4, 0]),
            f"{side}_lower_arm": (0.045, [s * 0.53, 1.4, 0], [s * 0.74, 1.4, 0]),
            f"{side}_thigh": (0.07, [s * 0.1, 0.58, 0], [s * 0.1, 0.82, 0]),
            f"{side}_calf": (0.06, [s * 0.1, 0.08, 0], [s * 0.1, 0.42, 0])
        }
        joints |= {
            f"{side}_shoulder": ("torso", f"{side}_upper_arm", [s * 0.17, 1.4, 0]),
            f"{side}_elbow": (f"{side}_upper_arm", f"{side}_lower_arm", [s * 0.485, 1.4, 0]),
            f"{side}_hip": ("pelvis", f"{side}_thigh", [s * 0.1, 0.87, 0]),
            f"{side}_knee": (f"{side}_thigh", f"{side}_calf", [s * 0.1, 0.5, 0])
        }
    return ([limb(f"{name}_{part}", material, *where, array=array, **more) for part, where in parts.items()], [
        hook(f"{name}_{joint}", "ball", f"{name}_{b}", anchor, f"{name}_{a}", array=array)
        for joint, (a, b, anchor) in joints.items()
    ])


def human(name, material, array, feet=(0, 0, 0)):
    """14 capsules, 1.75 m high; cones, hinges, springs and friction in its joints."""
    spring = {"stiffness": 10, "damping": 2.2}  # 1 Hz and a ratio of 0.7 about 0.25 kg m^2
    parts = {
        "pelvis": (0.13, [-0.07, 0.95, 0], [0.07, 0.95, 0]), "loin": (0.11, [-0.07, 1.08, 0], [0.07, 1.08, 0]),
        "waist": (0.10, [-0.08, 1.2, 0], [0.08, 1.2, 0]), "chest": (0.145, [-0.09, 1.34, 0], [0.09, 1.34, 0]),
        "neck": (0.07, [0, 1.48, 0], [0, 1.53, 0]), "head": (0.0975, [0, 1.62, 0], [0, 1.66, 0])
    }
    balls = {
        "lower_spine": ("pelvis", "loin", [0, 1.01, 0], 25, 5), "middle_spine": ("loin", "waist", [0, 1.14, 0], 25, 5),
        "upper_spine": ("waist", "chest", [0, 1.27, 0], 15, 5), "nape": ("chest", "neck", [0, 1.47, 0], 45, 30),
        "nod": ("neck", "head", [0, 1.56, 0], 15, 60)
    }
    hinges = {}
    for side, s in (("left", -1), ("right", 1)):
        parts |= {
            f"{side}_upper_arm": (0.075, [s * 0.25, 1.4, 0], [s * 0.5, 1.4, 0]),
            f"{side}_lower_arm": (0.05, [s * 0.53, 1.4, 0], [s * 0.83, 1.4, 0]),
            f"{side}_thigh": (0.09, [s * 0.1, 0.505, 0], [s * 0.1, 0.86, 0]),
            f"{side}_calf": (0.075, [s * 0.1, 0.075, 0], [s * 0.1, 0.505, 0])
        }
        balls |= {
            f"{side}_shoulder": ("chest", f"{side}_upper_arm", [s * 0.22, 1.4, 0], 60, 20),
            f"{side}_hip": ("pelvis", f"{side}_thigh", [s * 0.1, 0.9, 0], 10, 10)
        }
        hinges |= {
            f"{side}_elbow": (f"{side}_upper_arm", f"{side}_lower_arm", [s * 0.515, 1.4, 0], [0, -s, 0], 65),
            f"{side}_knee": (f"{side}_thigh", f"{side}_calf", [s * 0.1, 0.505, 0], X, 60)
        }
    made = [
        limb(f"{name}_{part}", material, radius, add(feet, start), add(feet, end), array=array)
        for part, (radius, start, end) in parts.items()
    ]
    hooks = []
    for joint, (a, b, anchor, cone, twist) in balls.items():
        friction = {"nape": 4, "nod": 2}.get(joint, 5)
        axis = [math.copysign(1, anchor[0]), 0, 0] if joint.endswith("shoulder") else Y
        hooks.append(
            hook(f"{name}_{joint}", "ball", f"{name}_{b}", add(feet, anchor), f"{name}_{a}", axis=axis, spring=spring,
                 motor={"max_force": friction}, cone=math.radians(cone),
                 limits={"lower": -math.radians(twist), "upper": math.radians(twist)}, array=array))
    for joint, (a, b, anchor, axis, range_deg) in hinges.items():
        hooks.append(
            hook(f"{name}_{joint}", "hinge", f"{name}_{b}", add(feet, anchor), f"{name}_{a}", axis=axis, spring=spring,
                 motor={"max_force": 5}, limits={"lower": 0, "upper": math.radians(range_deg)}, array=array))
    return made, hooks


def ragdolls():
    bodies, hooks = [], []
    for color, tone in enumerate(TONES):
        places = [[1.2 * (i - 4.5), 1.5 + 0.2 * ((i + 3 * j) % 10), 1.2 * (j - 4.5)] for j in range(10)
                  for i in range(10) if 2 * (j % 2) + i % 2 == color]
        # Each doll passes through itself, and through those two places away.
        more, joints = limp_doll(f"doll_{tone}", tone, {"list": places}, group=-1 - color)
        bodies += more
        hooks += joints
    start = 1.5 + 0.2 * 0 + 0.95
    return scene(
        "A hundred ragdolls",
        "Eleven capsules and ten ball joints without limits each fall from 1.5 to 3.3 m. They fall freely at "
        "first: y0 - g t^2 / 2 after 0.4 s. No joint opens by more than 5 mm, and in the end all lie on the ground.",
        5, [9, 6.5, 13], [0, 0.6, 0], MATERIALS, [ground(), *bodies], [
            fall("doll_sand_pelvis[0]", start, 24),
            promise("gap", "<", 0.005),
            promise("height", "==", 0.15, "doll_sand_head[0]", 0.1),
            promise("height", "==", 0.2, "doll_slate_torso[24]", 0.15),
            promise("kinetic_energy", "<", 50)
        ], world={"sleeping": False}, hooks=hooks)


def ragdoll_stairs():
    steps, rise, tread = 10, 0.25, 0.4
    bodies, hooks = [], []
    for i, tone in enumerate(TONES):
        made, joints = human(f"human_{tone}", tone, {"list": [[-0.3, steps * rise + 0.3, 1.3 * (i - 1.5)]]})
        bodies += made
        hooks += joints
    for one in bodies:  # thrown forward, down the stairs
        one["velocity"] = [2.5, 0, 0]
    start = steps * rise + 0.3 + 0.95
    return scene(
        "Ragdolls on stairs",
        "Four humans of 14 capsules, with cones and hinges in their joints, are thrown down ten stairs. The "
        "pelvis flies as y0 - g t^2 / 2 for 0.2 s; in the end they lie still at the foot, in one piece.", 12,
        [7.6, 5.0, 6.2], [2.4, 0.9, 0], {
            "ground": {"color": [0.20, 0.16, 0.12], "friction": 0.5},
            "steel": {"color": [0.42, 0.38, 0.33], "metalness": 0, "roughness": 0.9, "friction": 0.3}} |
        {tone: {"friction": 0.4} for tone in TONES}, [
            ground(),
            *(body(f"stair_{i}", "steel", box(tread / 2, (steps - i) * rise / 2, 3),
                   [tread * (i + 0.5), (steps - i) * rise / 2, 0], "static") for i in range(steps)),
            body("landing", "steel", box(1.5, steps * rise / 2, 3), [-1.5, steps * rise / 2, 0], "static"), *bodies
        ], [
            promise("height", "==", start - G * 0.2**2 / 2, "human_clay_pelvis[0]", 0.01, 12),
            promise("gap", "<", 0.005),
            *(promise("height", "<", 1.5, f"human_{tone}_pelvis[0]") for tone in TONES),
            promise("kinetic_energy", "<", 0.5)
        ], hooks=hooks, fov_deg=40, **low_sun([0.5, -0.7, -0.6], 1.1))


def joint_grid():
    size, radius = 100, 0.4
    mass = 4 / 3 * math.pi * radius**3 * 1000
    return scene(
        "Grid of joints",
        "A hanging net: 100 x 100 balls of 268 kg, 1 m apart, joined to those beside and above them by 19 800 "
        "ball joints; the highest row is held. Each upper joint carries a column, 99 m g.", 100 / 60,
        [70, -35, 150], [50, -50, 0], {"ground": {}, "steel": {}, "sand": {}}, [
            body("held", "steel", {"sphere": {"radius": radius}}, [0, 0, 0], "static", group=-1,
                 array={"grid": [size, 1, 1], "spacing": [1, 1, 1]}),
            body("ball", "sand", {"sphere": {"radius": radius}}, [0, -1, 0], group=-1,
                 array={"grid": [size, size - 1, 1], "spacing": [1, -1, 1]})
        ], [
            # The net still bounces by a third of its weight.
            promise("force", "within", (size - 1) * mass * 10, "top[50]", 0.4),
            promise("gap", "<", 0.025),
            promise("height", "==", -(size - 1), f"ball[{size * (size - 2) + 50}]", 1)
        ], world={"gravity": [0, -10, 0], "sleeping": False}, hooks=[
            hook("top", "ball", "ball[0]", [0, -0.5, 0], "held",
                 array={"grid": [size, 1, 1], "spacing": [1, 1, 1]}),
            hook("down", "ball", f"ball[{size}]", [0, -1.5, 0], "ball",
                 array={"grid": [size, size - 2, 1], "spacing": [1, -1, 1]}),
            *(hook(f"across_{row}", "ball", f"ball[{size * row + 1}]", [0.5, -1 - row, 0], f"ball[{size * row}]",
                   array={"grid": [size - 1, 1, 1], "spacing": [1, 1, 1]}) for row in range(size - 1))
        ])


def cell():
    """A flat grid of 8 x 8 cells, 15 m wide, and a ring in the x-y plane that is half buried."""
    vertices = [[15 / 8 * (i - 4), 0, 15 / 8 * (j - 4)] for j in range(9) for i in range(9)]
    triangles = []
    for j in range(8):
        for i in range(8):
            a = 9 * j + i
            triangles += [[a, a + 9, a + 1], [a + 1, a + 9, a + 10]]
    first, n = len(vertices), 16
    for i in range(n):
        u = 2 * math.pi * i / n
        for k in range(n):
            v = 2 * math.pi * k / n
            r = 3.75 + math.cos(v)
            vertices.append([r * math.cos(u), r * math.sin(u), math.sin(v)])
    for i in range(n):
        for k in range(n):
            a, b = first + n * i + k, first + n * ((i + 1) % n) + k
            c, d = first + n * ((i + 1) % n) + (k + 1) % n, first + n * i + (k + 1) % n
            triangles += [[a, b, c], [a, c, d]]
    return {"vertices": vertices, "triangles": triangles}


def rain():
    timeline, removed = [], {320: 0, 336: 1, 384: 2}
    for step in (n for n in range(400) if n & 47 == 0):
        column = len([e for e in timeline if "add" in e])
        name = f"column_{column}"
        if step in removed:
            old, _ = human(f"column_{removed[step]}", "sand", None)
            timeline += [{"at_step": step, "remove": one["name"]} for one in old]
            place = removed[step]
        else:
            place = column
        made, joints = human(name, TONES[column % 4], {"grid": [3, 1, 10], "spacing": [2, 1, 15]},
                             [15 * (place - 4.5) - 2, 20, -67.5])
        timeline.append({"at_step": step, "add": {"bodies": made, "hooks": joints}})
    return scene(
        "Rain of ragdolls",
        "Every few steps 30 humans of 14 capsules drop from 20 m onto rings that are half buried; from step 320 on "
        "the first ones are replaced. They fall freely at first: y0 - g t^2 / 2 after 1 s. No joint opens.",
        400 / 60, [-62, 30, 95], [-20, 3, 5],
        {"ground": {"friction": 0.6}} | {tone: {"friction": 0.6, "rolling_friction": 0.02} for tone in TONES}, [
            body("cell", "ground", {"mesh": "cell"}, [-67.5, 0, -67.5], "static",
                 array={"grid": [10, 1, 10], "spacing": [15, 1, 15]})
        ], [
            fall("column_0_pelvis[0]", 20.95, 60, 10),
            promise("gap", "<", 0.02),
            promise("height", ">", 0, "column_4_pelvis[0]"),
            promise("height", "<", 6, "column_4_pelvis[0]")
        ], world={"gravity": [0, -10, 0]}, meshes={"cell": cell()}, timeline=timeline)


HOOK_SCENES = [
    door, wrecking_ball, plank_bridge, table_glued_legs, ragdolls, ragdoll_stairs, joint_grid, rain
]
