"""Models of PRISM and Gymnasium as tables: python/kith/convert.py. Needs neither the module nor numpy."""

import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python" / "kith"))

import convert  # noqa: E402

PROGRAM = os.environ.get("KITH_PROGRAM", "")

PRISM = {
    "ice.tra": "3 4 6\n0 0 1 1 go\n1 0 0 1/4 go\n1 0 2 3/4 go\n1 1 1 0.5 creep\n1 1 2 0.5 creep\n2 0 2 1\n",
    "ice.sta": "(x)\n0:(0)\n1:(1)\n2:(2)\n",
    "ice.lab": "# Labels\n0=\"init\" 1=\"deadlock\" 2=\"goal\" 3=\"start\"\n0: 0 3\n1: 3\n2: 2\n",
    "ice.slip.trew": "# Reward structure \"slip\"\n# Transition rewards\n3 4 1\n1 0 0 1\n",
    "ice.step.srew": "# Reward structure \"step\"\n# State rewards\n3 2\n0 1\n1 1\n",
    "domain.toml": """schema = "kith.domain/1"
id = "ice"
[model]
format = "prism"
terminal = "goal"
start = "start"
[[model.mdp]]
transitions = "ice.tra"
states = "ice.sta"
labels = "ice.lab"
rewards = { slip = "ice.slip.trew", step = ["ice.step.srew"] }
[[feature]]
name = "slip"
[[feature]]
name = "step"
[reward]
weights = { slip = -2, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
"""}

GYM = {
    "ice.json": """{"P": {
 "0": {"0": [[1.0, 1, -1.0, false]], "1": [[1.0, 0, -1.0, false]]},
 "1": {"0": [[0.75, 2, -1.0, true], [0.25, 0, -3.0, false]], "1": [[0.5, 2, -1.0, true], [0.5, 1, -1.0, false]]},
 "2": {"0": [[1.0, 2, 0, true]], "1": [[1.0, 2, 0, true]]}}}
""",
    "domain.toml": """schema = "kith.domain/1"
id = "ice"
[mdp]
actions = ["go", "creep"]
[model]
format = "gym-json"
[[model.mdp]]
file = "ice.json"
"""}

