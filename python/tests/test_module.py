"""The module as a whole: types, import, installation, and calls that make no sense."""

import gc
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import kith
import numpy as np
from support import SOURCE


class Import(unittest.TestCase):
    def test_nothing_large_is_imported_before_it_is_needed(self):
        script = ("import sys, kith\nkith.Domain('item-delivery').region\n"
                  "print([m for m in ('numpy', 'pandas', 'matplotlib', 'IPython') if m in sys.modules])")
        printed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(printed.stdout.strip(), "[]")

    def test_numpy_is_not_linked(self):
        file = pathlib.Path(kith._core.__file__)
        self.assertNotIn(b"numpy.core.multiarray", file.read_bytes())

    def test_every_public_thing_is_explained(self):
        for name in kith.__all__:
            thing = getattr(kith, name)
            if name in ("Start", "HalfSpace", "Counts"):
                continue
            self.assertTrue(thing.__doc__, name)
            if isinstance(thing, type) and thing.__module__.startswith("kith"):
                for member, value in vars(thing).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        self.assertTrue(value.__doc__, f"{name}.{member}")


class Types(unittest.TestCase):
    @unittest.skipUnless(shutil.which("stubtest"), "mypy is not installed")
    def test_stubs_are_what_the_module_is(self):
        place = pathlib.Path(kith.__file__).parents[1]
        with tempfile.TemporaryDirectory() as folder:
            found = subprocess.run(["stubtest", "kith._core", "--concise"], cwd=folder, capture_output=True,
                                   text=True, env={**os.environ, "MYPYPATH": str(place), "PYTHONPATH": str(place)})
        differences = [line for line in found.stdout.splitlines() if "metaclass differs" not in line]  # pybind11's own
        self.assertEqual((differences, found.stderr), ([], ""))

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_the_package_is_strict(self):
        place = pathlib.Path(kith.__file__).parent
        with tempfile.TemporaryDirectory() as folder:
            found = subprocess.run(["mypy", "--strict", "--ignore-missing-imports", "--cache-dir", folder, str(place)],
                                   cwd=folder, capture_output=True, text=True)
        self.assertEqual(found.returncode, 0, found.stdout[-4000:])


    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_the_notebooks_are_strict(self):
        place = pathlib.Path(kith.__file__).parents[1]
        with tempfile.TemporaryDirectory() as folder:
            for notebook in (SOURCE / "examples" / "notebooks").glob("*.ipynb"):
                cells = json.loads(notebook.read_text())["cells"]
                code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
                (pathlib.Path(folder) / f"{notebook.stem}.py").write_text("\n".join(code) + "\n")
            found = subprocess.run(["mypy", "--strict", "--ignore-missing-imports", "--cache-dir", f"{folder}/cache", folder],
                                   cwd=folder, capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(place)})
        self.assertEqual(found.returncode, 0, found.stdout[-4000:])


class Installation(unittest.TestCase):
    @unittest.skipUnless(shutil.which("pip3") and shutil.which("cmake"), "pip or cmake is not installed")
    def test_pip_builds_without_a_network(self):
        build = pathlib.Path(kith.__file__).parents[2]
        if not (build / "CMakeCache.txt").exists():
            self.skipTest("the module is not in a build tree")
        with tempfile.TemporaryDirectory() as folder:
            tree = pathlib.Path(folder) / "python"
            shutil.copytree(SOURCE / "python", tree, ignore=shutil.ignore_patterns("tests", "src", "build", "*.egg-info"))
            (pathlib.Path(folder) / "CMakeLists.txt").write_bytes((SOURCE / "CMakeLists.txt").read_bytes())
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-index", "--no-deps",
                            "--target", f"{folder}/there", str(tree)], check=True, env={**os.environ, "KITH_BUILD_DIR": str(build)})
            printed = subprocess.run([sys.executable, "-c", "import kith; print(kith.__file__, len(kith.Domain('item-delivery').worlds))"],
                                     cwd=folder, env={"PYTHONPATH": f"{folder}/there", "PATH": os.environ["PATH"]},
                                     capture_output=True, text=True, check=True)
        self.assertIn("there", printed.stdout)
        self.assertIn("64", printed.stdout)


