"""Holds the published reference curves against the scenes that bear them and, where it is there,
against the data that they were made from.

Usage: check_references.py ROOT
"""

import csv
import json
import math
import pathlib
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".").resolve()
SERIES = ROOT / "schemas" / "references" / "series"
SCENES = ROOT / "schemas" / "examples"
SOURCE = ROOT.parent / "shared" / "reference"


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def rows(name):
    with open(SOURCE / name, encoding="utf-8", newline="") as stream:
        lines = [line for line in stream if not line.startswith("#")]
    return [tuple(map(float, row)) for row in list(csv.reader(lines))[1:]]


def curve(name, sensor):
    found = [one for one in read(SERIES / name)["curves"] if one["sensor"] == sensor]
    return list(zip(found[0]["time"], found[0]["value"]))


class References(unittest.TestCase):
    def test_each_stands_in_an_example_as_it_was_published(self):
        published = {read(path)["title"]: read(path) for path in SERIES.glob("*.json")}
        self.assertTrue(published)
        seen = set()
        for path in SCENES.glob("*.json"):
            reference = read(path).get("reference", {})
            if reference.get("title") in published:
                self.assertEqual(reference, published[reference["title"]], path.name)
                seen.add(reference["title"])
        self.assertEqual(seen, set(published))

    def test_martin_moyce_is_the_table_in_units_of_h0(self):
        if not SOURCE.is_dir():
            self.skipTest("the tables are not here")
        # h0 = 2 a: T = t sqrt(g/h0), against t sqrt(2 g/a) of Table 2 and t sqrt(g/a) of Table 6.
        front = [(t / 2, x) for t, x in rows("martin_moyce1952_n2_2_a2.25_front_Table2.csv")]
        column = [(t / math.sqrt(2), h)
                  for t, h in rows("martin_moyce1952_n2_2_a2.25_height_Table6.csv")]
        for sensor, table in (("front", front), ("column", column)):
            held = curve("martin_moyce1952.json", sensor)
            self.assertEqual(len(held), len(table))
            for (time, value), (t, v) in zip(held, table):
                self.assertAlmostEqual(time, t, delta=6e-5)
                self.assertEqual(value, v)

    def test_spheric_test_2_is_the_record_in_means_over_20_ms(self):
        if not SOURCE.is_dir():
            self.skipTest("the record is not here")
        record = rows("kleefsman2005_spheric2_half_1ms.csv")
        for column, sensor in enumerate(("P1", "P3", "P5", "P7", "H2", "H4"), start=1):
            held = curve("kleefsman2005_spheric2.json", sensor)
            self.assertEqual(len(held), 300)
            for time, value in held:
                near = [row[column] for row in record if time - 0.01 <= row[0] < time + 0.01]
                self.assertGreaterEqual(len(near), 19)
                self.assertAlmostEqual(value, sum(near) / len(near),
                                       delta=1 + 0.02 * (max(near) - min(near)) if sensor[0] == "P"
                                       else 1e-4 + 0.1 * (max(near) - min(near)))

    def test_the_standing_wave_is_that_of_linear_theory(self):
        length, depth, amplitude, gravity = 2.0, 1.0, 0.05, 9.81
        k = math.pi / length
        omega = math.sqrt(gravity * k * math.tanh(k * depth))
        for time, value in curve("standing_wave.json", "wall"):
            self.assertAlmostEqual(value, depth + amplitude * math.cos(omega * time), delta=1e-5)

    def test_the_drop_keeps_its_area_and_its_kinetic_energy(self):
        # (db/dt)^2 (1 + b^-4) = 2, differentiated over neighbouring points of the table.
        points = [(0.0, 1.0)] + curve("elliptical_drop.json", "pole")
        for (t0, b0), (t1, b1) in zip(points, points[1:]):
            middle = 0.5 * (b0 + b1)
            energy = ((b1 - b0) / (t1 - t0)) ** 2 * (1 + middle ** -4)
            self.assertAlmostEqual(energy, 2.0, delta=4e-3)

    def test_still_water_has_the_weight_of_what_is_above(self):
        study = read(SCENES / "study-still.json")["scene"]
        sensors = {one["name"]: one for one in study["sensors"]}
        depth = study["fluid"][0]["size"][1]
        for one in study["reference"]["curves"]:
            sensor = sensors[one["sensor"]]
            expected = depth
            if sensor["kind"] == "pressure":
                expected = (study["material"]["density"] * -study["gravity"][1]
                            * (depth - sensor["position"][1]))
            for value in one["value"]:
                self.assertAlmostEqual(value, expected, places=6)


if __name__ == "__main__":
    unittest.main()
