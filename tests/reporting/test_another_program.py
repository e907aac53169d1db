"""Another program reads the page of a report and nothing else, and comes to its verdicts with its own arithmetic.

It knows the Circolare 2019 n. 7, C8.7.1.2.1 and C7.2.3, the spectrum of NTC 2018, 3.2.3.2, and the statics of a rigid
wall and of two pillars under a roof. Numbers of the page have seven digits.
"""

import math
import re
from html.parser import HTMLParser

import pytest

import mjrock as mr

G = 9.81
SITE = {"F0": 2.4567, "Tc": 0.3456, "soil": "C", "topography": "T2"}
SLV = mr.code_spectrum("NTC 2018", ag=1.6543, **SITE)
SLC = mr.code_spectrum("NTC 2018", ag=2.1234, **SITE)
BOTH = {"SLV": SLV, "SLC": SLC}
FLOOR = {name: one.at_height(0.2789, 0.0456, participation=1.2345, height=0.6543) for name, one in BOTH.items()}


class Tables(HTMLParser):
    """The tables of a page: rows of cells, of which one that spans several columns stands in each."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.cell, self.span = [], None, 1
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.cell, self.span = "", int(dict(attrs).get("colspan", 1))

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self.tables[-1][-1] += [self.cell.replace("\u00a0", " ").replace("\u2212", "-")] * self.span
            self.cell = None

    def columns(self, first):
        """The rows of all tables whose head begins so, by the name of their column and of the quantity."""
        found = {}
        for head, *rows in (table for table in self.tables if table and table[0][0] == first):
            for row in rows:
                for name, cell in zip(head[1:-1], row[1:-1], strict=True):
                    found.setdefault(name, {}).setdefault(row[0], []).append(cell)
        return found


UNITS = {"": 1, "m": 1, "mm": 1e-3, "kg": 1, "t": 1e3, "kN": 1e3, "s": 1, "%": 1e-2, "m/s²": 1, "kg/m³": 1, "rad": 1}


def numbers(message):
    """The numbers of a text in SI units."""
    found = re.findall(r"(-?\d+(?:\.\d+)?) ?(m/s²|kg/m³|kN|mm|rad|kg|m|t|s|%)?", message)
    return [float(value) * UNITS[unit] for value, unit in found]


def spectrum_of(cells):
    """S_e(T, xi) of NTC 2018 on ground C, with T2, and on a floor where it has periods of a building."""
    ag = numbers(cells["peak acceleration on rock, ag"][0])[0]
    F0, Tc = (numbers(cells[key][0])[0] for key in ("largest amplification, F₀", "corner period on rock, TC*"))
    assert (cells["ground type"], cells["topography"]) == (["C"], ["T2"])
    S = min(max(1.7 - 0.6 * F0 * ag / G, 1.0), 1.5) * 1.2
    TC, TD = 1.05 * Tc**0.67, 4 * ag / G + 1.6

    def on_ground(T, xi):
        eta = max(math.sqrt(10 / (5 + 100 * xi)), 0.55)
        if T < TC / 3:
            part = 3 * T / TC
            return ag * S * eta * F0 * (part + (1 - part) / (eta * F0))
        return ag * S * eta * F0 * min(1.0, TC / T, TC * TD / T**2)

    if not numbers(cells.get("periods of the building, Tk", [""])[0]):
        return on_ground, ag * S, lambda T, xi: on_ground(T, xi) * (T / (2 * math.pi)) ** 2
    keys = ("periods of the building", "damping ratio of the building", "participation of", "shape of the modes")
    T1, xi1, gamma, psi = (
        next(numbers(of[0])[0] for name, of in cells.items() if name.startswith(key)) for key in keys
    )
    peak = on_ground(T1, xi1) * gamma * psi * math.sqrt(1 + 0.0004 * (100 * xi1) ** 2)

    def on_floor(T, xi):
        A = 1.1 * xi1**-0.5 * max(math.sqrt(10 / (5 + 100 * xi)), 0.55)
        below = (1 - T / (0.8 * T1)) ** 1.6 if T < 0.8 * T1 else 0.0
        above = (T / (1.1 * T1) - 1) ** 1.2 if T > 1.1 * T1 else 0.0
        found = A * peak / (1 + (A - 1) * (below + above))
        return max(found, on_ground(T, xi)) if T > T1 else found

    def displaced(T, xi):
        least = on_floor(T1, xi) * (1.1 * T1 / (2 * math.pi)) ** 2 if T > 1.1 * T1 else 0.0
        return max(on_floor(T, xi) * (T / (2 * math.pi)) ** 2, least)

    return on_floor, peak, displaced


def ratios(curve, e_star, FC, tied, demands):
    """Linear, SLV and SLC: of a curve (displacement of the centroid, multiplier) over the rotation up to its end."""
    end, moved, multiplier = curve
    d_0, found = moved(end) / e_star, []
    linear = 2 * (multiplier(0.0) + tied) * G / (e_star * FC) / spectrum_of(demands["SLV"])[1]
    for state, share, factor, xi in (("SLV", 0.4, 1.68, 0.08), ("SLC", 0.6, 1.56, 0.10)):
        low, high = 0.0, end
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if moved(middle) / e_star < share * d_0 else (low, middle)
        T = factor * math.pi * math.sqrt(share * d_0 / (multiplier(low) * G / (e_star * FC)))
        found.append(share * d_0 / spectrum_of(demands[state])[2](T, xi))
    return [linear, *found]


def wall_of(cells):
    """The curve of a rectangular wall with openings, masses, loads and thrusts, its e*, and what its tie adds."""
    t, h, length, rho, inset = (
        numbers(cells[key][0])[0] for key in ("thickness", "height", "length", "density", "inset of the hinge")
    )
    half = t / 2 - inset
    mass, first = t * h * length * rho, t * h * length * rho * h / 2
    for message in cells["opening"]:
        wide, high, sill, *rest = numbers(message)
        gone = wide * high * t * rho * (rest[0] if rest else 1)
        mass, first = mass - gone, first - gone * (sill + high / 2)
    bodies = [(mass * G, first / mass, 0.0)]
    for message in cells.get("added mass 1", []):
        if numbers(message):
            added, z, x = numbers(message)
            bodies.append((added * G, z, x))
    N, z_N, x_N = numbers(cells["load 1"][0])
    z_H, H = numbers(cells["thrust 1"][0])
    W = sum(body[0] for body in bodies)
    z, x = (sum(body[0] * body[i] for body in bodies) / W for i in (1, 2))
    P = W * (half - x) + N * (half - x_N) - H * z_H
    Q = W * z + N * z_N + H * half
    L = half - x
    tied = 0.0
    if numbers(cells.get("tie 1", [""])[0]):
        at, _, _, strength, *_ = numbers(re.sub(r"stiffness [\d.]+ \S+", "stiffness 0", cells["tie 1"][0]))
        tied = strength * at / (W * z)
    curve = (
        math.atan2(P, Q),
        lambda turn: L * (1 - math.cos(turn)) + z * math.sin(turn),
        lambda turn: (P * math.cos(turn) - Q * math.sin(turn)) / (W * (z * math.cos(turn) + L * math.sin(turn))),
    )
    moments = [sum(weight * height**n for weight, height, _ in bodies) for n in (1, 2)]
    return curve, moments[0] ** 2 / (W * moments[1]), tied


def belfry_of(rows):
    """Two pillars that turn about their toes under a roof, which goes along: from the table of the blocks."""
    weights, sizes = {}, {}
    for name, rho, length, _, vertices in rows:
        corners = [[float(x) for x in one.split(";")] for one in re.findall(r"\(([^)]*)\)", vertices)]
        wide, high = (max(of) - min(of) for of in zip(*corners, strict=True))
        weights[name], sizes[name] = float(rho) * float(length) * wide * high * G, (wide, high)
    b, h = sizes["left"]
    P, along = [weights[name] for name in ("left", "right", "roof")], (0.5, 0.5, 1.0)
    shared = sum(p * s for p, s in zip(P, along, strict=True)) / sum(P)
    e_star = shared**2 * sum(P) / sum(p * s**2 for p, s in zip(P, along, strict=True))
    curve = (
        math.atan2(b, h),
        lambda turn: shared * (b * (1 - math.cos(turn)) + h * math.sin(turn)),
        lambda turn: (b * math.cos(turn) - h * math.sin(turn)) / (b * math.sin(turn) + h * math.cos(turn)),
    )
    return curve, e_star


def assert_as_the_page(page, name, found, check):
    """Its ratios are those of the check, and its verdicts those that the first page prints."""
    expected = [check.linear_ratio, check.states["SLV"].ratio, check.states["SLC"].ratio]
    assert found == pytest.approx(expected, rel=2e-6)
    rows = next(table for table in page.tables if table[0][0] == "mechanism")
    start = next(i for i, row in enumerate(rows) if row[0].startswith(name))
    printed = [row[-6:] for row in rows[start : start + 3]]
    printed[0] = rows[start][-6:]
    for (_, _, _, ratio, verdict, _), own in zip(printed, found, strict=True):
        assert ("HOLDS" in verdict) is (own >= 1)
        assert 0 <= own - float(ratio) < 0.01


@pytest.mark.slow
def test_the_verdicts_of_walls_follow_from_the_page_alone(tmp_path):
    """On the ground and on a floor, bare and tied: linear, SLV and SLC."""
    openings = [mr.Opening(1.1357, 2.0864, 0.9753)] * 2
    wall = mr.Block.from_size(0.7123, 5.1234, 6.4321, 1912.0, 0.0123, openings)
    bare = mr.Load(23456.0, 5.0123, -0.1111), mr.Thrust(4.5551, 2345.6), mr.AddedMass(1234.5, 5.0001, -0.0543)
    tie = mr.Tie(4.4441, 2.3456e7, strength=34567.0, ultimate=0.0246)
    cases = {"plain": mr.Case(wall, 0.0, 1.0, effects=bare), "tied": mr.Case(wall, 0.0, 1.0, effects=(*bare, tie))}
    checks = {name: mr.mechanism_check(case, BOTH) for name, case in cases.items()}
    checks["raised"] = mr.mechanism_check(cases["plain"], FLOOR, confidence_factor=1.2)
    path = mr.report(cases["plain"], (), tmp_path / "a.html", checks=checks)
    page = Tables(re.sub(r"base64,[^\"]*", "", path.read_text(encoding="utf-8")))
    given, steps = page.columns("quantity"), page.columns("step")
    for name, check in checks.items():
        cells = next(of for heading, of in given.items() if name in heading.split("; "))
        demands = {state: next(of for key, of in given.items() if f"{name}, {state}" in key) for state in BOTH}
        curve, e_star, tied = wall_of(cells)
        (FC,) = numbers(steps[name]["confidence factor"][0])
        assert_as_the_page(page, name, ratios(curve, e_star, FC, tied, demands), check)


@pytest.mark.slow
def test_the_verdict_of_blocks_follows_from_their_table(tmp_path):
    def block(name, left, right, low, high, density=1812.0):
        corners = [(left, low), (right, low), (right, high), (left, high)]
        return mr.Polygon(corners, density, length=2.0123, fixed=name == "tower", name=name)

    pillars = block("left", 0.0, 0.9123, 0.0, 4.5678), block("right", 4.1, 5.0123, 0.0, 4.5678)
    blocks = [block("tower", -1.0, 6.0, -0.5, 0.0), *pillars, block("roof", -0.1, 5.1, 4.5678, 5.7891, 1456.0)]
    belfry = mr.Masonry(blocks, k_n=1e9, friction=0.6)
    check = mr.mechanism_check(mr.limit_curve(belfry, 1), FLOOR)
    path = mr.report(mr.MasonryCase(belfry, 1.0), (), tmp_path / "a.html", checks={"belfry": check})
    page = Tables(re.sub(r"base64,[^\"]*", "", path.read_text(encoding="utf-8")))
    given, steps = page.columns("quantity"), page.columns("step")
    demands = {state: next(of for key, of in given.items() if f"belfry, {state}" in key) for state in BOTH}
    curve, e_star = belfry_of(next(table for table in page.tables if table[0][0] == "block")[1:])
    (FC,) = numbers(steps["belfry"]["confidence factor"][0])
    assert_as_the_page(page, "belfry", ratios(curve, e_star, FC, 0.0, demands), check)
