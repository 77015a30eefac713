# SPDX-License-Identifier: BSD-3-Clause
"""Runs for other programs: every format is read back without any code of livens.

    LIVENS_PROGRAM=build/release/livens python3 export_test.py [CLASS ...]

What NumPy, netCDF4, vtk, or node with gltf-validator (NODE_PATH) are needed for is skipped where they are missing.
"""
import csv
import importlib.util
import json
import math
import re
import shutil
import struct
import subprocess
import unittest
import xml.etree.ElementTree
import zipfile

from program_test import IO, SMALL, USAGE, ProgramTest, text_with

SPIN = "angular_velocity = [0.7, -1.1, 2]\nrotation_vector = [0.3, 0.2, -0.1]\nvelocity = [0.5, 0, 0.25]\n"
# Name, shape and mass, volume; the second box has its centre elsewhere.
SHAPES = {
    "box": ("shape = { box = [0.3, 0.2, 0.1] }\ndensity = 1000", 0.006),
    "aside": ("shape = { box = [0.3, 0.2, 0.1] }\ndensity = 1000\ncenter_of_mass = [1, 2, 3]", 0.006),
    "ball": ("shape = { sphere = 0.2 }\nmass = 2", 4 / 3 * math.pi * 0.2**3),
    "rod": ("shape = { cylinder = { radius = 0.1, length = 0.5 } }\nmass = 2", math.pi * 0.1**2 * 0.5),
    "tube": ("shape = { cylinder = { radius = 0.1, length = 0.5, inner_radius = 0.08 } }\nmass = 2",
             math.pi * (0.1**2 - 0.08**2) * 0.5),
    "pill": ("shape = { capsule = { radius = 0.1, length = 0.3 } }\nmass = 2",
             math.pi * 0.1**2 * 0.3 + 4 / 3 * math.pi * 0.1**3),
    "egg": ("shape = { ellipsoid = [0.3, 0.2, 0.1] }\nmass = 2", 4 / 3 * math.pi * 0.006),
    "hat": ("shape = { cone = { radius = 0.2, height = 0.6 } }\nmass = 2", math.pi * 0.2**2 * 0.6 / 3),
    "bare": ("mass = 2\ninertia = [1, 1, 1]\ncenter_of_mass = [0, 0.5, 0]", None),
}
BODIES = "".join(f'[[body]]\nname = "{name}"\n{lines}\nposition = [{i}, 0, 0]\n{SPIN}\n'
                 for i, (name, (lines, _)) in enumerate(SHAPES.items()))
ALL = (f'format = 1\ntitle = "all & <shapes>"\ngravity = [0, -3, -4]\n{BODIES}[[body]]\nname = "dot"\n'
       'shape = { point = true }\nmass = 1\n[time]\nend = 0.5\nelements = 10\n')


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def turned(q, v):
    """By a quaternion (x, y, z, w)."""
    t = [2 * x for x in cross(q[:3], v)]
    return [x + q[3] * y + z for x, y, z in zip(v, t, cross(q[:3], t))]


def volume_and_centroid(points, triangles):
    """By the divergence theorem: right only if the surface is closed and seen from outside goes round to the left."""
    volume, moment = 0, [0, 0, 0]
    for corners in triangles:
        a, b, c = (points[i] for i in corners)
        part = dot(a, cross(b, c)) / 6
        volume += part
        for i in range(3):
            moment[i] += part * (a[i] + b[i] + c[i]) / 4
    return volume, [m / volume for m in moment]


def sample(test, body, t):
    return json.loads(test.expect(0, "sample", "run.nc", "--body", body, "--at", repr(t), "--json").out)


def assert_near(test, a, b, delta, message=""):
    test.assertEqual(len(a), len(b))
    for x, y in zip(a, b):
        test.assertAlmostEqual(x, y, delta=delta, msg=message)


def check_shape(test, name, points, triangles):
    """Its volume; returns the centroid."""
    volume, centroid = volume_and_centroid(points, triangles)
    exact = SHAPES[name][1]
    if exact is not None:
        test.assertLess(volume, exact * (1 + 1e-5), name)
        test.assertGreater(volume, exact * (0.99999 if "box" in SHAPES[name][0] else 0.95), name)
    return centroid


