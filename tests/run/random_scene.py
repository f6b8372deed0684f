"""A random scene over the whole schema, small enough to run in a moment."""

import math

MOST_STEPS = 400  # of a fluid at rest
MOST_PARTICLES = {2: 500, 3: 1000}  # by dimensions


def log_uniform(dice, low, high):
    return 10 ** dice.uniform(math.log10(low), math.log10(high))


def draw(dice, node):
    """A value that a node of the schema allows; numbers mostly near their default."""
    if "enum" in node:
        return dice.choice(node["enum"])
    if node["type"] == "boolean":
        return dice.random() < 0.5
    if node["type"] == ["object", "null"]:  # a term, which null leaves out
        return None if dice.random() < 0.2 else draw_object(dice, node)
    if node["type"] == "object":
        return draw_object(dice, node)
    low = node.get("minimum", node.get("exclusiveMinimum", 0.0))
    high = node["maximum"]
    usual = node.get("default")
    if usual and dice.random() < 0.7:
        value = usual * log_uniform(dice, 0.3, 3)
    else:
        value = log_uniform(dice, max(low, 1e-3 * high), high)
    value = min(max(value, low, 1e-6 * high), high)
    return round(value) if node["type"] == "integer" else value


def draw_object(dice, node):
    """Former names are left out: beside the present ones they are refused."""
    required = node.get("required", [])
    return {key: draw(dice, child) for key, child in node["properties"].items()
            if key in required or (not child.get("deprecated") and dice.random() < 0.6)}


def draw_numerics(dice, schema):
    numerics = draw_object(dice, schema["properties"]["numerics"])
    # Without a scheme most scenes are refused: they could mean what they meant before there were any.
    numerics["scheme"] = dice.choice(["recommended", "paper"])
    # What is unstable by its Courant number is refused: let most be below the limits.
    usual = "kick_drift_kick" if numerics["scheme"] == "recommended" else "modified_leap_frog"
    leaps = numerics.get("integrator", usual) != "kick_drift_kick"
    if leaps and dice.random() < 0.9:
        numerics.pop("particle_shifting", None)
    step = 0.4 if leaps else 1.2
    if dice.random() < 0.9:
        numerics["courant"] = dice.uniform(0.1, 1.0) * step
    # Of the terms that hold the fluid at walls one may act.
    holding = [key for key in ("laminar_viscosity", "wall_artificial_viscosity", "wall_shear")
               if numerics.get(key)]
    for key in dice.sample(holding, max(len(holding) - 1, 0)):
        numerics[key] = None
    return numerics


def point_in(dice, low, high):
    return [dice.uniform(least, most) for least, most in zip(low, high)]


def draw_polygon(dice, center, half):
    """A star of corners around the center of a plane box."""
    corners = dice.randint(3, 9)
    points = []
    for n in range(corners):
        angle = 2 * math.pi * (n + dice.uniform(0, 0.8)) / corners
        reach = dice.uniform(0.3, 1.0)
        points.append([center[0] + reach * half[0] * math.cos(angle),
                       center[1] + reach * half[1] * math.sin(angle)])
    return points


def draw_shape(dice, low, high):
    """Any shape that lies in a box of the plane or of space."""
    half = [dice.uniform(0.1, 0.499) * (most - least) for least, most in zip(low, high)]
    center = [dice.uniform(least + h, most - h) for least, most, h in zip(low, high, half)]
    in_space = len(low) == 3
    kinds = ("box", "box", "sphere", "ellipsoid", "cylinder", "prism") if in_space else (
        "rectangle", "rectangle", "circle", "ellipse", "polygon")
    kind = dice.choice(kinds)
    if kind in ("rectangle", "box"):
        corner = [c - h for c, h in zip(center, half)]
        if dice.random() < 0.5:
            corner[1] = low[1]  # on the floor
        return {"shape": kind, "corner": corner, "size": [2 * h for h in half]}
    if kind in ("circle", "sphere"):
        return {"shape": kind, "center": center, "radius": min(half)}
    if kind in ("ellipse", "ellipsoid"):
        return {"shape": kind, "center": center, "semi_axes": half}
    if kind == "cylinder":
        along = dice.randrange(3)
        axis = [2 * h if k == along else 0.0 for k, h in enumerate(half)]
        return {"shape": kind, "base": [c - 0.5 * a for c, a in zip(center, axis)], "axis": axis,
                "radius": min(h for k, h in enumerate(half) if k != along)}
    points = draw_polygon(dice, center, half)
    if kind == "prism":
        return {"shape": kind, "points": points, "z": center[2] - half[2], "depth": 2 * half[2]}
    return {"shape": kind, "points": points}