# What is changed in one file, and what is said then: its place, what is wrong, what mends it.
WRONG_PRISM = [
    ("ice.tra", "3 4 6", "3 6", "ice.tra:1:1: ", "as in '6 10 16'", "PRISM's manual"),
    ("ice.tra", "1 1 1 0.5 creep", "1 1 0.5", "ice.tra:5:1: ", "state, choice, next state, probability", ""),
    ("ice.tra", "1/4", "1/0", "ice.tra:3:7: ", "expected a probability", ""),
    ("ice.tra", "3 4 6", "3 4 7", "ice.tra:1:1: ", "declares 7 transitions, but there are 6", "export it again"),
    ("ice.tra", "3 4 6", "300 4 6", "ice.tra:1:1: ", "more states", "cut off"),
    ("ice.tra", "0 0 1 1 go", "0 0 3 1 go", "ice.tra:2:5: ", "there is no state 3", "0 to 2"),
    ("ice.tra", "0.5 creep", "0.5 go", "ice.tra:5:11: ", "do not match", "an action of its own"),
    ("ice.tra", "1 0 2 3/4 go", "1 0 0 3/4 go", "ice.tra:4:1: ", "given twice", "sum of the probabilities"),
    ("ice.tra", "1 0 0 1/4", "1 0 0 [0.2,0.3]", "ice.tra:3:7: ", "interval MDP", "a probability in each"),
    ("ice.tra", "0 0 1 1 go", "0 0 1:1 go", "ice.tra:2:5: ", "with rows", "-exportrows"),
    ("ice.sta", "1:(1)", "1:(1,2)", "ice.sta:3:1: ", "1 values", ""),
    ("ice.sta", "1:(1)\n", "", "ice.sta: ", "state 1 is missing", "every state"),
    ("ice.lab", "2: 2\n", "01: 2\n", "ice.lab:5:1: ", "state 1 is given twice", "on one line"),
    ("ice.lab", "3=\"start\"", "2=\"start\"", "ice.lab:2:32: ", "label 2 is named twice", "of its own"),
    ("domain.toml", "\"goal\"", "\"done\"", "ice.lab:2:1: ", "no label 'done'", "init, deadlock, goal, start"),
    ("ice.slip.trew", "1 0 0 1", "1 1 0 1", "ice.slip.trew:4:1: ", "no such transition", "at once"),
    ("ice.slip.trew", "1 0 0 1\n", "1 0 0 1\n1 00 0 2\n", "ice.slip.trew:5:1: ", "this transition is given twice", ""),
    ("ice.step.srew", "3 2", "4 2", "ice.step.srew:3:1: ", "it has 3 states", "at once"),
    ("ice.step.srew", "1 1\n", "1 1\n1 2\n", "ice.step.srew:6:1: ", "this state is given twice", "keep one"),
    ("domain.toml", "{ slip =", "{ slap =", "domain.toml:3: ", "slap", "rewards = {"),
    ("domain.toml", "[[model.mdp]]\n", "[other]\n", "domain.toml:3: ", "no [[model.mdp]]", "below [model]"),
]
WRONG_GYM = [
    ("ice.json", "\"1\": {", "\"1\" {", "ice.json:3:6: ", "not valid JSON", "validator"),
    ("ice.json", "\"2\": {", "\"1\": {", "ice.json: ", "\"1\" is given twice", "keep one"),
    ("ice.json", "[1.0, 1, -1.0, false]", "[1.0, 1, -1.0]", "ice.json:2:14: ", "[probability, next state", "for instance"),
    ("ice.json", "[1.0, 1, -1.0, false]", "[1.0, 1, NaN, false]", "ice.json:2:23: ", "finite", "such as -1"),
    ("ice.json", "\"2\": {", "\"3\": {", "ice.json:1:7: ", "one is number 3", "without gaps"),
    ("ice.json", "\"2\": {", "\"two\": {", "ice.json:4:2: ", "\"two\"", "numbered from 0"),
    ("ice.json", "\"2\": {", "\"01\": {", "ice.json:4:2: ", "state 1 is given twice, as \"1\" and as \"01\"", "zeros"),
    ("ice.json", "\"1\": [[1.0, 0", "\"00\": [[1.0, 0", "ice.json:2:38: ", "action 0 is given twice", "zeros"),
    ("ice.json", "{\"P\": {", "{\"actions\": [\"go\", \"go\"], \"P\": {", "ice.json:1:20: ", "'go' is listed twice", ""),
    ("ice.json", "[1.0, 1, -1.0", "[1.0, 7, -1.0", "ice.json:2:20: ", "no such state", "0 to 2"),
    ("ice.json", "0, -3.0,", "0, [1, 1],", "ice.json:3:47: ", "an earlier one is a number", "in one way"),
    ("ice.json", "-1.0, false]", "[-1, 1], false]", "ice.json:2:56: ", "an earlier one is a list", "in one way"),
    ("ice.json", "-3.0", "-1.0", "", "", ""),
    ("domain.toml", "[\"go\", \"creep\"]", "[\"go\"]", "ice.json:2:44: ", "no name for action 1", "all actions"),
    ("domain.toml", "file = \"ice.json\"", "file = \"ice.json\"\n[[feature]]\nname = \"step\"\nreward = -5",
     "domain.toml:5: ", "no transition has the reward", "-1.0"),
    ("domain.toml", "file = \"ice.json\"", "file = \"ice.json\"\n[[feature]]\nname = \"step\"\nreward = -1",
     "domain.toml:5: ", "no feature stands for reward -3.0", "declare one"),
    ("domain.toml", "[model]", "[reward]\nweights = { a = 1 }\n[model]", "domain.toml:7: ", "follow from the rewards", ""),
]