class Formats(ProgramTest):
    def test_one_table(self):
        """Help, completion and what an empty call asks for name the same formats."""
        self.solve()
        text = self.expect(USAGE, "export", "run.nc").err
        words = re.findall(r"--([a-z]+)", text)
        self.assertEqual(words, ["csv", "npz", "gltf", "pvd", "webm", "gif", "png", "svg"])
        page, script = self.expect(0, "export", "--help").out, self.expect(0, "completion", "bash").out
        for word in words:
            extension = "glb" if word == "gltf" else word
            self.assertRegex(page, rf"--{word} FILE\.{extension}")
            self.assertIn(f"'export --{word}') _livens_files '*.{extension}'", script)

    def test_several_at_once(self):
        self.solve()
        done = json.loads(self.expect(0, "export", "run.nc", "--npz", "a.npz", "--gltf", "b.glb", "--json").out)
        self.assertEqual(done, {"npz": "a.npz", "gltf": "b.glb", "converged": True})
        self.assertEqual(self.files(), ["a.npz", "b.glb", "run.nc", "run.nc.json", "small.toml"])

    def test_same_run_same_bytes(self):
        self.solve()
        for word, names in (("npz", ("a.npz", "b.npz")), ("gltf", ("a.glb", "b.glb")), ("csv", ("a.csv", "b.csv"))):
            for name in names:
                self.expect(0, "export", "run.nc", f"--{word}", name)
            self.assertEqual(*((self.folder / name).read_bytes() for name in names), word)

    def test_nothing_is_overwritten_that_is_a_result_or_a_record(self):
        self.solve()
        shutil.copy(self.folder / "run.nc", self.folder / "other.csv")
        shutil.copy(self.folder / "run.nc", self.folder / "other.glb")
        shutil.copy(self.folder / "run.nc.json", self.folder / "record.npz")
        before = {name: (self.folder / name).read_bytes() for name in self.files()}
        for option in (("--csv", "run.nc"), ("--gltf", "run.nc.json"), ("--csv", "other.csv"), ("--gltf", "other.glb"),
                       ("--npz", "record.npz"), ("--pvd", "."), ("--npz", "missing/x.npz"), ("--csv", "/dev/stdout")):
            self.expect(IO, "export", "run.nc", *option)
        for option in (("--gltf", "x.gltf"), ("--npz", "x"), ("--pvd", "x.vtp"), ("--csv", "x.txt")):
            self.assertIn("end in", self.expect(USAGE, "export", "run.nc", *option).err)
        self.expect(IO, "solve", "small.toml", "-o", "new.nc", "--csv", "other.csv")
        self.assertEqual({name: (self.folder / name).read_bytes() for name in self.files()}, before)

    def test_cells_like_formulas(self):
        names = ["=1+2", "-3", "+4", "@sum", " =x", "plain-name", "a,b"]
        bodies = "".join(f'[[body]]\nname = "{name}"\nshape = {{ point = true }}\nmass = 1\nposition = [-{i}, 0, 0]\n'
                         for i, name in enumerate(names))
        self.solve(f"format = 1\n{bodies}[time]\nend = 1\nelements = 2\n")
        self.expect(0, "export", "run.nc", "--csv", "run.csv")
        text = (self.folder / "run.csv").read_text()
        header, first = list(csv.reader(text.splitlines()))[:2]
        cells = [cell for cell in header if cell.endswith(".position.x [m]")]
        self.assertEqual([cell.removesuffix(".position.x [m]") for cell in cells],
                         ["'=1+2", "'-3", "'+4", "'@sum", "' =x", "plain-name", "a,b"])
        self.assertIn('"\'=1+2.position.x [m]"', text)
        self.assertFalse([cell for cell in header if cell.strip()[0] in "=+-@"])
        self.assertIn(",-3,", text.splitlines()[1])   # numbers stay numbers
        self.assertEqual(float(first[header.index("'+4.position.x [m]")]), -2)

    def test_runs_that_end_early(self):
        one_leap = text_with("end = 0.5\nelements = 10\noutput = 0.1", "end = 50\nelements = 1")
        method = 'family = "midpoint"\nmax_iterations = 1'
        self.write("small.toml", one_leap.replace('family = "lobatto"\ndegree = 4', method))
        self.run_program("solve", "small.toml", "-o", "run.nc")
        self.expect(0, "export", "run.nc", "--npz", "a.npz", "--gltf", "a.glb", "--pvd", "a.pvd", "--csv", "a.csv")
        self.assertNotIn("animations", Gltf.parts(self.folder / "a.glb")[0])   # one instant, the start
        self.assertEqual(len(list((self.folder / "a").iterdir())), 1)