class Nonsense(unittest.TestCase):
    """Calls with arguments of wrong types, shapes and order: exceptions, or results, and never the end of Python."""

    CALLS = 10_000

    def setUp(self):
        self.draw = random.Random(20_240_424)
        robot = kith.Domain("item-delivery")
        self.robot = robot
        self.objects = [robot, robot._native, robot.region, kith.ParticleBelief(robot.prior, 50), kith.RandomStream(1),
                        kith.Session(robot, "NP", teacher={"particles": 50}), kith.People(robot, "NP", learner={"N": {"particles": 50}}),
                        kith.TeachingEnv(robot, "N", teacher={"particles": 50}), robot.worlds[0], robot.components[0]]
        self.objects.append(self.objects[5]._native)
        self.objects.append(self.objects[6]._native)

    def value(self, depth=0):
        draw = self.draw
        plain = [None, True, 0, 1, 2, -1, 10**3, 2**40, 2**70, -0.5, 1e300, float("nan"), float("inf"), "", "joint", "NP",
                 "\0", "x" * 1000, b"\xff", (), [], {}, (0, 0), (63, 5), (1, -1), (0, 1, -2), [(0, 0, -1)], [(1, 0, 0), (0, 1, 0)],
                 [1.5, 2, 3], object(), int, lambda *args: args, {"particles": 3}, range(3), iter([]), np.zeros(3), np.eye(3),
                 np.eye(3, dtype=np.int8)[::-1, ::2], np.zeros((0, 3)), np.array([np.nan, 1, 2]), np.array("text"),
                 np.array([object()]), np.zeros((2, 2, 2), complex), np.broadcast_to(1.0, (3, 3)), memoryview(b"abc"), bytearray(24)]
        if draw.random() < 0.15:
            return draw.choice(self.objects)
        if depth < 2 and draw.random() < 0.2:
            return [self.value(depth + 1) for _ in range(draw.randrange(4))]
        return draw.choice(plain)

    def test_ten_thousand_calls(self):
        made, refused = 0, 0
        makers = [kith.Cone, kith.ParticleBelief, kith.RandomStream, kith.Session, kith.People, kith.Domain.from_arrays,
                  kith.Domain.from_gymnasium, kith.Domain, kith._core.Array, kith.View, kith.Unit, kith._core.Table, kith.region]
        avoid = {"save", "sample", "cover", "from_text"}
        for _ in range(self.CALLS):
            if self.draw.random() < 0.3:
                call = self.draw.choice(makers)
            else:
                thing = self.draw.choice(self.objects)
                names = [name for name in dir(type(thing)) if name not in avoid and
                         (not name.startswith("_") or name in ("__eq__", "__len__", "__copy__", "__deepcopy__", "__init__", "__hash__"))]
                name = self.draw.choice(names)
                if name == "__init__" and not type(thing).__module__ == "kith._core":
                    continue
                try:
                    call = getattr(thing, name)
                except (kith.Error, ValueError, RuntimeError):
                    refused += 1
                    continue
            try:
                if callable(call):
                    call(*[self.value() for _ in range(self.draw.randrange(4))])
                made += 1
            except (kith.Error, ValueError, TypeError, IndexError, KeyError, AttributeError, OverflowError, RuntimeError,
                    MemoryError, OSError, AssertionError):
                refused += 1
        self.assertGreater(made, self.CALLS / 20)
        self.assertGreater(refused, self.CALLS / 20)
        self.assertEqual(len(self.robot.worlds), 64)