class Converted(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def write(self, texts):
        for name, text in texts.items():
            (self.folder / name).write_text(text, encoding="utf-8")

    def run_it(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        before = os.getcwd()
        os.chdir(self.folder)
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                code = convert.main([str(one) for one in arguments])
        except SystemExit as end:
            code = end.code
        finally:
            os.chdir(before)
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())

    def convert(self, *arguments):
        done = self.run_it(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def text(self, name):
        return (self.folder / name).read_text(encoding="utf-8")

    def kith(self, *arguments):
        if not PROGRAM:
            self.skipTest("the program is not built")
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def wrong(self, base, cases):
        for name, before, after, place, message, help in cases:
            with self.subTest(name=name, after=after):
                self.write(base)
                self.assertIn(before, base[name])
                self.write({name: base[name].replace(before, after, 1)})
                done = self.run_it("domain.toml", "-o", "new.toml", "--yes")
                if not place:
                    self.assertEqual(done.returncode, 0, done.stderr)
                    continue
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertTrue(done.stderr.startswith("error: " + place), done.stderr)
                self.assertIn(message, done.stderr)
                self.assertIn("help: ", done.stderr)
                self.assertIn(help, done.stderr)


class Prism(Converted):
    def test_what_is_wrong_is_said_with_its_place_and_what_mends_it(self):
        self.wrong(PRISM, WRONG_PRISM)

    def test_tables_say_what_the_files_say(self):
        self.write(PRISM)
        self.convert("domain.toml", "-o", "my-ice.toml")
        self.assertEqual(self.text("my_ice_states.csv"),
                         "state,terminal,start,initial,x\n0,false,true,true,0\n1,false,true,false,1\n2,true,false,false,2\n")
        self.assertEqual(self.text("my_ice_transitions.csv"),
                         "state,action,next,probability,slip,step\n0,go,1,1,0,1\n1,go,0,0.25,1,1\n1,go,2,0.75,0,1\n"
                         "1,creep,1,0.5,0,1\n1,creep,2,0.5,0,1\n")
        self.assertIn("is valid (1 world, 2 start states)", self.kith("validate", "my-ice.toml"))

    def test_files_beside_the_transitions_are_found(self):
        self.write({name: text for name, text in PRISM.items() if name != "domain.toml"})
        self.convert("ice.tra", "-o", "a.toml", "--terminal", "goal", "--start", "start", "--weights", "slip=-2", "step=-1")
        self.write(PRISM)
        self.convert("domain.toml", "-o", "b.toml")
        for name in ("states", "transitions"):
            self.assertEqual(self.text(f"a_{name}.csv"), self.text(f"b_{name}.csv"))
        a = json.loads(self.kith("inspect", "a.toml", "--json"))
        b = json.loads(self.kith("inspect", "b.toml", "--json"))
        self.assertEqual([a[key] for key in ("features", "mdps", "demonstrations")],
                         [b[key] for key in ("features", "mdps", "demonstrations")])

    def test_weights_may_be_left_to_kith_infer(self):
        self.write(PRISM)
        done = self.convert("ice.tra", "-o", "a.toml", "--terminal", "goal")
        self.assertIn("--weights", done.stderr)
        self.assertIn("only for kith infer", self.kith("validate", "a.toml"))
        done = self.run_it("ice.tra", "-o", "b.toml", "--weights", "slip=-2")
        self.assertIn("what feature 'step' is worth is missing", done.stderr)

    def test_a_robot_may_enter_in_several_states(self):
        self.write({**PRISM, "ice.lab": PRISM["ice.lab"].replace("1: 3", "1: 0 3")})
        self.convert("domain.toml", "-o", "new.toml")
        self.kith("validate", "new.toml")

    def test_several_mdps_are_one_domain(self):
        second = PRISM["domain.toml"].split("[[model.mdp]]\n")[1].split("[[feature]]")[0]
        both = PRISM["domain.toml"].replace(second, "name = \"a\"\n" + second + "[[model.mdp]]\nname = \"b\"\n" + second)
        self.write({**PRISM, "domain.toml": both})
        self.convert("domain.toml", "-o", "new.toml")
        self.assertIn("2 worlds, 4 start states", self.kith("validate", "new.toml"))
        self.write({"domain.toml": both.replace("states = \"ice.sta\"\n", "", 1)})
        self.assertIn("share their variables", self.run_it("domain.toml", "-o", "new.toml", "--yes").stderr)

    def test_what_happens_after_the_end_is_left_out_with_a_word(self):
        self.write({**PRISM, "ice.tra": PRISM["ice.tra"].replace("2 0 2 1", "2 0 0 1 go")})
        self.assertIn("left out", self.convert("domain.toml", "-o", "new.toml").stderr)
        self.write({**PRISM, "ice.step.srew": "3 3\n0 1\n1 1\n2 1\n"})
        self.assertIn("the reward of state 2", self.convert("domain.toml", "-o", "new.toml", "--yes").stderr)

    def test_variables_may_have_the_names_of_columns(self):
        self.write({**PRISM, "ice.sta": PRISM["ice.sta"].replace("(x)", "(state)")})
        self.convert("domain.toml", "-o", "new.toml")
        self.assertIn(",state_\n", self.text("new_states.csv"))
        self.kith("validate", "new.toml")


class Gymnasium(Converted):
    def test_what_is_wrong_is_said_with_its_place_and_what_mends_it(self):
        self.wrong(GYM, WRONG_GYM)

    def test_rewards_become_features(self):
        self.write(GYM)
        self.convert("domain.toml", "-o", "new.toml")
        found = json.loads(self.kith("inspect", "new.toml", "--json"))
        self.assertEqual(found["features"], ["reward -3.0", "reward -1.0"])
        features = "[[feature]]\nname = \"step\"\nreward = -1\n[[feature]]\nname = \"slip\"\nreward = -3\n"
        self.write({"domain.toml": GYM["domain.toml"] + features})
        self.convert("domain.toml", "-o", "new.toml", "--yes")
        self.assertIn("weights = { step = -1, slip = -3 }", self.text("new.toml"))
        self.kith("validate", "new.toml")

    def test_a_table_alone_is_enough(self):
        self.write({"lake.json": json.dumps(json.loads(GYM["ice.json"])["P"])})
        self.convert("lake.json", "-o", "lake.toml", "--initial", "0", "--discount", "0.9")
        self.assertIn("0.9", self.text("lake.toml"))
        self.assertIn("1 world", self.kith("validate", "lake.toml"))
        self.assertIn("no state 9 to begin in", self.run_it("lake.json", "-o", "a.toml", "--initial", "9").stderr)

    def test_vectors_take_the_place_of_rewards_or_stand_beside_them(self):
        vectors = """[{"0": [[1.0, 1, [0, 1], false]]}, {"0": [[0.75, 2, [0, 1], true], [0.25, 0, [1, 1], false]],
                      "1": [[0.5, 2, [0, 1], true], [0.5, 1, [0, 1], false]]}, {}]"""
        self.write({"lake.json": vectors})
        self.convert("lake.json", "-o", "a.toml", "--weights", "feature1=-2", "feature2=-1")
        table = json.loads(vectors)
        plain = [{a: [[p, t, 0, end] for p, t, _, end in one] for a, one in actions.items()} for actions in table]
        phi = [{a: [row for _, _, row, _ in one] for a, one in actions.items()} for actions in table]
        self.write({"phi.json": json.dumps({"P": plain, "phi": phi})})
        self.convert("phi.json", "-o", "b.toml")
        self.assertEqual(self.text("a_transitions.csv"), self.text("b_transitions.csv"))
        self.kith("validate", "a.toml")
        self.write({"phi.json": json.dumps({"P": plain, "phi": phi[:2]})})
        self.convert("phi.json", "-o", "b.toml", "--yes")  # the last state has no outcome
        self.write({"phi.json": json.dumps({"P": plain, "phi": phi[1:]})})
        self.assertIn("the shape and the order", self.run_it("phi.json", "-o", "c.toml").stderr)

    def test_a_state_that_sometimes_ends_has_a_twin(self):
        self.write({"lake.json": """{"P": {"0": {"0": [[0.5, 1, -1, true], [0.5, 1, -2, false]]}, "1": {"0": [[1, 0, -1, false]]}},
            "states": ["home", "away"], "initial": 0, "starts": [0]}"""})
        self.convert("lake.json", "-o", "lake.toml")
        self.assertEqual(self.text("lake_states.csv"), "state,name,terminal,start,initial\n0,home,false,true,true\n"
                         "1,away,false,false,false\n1 (end),away,true,false,false\n")
        self.kith("validate", "lake.toml")

    def test_equal_outcomes_are_added_up_and_different_ones_kept(self):
        self.write({"lake.json": "[[[[0.5, 1, -1, true], [0.25, 1, -1, true], [0.25, 1, -2, true]]], []]"})
        self.convert("lake.json", "-o", "lake.toml")
        self.assertEqual(self.text("lake_transitions.csv").count("\n"), 3)
        self.assertIn("0,action 0,1,0.75,0,1\n", self.text("lake_transitions.csv"))
        self.kith("validate", "lake.toml")

    def test_a_cliff_that_nobody_enters_begins_no_lesson(self):
        file = SOURCE / "docs" / "examples" / "cliff.json"
        self.convert(file, "-o", "cliff.toml", "--initial", "36")
        for name in ("states", "transitions"):
            mine, its = self.text(f"cliff_{name}.csv"), (SOURCE / "docs" / "examples" / f"cliff_{name}.csv").read_text()
            self.assertEqual(mine.count("\n"), its.count("\n"))
        self.assertIn("(1 world, 37 start states)", self.kith("validate", "cliff.toml"))

    def test_other_encodings_are_named(self):
        (self.folder / "lake.json").write_bytes("[]".encode("utf-16"))
        self.assertIn("UTF-16", self.run_it("lake.json", "-o", "a.toml").stderr)
        (self.folder / "lake.json").write_bytes(b"\xef\xbb\xbf[[[[1, 0, -1, true]]]]")
        self.assertNotIn("JSON", self.run_it("lake.json", "-o", "a.toml").stderr)
        self.write({"deep.json": "[" * 100_000})
        self.assertEqual(self.run_it("deep.json", "-o", "a.toml").returncode, 3)


class Policies(Converted):
    def test_choices_and_probabilities_are_a_table(self):
        self.write({"agent.json": "[1, null, 0]"})
        self.convert("agent.json", "-o", "policy.csv")
        self.assertEqual(self.text("policy.csv"), "state,action\n0,1\n2,0\n")
        self.write({"agent.json": "{\"dry\": [[0.25, 0.75], null], \"wet, cold\": [1]}"})
        self.convert("agent.json", "-o", "policy.csv", "--yes")
        self.assertEqual(self.text("policy.csv"), "world,state,action,probability\ndry,0,0,0.25\ndry,0,1,0.75\n"
                         "\"wet, cold\",0,1,1\n")

    def test_what_is_wrong_has_a_place(self):
        for text, place in (("[0, 0.5]", "agent.json:1:5"), ("[0, \"on\"]", "agent.json:1:5"), ("{\"0\": 1}", "agent.json:1:7"),
                            ("[0", "agent.json:1:3")):
            self.write({"agent.json": text})
            done = self.run_it("agent.json", "-o", "policy.csv")
            self.assertEqual(done.returncode, 3)
            self.assertTrue(done.stderr.startswith(f"error: {place}: "), done.stderr)


class Files(Converted):
    def test_it_runs_as_a_file(self):
        self.write(GYM)
        done = subprocess.run([sys.executable, SOURCE / "python" / "kith" / "convert.py", "domain.toml", "-o", "new.toml"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.count("wrote ")), (0, 3), done.stderr)

    def test_nothing_is_replaced_unasked_and_nothing_half_written(self):
        self.write({**GYM, "new_states.csv": "mine"})
        done = self.run_it("domain.toml", "-o", "new.toml")
        self.assertEqual(done.returncode, 3)
        self.assertIn("--yes", done.stderr)
        self.assertFalse((self.folder / "new.toml").exists())
        self.assertEqual(self.text("new_states.csv"), "mine")

    def test_other_files_are_named(self):
        self.assertEqual(self.run_it("model.nm", "-o", "a.toml").returncode, 2)
        self.assertEqual(self.run_it("none.tra", "-o", "a.toml").returncode, 5)
        self.write({"csv.toml": "[model]\nformat = \"csv\"\n"})
        self.assertIn("kith reads it as it is", self.run_it("csv.toml", "-o", "a.toml").stderr)


if __name__ == "__main__":
    unittest.main()