class Npz(ProgramTest):
    def test_zip_is_whole(self):
        self.solve()
        self.expect(0, "export", "run.nc", "--npz", "run.npz")
        with zipfile.ZipFile(self.folder / "run.npz") as archive:
            self.assertIsNone(archive.testzip())
            self.assertIn("estimated_position_error.npy", archive.namelist())
            self.assertTrue(all(entry.extract_version == 45 for entry in archive.infolist()), "4.5: 64 bits")
            for entry in archive.infolist():   # heads of arrays end at a multiple of 64
                head = archive.read(entry)[:10]
                self.assertEqual(head[:8], b"\x93NUMPY\x01\x00")
                self.assertEqual((10 + struct.unpack("<H", head[8:])[0]) % 64, 0)

    def test_numpy_reads_what_netcdf4_reads(self):
        for module in ("numpy", "netCDF4"):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"{module} is not installed")
        import netCDF4
        import numpy
        self.solve(SMALL.replace('"bob"', '"größer 𝄞"'))
        self.expect(0, "export", "run.nc", "--npz", "run.npz")
        archive, file = self.folder / "run.npz", self.folder / "run.nc"
        with numpy.load(archive, allow_pickle=False) as npz, netCDF4.Dataset(file) as run:
            self.assertEqual(set(npz.files), set(run.variables) | {"variable", "unit"})
            unit = dict(zip(npz["variable"], npz["unit"]))
            for name, variable in run.variables.items():
                self.assertEqual(unit[name], variable.units, name)
                there = numpy.ma.getdata(variable[:])
                if variable.dtype != "S1":
                    numpy.testing.assert_array_equal(npz[name], there, name)
                elif npz[name].ndim == 0:
                    self.assertEqual(str(npz[name]), str(there), name)
                else:
                    self.assertEqual(npz[name].tolist(), there.tolist(), name)
            self.assertEqual(npz["body"].tolist(), ["brick", "größer 𝄞"])
            self.assertEqual((npz["position"].dtype, npz["position"].shape), (numpy.dtype("<f8"), (6, 2, 3)))
            self.assertEqual(npz["is_point_mass"].tolist(), [0, 1])
            self.assertEqual(json.loads(str(npz["manifest"]))["convergence"]["status"], "converged")