class Lifetimes(unittest.TestCase):
    def test_what_is_left_works_whatever_goes_first(self):
        draw = random.Random(41)
        for _ in range(40):
            robot = kith.Domain("item-delivery")
            session = kith.Session(robot, "NP", teacher={"particles": 50})
            session.propose()
            belief = kith.ParticleBelief(robot.prior, 50)
            people = kith.People(robot, "NP", learner={"N": {"particles": 50}})
            left = {"robot": robot, "session": session, "lesson": session.lesson, "copy": session.copy(), "belief": belief,
                    "points": belief.points, "weights": memoryview(belief.weights), "region": robot.region,
                    "world": robot.worlds[3], "component": robot.components[0], "people": people,
                    "member": session.belief(0), "env": kith.TeachingEnv(robot, "N", teacher={"particles": 50})}
            uses = {"robot": lambda x: x.path((0, 0)), "session": lambda x: x.show(), "lesson": lambda x: repr(x.demonstrations),
                    "copy": lambda x: (x.events, x.belief(1)), "belief": lambda x: x.copy().mass_in(list(region)),
                    "points": lambda x: np.asarray(x).sum(), "weights": lambda x: np.asarray(x).sum(),
                    "region": lambda x: x.contains((-2, 3, -1)), "world": repr, "component": repr,
                    "people": lambda x: x.belief(0), "member": lambda x: np.asarray(x.points).sum(), "env": lambda x: x.reset(seed=1)}
            region = robot.components[0].half_spaces
            del robot, session, belief, people
            while left:
                del left[draw.choice(sorted(left))]
                for name, thing in left.items():
                    if draw.random() < 0.3 and name != "session":
                        uses[name](thing)
                gc.collect(0)

    @unittest.skipUnless(hasattr(os, "fork"), "there is no fork")
    def test_a_forked_process_goes_on_alone(self):
        robot = kith.Domain("item-delivery")
        session = kith.Session(robot, "NP", teacher={"particles": 50})
        with tempfile.TemporaryDirectory() as folder:
            def study(name):
                return kith.study("quick", f"{folder}/{name}", threads=2, progress=False, replicates=2,
                                  teacher={"particles": 50}, stop={"max_periods": 3})
            other = threading.Thread(target=study, args=("parent",))
            other.start()
            children = []
            for n in range(3):  # while another thread is at work
                child = os.fork()
                if child == 0:
                    status = 1
                    try:
                        session.propose()
                        kith.teach(robot, "N", teacher={"particles": 50})
                        study(f"child-{n}")
                        status = 0
                    finally:
                        os._exit(status)
                children.append(child)
                time.sleep(0.05)
            for child in children:
                self.assertEqual(os.waitpid(child, 0)[1], 0)
            other.join()
            tables = [pathlib.Path(folder, name, "tables", "teams.csv").read_bytes()
                      for name in ("parent", "child-0", "child-1", "child-2")]
            self.assertEqual(len(set(tables)), 1)
        session.propose()

    def test_threads_that_share_everything(self):
        robot = kith.Domain("item-delivery")
        session = kith.Session(robot, "NP", teacher={"particles": 50})
        people = kith.People(robot, "NP", learner={"N": {"particles": 50}})
        belief = kith.ParticleBelief(robot.prior, 200)
        met = []

        def work(seed):
            draw = random.Random(seed)
            calls = [session.propose, session.show, session.close_tests, session.give_feedback, session.copy,
                     lambda: session.run_period(people), lambda: session.answer(0, []), lambda: session.events,
                     lambda: belief.diffuse(0.1, kith.RandomStream(seed)), lambda: belief.observe([(-1, 0, 2)]),
                     lambda: np.asarray(belief.points).sum(), lambda: belief.copy().mean, lambda: robot.region,
                     lambda: robot.worlds, lambda: kith.teach(robot, "N", teacher={"particles": 20})]
            for _ in range(60):
                try:
                    draw.choice(calls)()
                except (kith.Error, ValueError, TypeError, IndexError):
                    pass
                except BaseException as error:
                    met.append(repr(error))
        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(met, [])
        self.assertAlmostEqual(float(np.asarray(belief.weights).sum()), 1.0)


if __name__ == "__main__":
    unittest.main()