def draw_fluid(dice, size, sound):
    regions = []
    strips = dice.choice([1, 1, 1, 2, 3])  # side by side, so that few overlap
    for n in range(strips):
        low, high = [0.0] * len(size), list(size)
        low[0], high[0] = n * size[0] / strips, (n + 1) * size[0] / strips
        region = draw_shape(dice, low, high)
        if dice.random() < 0.5:
            speed = dice.choice([0.01, 0.05, 0.1, 0.2, 0.4, 0.8]) * sound
            region["velocity"] = point_in(dice, [-speed] * len(size), [speed] * len(size))
        if dice.random() < 0.2:
            rate = dice.choice([0.01, 0.1, 0.3]) * sound / max(size)
            region[dice.choice(["strain_rate", "rotation_rate"])] = dice.choice([-rate, rate])
        if dice.random() < 0.5:
            region["pressure"] = dice.choice(["hydrostatic", "zero"])
        regions.append(region)
    return regions


def draw_sensors(dice, size, end):
    sensors = []
    for n in range(dice.randint(0, 6)):
        kind = dice.choice(["pressure", "arrival", "surface_height", "column_height", "surge_front",
                            "energy"])
        sensor = {"name": f"s{n}", "kind": kind,
                  "interval": dice.choice([0.0, end / 100, end / 7.3])}
        if kind in ("pressure", "arrival"):
            sensor["position"] = point_in(dice, [0] * len(size), size)
        if kind == "surface_height":
            sensor["x"] = dice.uniform(0, size[0])
            if len(size) == 3:
                sensor["z"] = dice.uniform(0, size[2])
        sensors.append(sensor)
    return sensors


def random_scene(dice, schema):
    length = log_uniform(dice, 1e-3, 1e3)  # m
    size = [length * dice.uniform(0.5, 4), length * dice.uniform(0.3, 2)]
    if dice.random() < 0.4:
        size.append(length * dice.uniform(0.3, 2))
    dimensions = len(size)
    height = size[1]
    gravity = 0.0 if dice.random() < 0.15 else log_uniform(dice, 1e-3, 1e4)  # m/s^2
    flow = math.sqrt(gravity * height) if gravity else log_uniform(dice, 1e-3, 1e3)
    sound = flow * log_uniform(dice, 3, 100)
    spacing = (math.prod(size) / dice.uniform(30, MOST_PARTICLES[dimensions])) ** (1 / dimensions)
    numerics = draw_numerics(dice, schema)
    step = numerics.get("courant", 0.25) * spacing / sound
    end = step * log_uniform(dice, 3, MOST_STEPS)
    scene = {
        "name": "random",
        "fluid": draw_fluid(dice, size, sound),
        "gravity": [gravity * dice.uniform(-0.3, 0.3), -gravity],
        "material": {"density": log_uniform(dice, 1e-3, 1e5), "sound_speed": sound},
        "resolution": {"spacing": spacing},
        "numerics": numerics,
        "sensors": draw_sensors(dice, size, end),
        "end_time": end,
    }
    if dimensions == 3:
        scene["dimensions"] = 3
        scene["gravity"].append(gravity * dice.uniform(-0.3, 0.3))
    if dice.random() < 0.8:
        scene["tank"] = {"width": size[0], "height": height * dice.uniform(1.0, 1.5),
                         "open_top": dice.random() < 0.7}
        if dimensions == 3:
            scene["tank"]["depth"] = size[2]
    if dice.random() < 0.4:
        scene["obstacles"] = [draw_shape(dice, [0] * dimensions, size)
                              for _ in range(dice.randint(1, 3))]
    if dice.random() < 0.5:
        scene["resolution"]["smoothing_ratio"] = dice.uniform(0.8, 2.5)
    if dice.random() < 0.3:
        scene["perturbation"] = {"amplitude": log_uniform(dice, 1e-6, 0.5),
                           "seed": dice.randrange(10**9)}
    if dice.random() < 0.15:
        scene["domain"] = {"min": [-length for length in size],
                           "max": [3 * length for length in size]}
    if dice.random() < 0.2:
        scene["output"] = {"frames": {"interval": end / 3.7}}
    if dice.random() < 0.3:
        scene["scales"] = {"height": height, "width": size[0]}
    if gravity > 0 and dice.random() < 0.2:
        del scene["material"]["sound_speed"]
    return scene