class Gltf(ProgramTest):
    @staticmethod
    def parts(file):
        data = file.read_bytes()
        magic, version, size, json_size, kind = struct.unpack_from("<4sIII4s", data)
        assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON")
        binary_size, kind = struct.unpack_from("<I4s", data, 20 + json_size)
        assert kind == b"BIN\0" and 28 + json_size + binary_size == size
        return json.loads(data[20:20 + json_size]), data[28 + json_size:]

    def read(self, accessor):
        a = self.gltf["accessors"][accessor]
        view = self.gltf["bufferViews"][a["bufferView"]]
        n = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
        kind = {5125: "I", 5126: "f"}[a["componentType"]]
        numbers = struct.unpack_from(f"<{n * a['count']}{kind}", self.binary, view["byteOffset"])
        for part, pick in (("min", min), ("max", max)):
            if part in a:
                self.assertEqual(a[part], [pick(numbers[i::n]) for i in range(n)])
        return [numbers[i:i + n] for i in range(0, len(numbers), n)] if n > 1 else list(numbers)

    def export(self, text):
        self.solve(text)
        self.expect(0, "export", "run.nc", "--gltf", "run.glb")
        self.gltf, self.binary = self.parts(self.folder / "run.glb")

    def cubic(self, sampler, t):
        times, values = self.read(sampler["input"]), self.read(sampler["output"])
        k = max(i for i in range(len(times) - 1) if times[i] <= t)
        h = times[k + 1] - times[k]
        s = (t - times[k]) / h
        weights = (2 * s**3 - 3 * s**2 + 1, h * (s**3 - 2 * s**2 + s), -2 * s**3 + 3 * s**2, h * (s**3 - s**2))
        parts = (values[3 * k + 1], values[3 * k + 2], values[3 * k + 4], values[3 * k + 3])
        return [sum(w * p[i] for w, p in zip(weights, parts)) for i in range(len(parts[0]))]

    def test_meshes_are_the_shapes(self):
        self.export(ALL)
        for node in self.gltf["nodes"][1:]:
            self.assertEqual(self.gltf["meshes"][node["mesh"]]["name"], node["name"])
            part = self.gltf["meshes"][node["mesh"]]["primitives"][0]
            points, normals = (self.read(part["attributes"][key]) for key in ("POSITION", "NORMAL"))
            corners = self.read(part["indices"])
            triangles = [corners[i:i + 3] for i in range(0, len(corners), 3)]
            self.assertEqual(len(points), len(normals))
            for a, b, c in triangles:
                edges = [[q - p for p, q in zip(points[a], points[x])] for x in (b, c)]
                face = cross(*edges)
                self.assertGreater(dot(face, face), 0)
                for corner in (a, b, c):
                    self.assertAlmostEqual(dot(normals[corner], normals[corner]), 1, delta=1e-6)
                    self.assertGreater(dot(face, normals[corner]), 0.7 * math.sqrt(dot(face, face)))
            if node["name"] != "dot":
                s = sample(self, node["name"], 0.0)
                centroid = check_shape(self, node["name"], points, triangles)
                place = [x + y for x, y in zip(node["translation"], turned(node["rotation"], centroid))]
                assert_near(self, place, s["center_of_mass"], 1e-6, node["name"])

    def test_names_ground_and_up(self):
        self.export(ALL)
        world = self.gltf["nodes"][0]
        self.assertEqual((world["name"], world["children"]), ("world", list(range(1, 11))))
        self.assertEqual([n["name"] for n in self.gltf["nodes"][1:]], [*SHAPES, "dot"])
        self.assertEqual(self.gltf["scenes"][0]["name"], "all & <shapes>")
        assert_near(self, turned(world["rotation"], [0, -0.6, -0.8]), [0, -1, 0], 1e-12)   # gravity is down
        ground = self.read(self.gltf["meshes"][world["mesh"]]["primitives"][0]["attributes"]["POSITION"])
        heights = [dot(p, [0, 0.6, 0.8]) for p in ground]
        self.assertLess(max(heights) - min(heights), 1e-5)
        for name in SHAPES:
            for t in (0.0, 0.25, 0.5):
                self.assertLess(heights[0], dot(sample(self, name, t)["center_of_mass"], [0, 0.6, 0.8]))
        for gravity in ("[0, 0, 0]", "[0, 5, 0]", "[0, -5, 0]", "[3, 0, 0]"):
            self.export(text_with("[0, 0, -9.81]", gravity))
            g = json.loads(gravity)
            down = [x / (math.hypot(*g) or 1) for x in g] if any(g) else [0, 0, -1]
            assert_near(self, turned(self.gltf["nodes"][0]["rotation"], down), [0, -1, 0], 1e-12)

    def test_tracks_are_the_motion_between_keys_too(self):
        """The cubics of a player against the polynomials of the elements."""
        self.export(text_with("elements = 10\noutput = 0.1\n", "elements = 20\n"))
        animation = self.gltf["animations"][0]
        seen = set()
        for channel in animation["channels"]:
            node = self.gltf["nodes"][channel["target"]["node"]]
            sampler = animation["samplers"][channel["sampler"]]
            self.assertEqual(sampler["interpolation"], "CUBICSPLINE")
            for t in (0.01, 0.12, 0.1375, 0.49):
                s = sample(self, node["name"], t)
                value = self.cubic(sampler, t)
                if channel["target"]["path"] == "translation":
                    assert_near(self, value, s["position"], 1e-5, f"{node['name']} at {t}")
                else:
                    w, x, y, z = s["quaternion"]
                    size = math.hypot(*value)
                    sign = math.copysign(1, dot(value, (x, y, z, w)))
                    assert_near(self, [sign * v / size for v in value], (x, y, z, w), 1e-5, f"{node['name']} at {t}")
            seen.add((node["name"], channel["target"]["path"]))
        self.assertEqual(seen, {("brick", "translation"), ("brick", "rotation"), ("bob", "translation")})

    def test_validator_has_nothing_to_say(self):
        node = shutil.which("node")
        script = "try { require.resolve('gltf-validator') } catch (e) { process.exit(9) }"
        if node is None or subprocess.run([node, "-e", script]).returncode != 0:
            self.skipTest("node with gltf-validator is not installed (NODE_PATH names its folder)")
        close = ('format = 1\n[[body]]\nname = "dot"\nshape = { point = true }\nmass = 1\n[time]\nstart = -3\nend = 100\n'
                 'elements = 10\noutput = [50, 50.0000001, 100]\n')   # two are one in single precision
        for text in (ALL, SMALL, close):
            self.export(text)
            check = ("require('gltf-validator').validateBytes(new Uint8Array(require('fs').readFileSync('run.glb')))"
                     ".then(report => console.log(JSON.stringify(report)))")
            done = subprocess.run([node, "-e", check], cwd=self.folder, stdout=subprocess.PIPE, check=True)
            issues = json.loads(done.stdout)["issues"]
            self.assertEqual((issues["numErrors"], issues["numWarnings"], issues["numInfos"]), (0, 0, 0), issues)


class Pvd(ProgramTest):
    def export(self, text=ALL, file="run.pvd"):
        self.solve(text)
        self.expect(0, "export", "run.nc", "--pvd", file)
        tree = xml.etree.ElementTree.parse(self.folder / file)
        return [(float(d.get("timestep")), self.folder / d.get("file")) for d in tree.iter("DataSet")]

    def read(self, file):
        """Arrays by name; every number stands behind the text."""
        head, rest = file.read_bytes().split(b'<AppendedData encoding="raw">\n_', 1)
        root = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
        arrays = {}
        for array in root.iter("DataArray"):
            if array.get("format") == "ascii":
                continue
            at, code = int(array.get("offset")), {"Float32": "f", "Int32": "i"}[array.get("type")]
            size = struct.unpack_from("<Q", rest, at)[0]
            numbers = struct.unpack_from(f"<{size // 4}{code}", rest, at + 8)
            n = int(array.get("NumberOfComponents"))
            arrays[array.get("Name")] = [numbers[i:i + n] for i in range(0, len(numbers), n)] if n > 1 else numbers
        names = bytes(map(int, root.find(".//Array[@Name='body_name']").text.split())).split(b"\0")[:-1]
        return arrays, [name.decode() for name in names]

    def test_surfaces_are_where_the_bodies_are(self):
        files = self.export()
        self.assertEqual([t for t, _ in files], [i / 20 for i in range(11)])
        for t, file in files[::5]:
            arrays, names = self.read(file)
            self.assertEqual(names, [*SHAPES, "dot"])
            self.assertEqual(list(arrays["offsets"]), list(range(3, 3 * len(arrays["body"]) + 1, 3)))
            for number, name in enumerate(SHAPES):
                own = [i for i, body in enumerate(arrays["body"]) if body == number]
                triangles = [arrays["connectivity"][3 * i:3 * i + 3] for i in own]
                s = sample(self, name, t)
                assert_near(self, check_shape(self, name, arrays["Points"], triangles), s["center_of_mass"], 1e-4, name)
                corner = triangles[0][0]   # moves with its body
                arm = [p - q for p, q in zip(arrays["Points"][corner], s["position"])]
                velocity = [v + w for v, w in zip(s["velocity"], cross(s["angular_velocity"], arm))]
                assert_near(self, arrays["velocity"][corner], velocity, 1e-5, name)

    def test_names_that_xml_minds(self):
        files = self.export(SMALL, 'a&b <"c">.pvd')
        self.assertEqual(len(files), 6)
        self.assertTrue(all(file.is_file() for _, file in files))
        self.assert_no_temporaries()

    def test_vtk_opens_it(self):
        if importlib.util.find_spec("vtkmodules") is None:
            self.skipTest("vtk is not installed")
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        for t, file in self.export():
            problems = []
            reader = vtkXMLPolyDataReader()
            reader.AddObserver("ErrorEvent", lambda *seen: problems.append(seen))
            reader.AddObserver("WarningEvent", lambda *seen: problems.append(seen))
            reader.SetFileName(str(file))
            reader.Update()
            data = reader.GetOutput()
            arrays, names = self.read(file)
            self.assertEqual((problems, data.GetNumberOfPoints()), ([], len(arrays["Points"])))
            self.assertEqual(data.GetNumberOfPolys(), len(arrays["body"]))
            self.assertEqual(data.GetPointData().GetVectors().GetName(), "velocity")
            self.assertEqual(data.GetFieldData().GetArray("TimeValue").GetValue(0), t)
            texts = data.GetFieldData().GetAbstractArray("body_name")
            self.assertEqual([texts.GetValue(i) for i in range(texts.GetNumberOfValues())], names)
            last = len(arrays["Points"]) - 1
            assert_near(self, data.GetPoint(last), arrays["Points"][last], 0)


if __name__ == "__main__":
    unittest.main()
