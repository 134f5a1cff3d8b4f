"""Runs: the same bytes as the program's, frames over its memory, interruption, resumption."""

import filecmp
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import kith
import numpy as np
from support import PROGRAM, SMALL, SOURCE, lake_domain


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.run_ = kith.study("quick", cls.folder / "run", progress=False, **SMALL)

    @classmethod
    def tearDownClass(cls):
        del cls.run_
        cls.temporary.cleanup()

    @unittest.skipUnless(os.path.exists(PROGRAM), "the program is not built")
    def test_tables_are_the_programs(self):
        out = self.folder / "program"
        subprocess.run([PROGRAM, "study", "quick", "-o", out, "--set", "replicates=2", "--set", "teacher.particles=200",
                        "--set", "stop.max_periods=6"], check=True, capture_output=True)
        names = os.listdir(out / "tables")
        self.assertEqual(filecmp.cmpfiles(out / "tables", self.run_.folder / "tables", names, shallow=False)[1:], ([], []))

    def test_frames_look_at_its_memory(self):
        tables = self.run_.tables
        teams = tables["teams"]
        self.assertIs(teams, tables["teams"])
        for name in ("knowledge", "periods", "completed", "team"):
            column = teams[name].to_numpy()
            self.assertTrue(np.shares_memory(column, tables.native("teams").column(name)), name)
            self.assertFalse(column.flags.writeable)
        self.assertEqual(teams["completed"].dtype, bool)
        self.assertEqual(teams["periods"].dtype, np.int64)
        files = [f[:-4] for f in os.listdir(self.run_.folder / "tables") if f.endswith(".csv")]
        self.assertCountEqual(list(tables), files)
        self.assertIn("knowledge", tables.codebook("teams").index)
        with self.assertRaises(KeyError):
            tables["nothing"]

    def test_frames_are_what_pandas_reads(self):
        import pandas as pd
        for name in self.run_.tables:
            frame = self.run_.tables[name]
            read = pd.read_csv(self.run_.folder / "tables" / f"{name}.csv", float_precision="round_trip")
            self.assertEqual(list(frame), list(read))
            for column in frame.select_dtypes("number"):
                np.testing.assert_array_equal(frame[column].to_numpy(float), read[column].to_numpy(float))

    def test_what_is_made_of_it(self):
        analysis = self.run_.analyze()
        self.assertTrue(len(analysis) > 0 and analysis[0].sentence)
        self.assertEqual(analysis[analysis[0].id].id, analysis[0].id)
        self.assertTrue(analysis[0].tables)
        self.assertIn("<details>", analysis._repr_html_())
        self.assertEqual(self.run_.verify(progress=False)["checked"], len(self.run_.tables["teams"]))
        self.assertIn("<table", self.run_._repr_html_())
        with self.assertRaises(kith.Error):
            self.run_.analyze(contrasts=["joint - nobody"])
        told = self.run_.team(1)
        self.assertEqual(told.periods, int(self.run_.tables["teams"]["periods"][0]))
        people = self.run_.audit(1, progress=False)["people"]
        self.assertEqual(len(people), len(self.run_.tables["teams"]["composition"][0]))

    @unittest.skipUnless(os.path.exists(PROGRAM), "the program is not built")
    def test_a_run_is_audited_as_the_program_does(self):
        folder = self.folder / "kinds"
        kith.study("quick", folder, progress=False, replicates=1, **{
            "teacher.hypotheses": "kinds", "stop.max_periods": 3, "design.strategies": ["joint"],
            "design.vary": {"teacher.process_noise": [0.1, 0.5]}})
        printed = subprocess.run([PROGRAM, "audit", folder, "--json"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(kith.audit(folder, progress=False), json.loads(printed))
        self.assertIn("kinds", json.loads(printed)["people"][0])

    @unittest.skipUnless(os.path.exists(PROGRAM), "the program is not built")
    def test_a_live_session_is_audited_as_the_program_does(self):
        folder = self.folder / "live"
        subprocess.run([PROGRAM, "serve", "quick", "-o", folder, "--rehearse", "1", "--answer-every", "0.05"], check=True,
                       capture_output=True)
        printed = subprocess.run([PROGRAM, "audit", folder, "--json"], check=True, capture_output=True, text=True).stdout
        self.assertEqual(kith.audit(folder, progress=False), json.loads(printed))
        self.assertEqual(kith.audit(folder, room="r1", progress=False)["people"], json.loads(printed)["people"])
        with self.assertRaises(kith.Error):
            kith.audit(folder, room="r9", progress=False)
        with self.assertRaises(ValueError):
            kith.audit(folder, 1, progress=False)
        with self.assertRaises(ValueError):
            kith.audit(self.run_, room="r1", progress=False)

    def test_the_report_is_one_page(self):
        try:
            report = self.run_.report(self.folder / "page.html")
        except kith.Error as error:
            self.skipTest(str(error))
        self.assertIn("<iframe", report._repr_html_())
        self.assertTrue(report.path.read_text().startswith("<!"))

    def test_the_same_again_is_resumed(self):
        again = kith.study("quick", self.folder / "run", progress=False, **SMALL)
        self.assertEqual(again.resumed, len(again.tables["teams"]))
        with self.assertRaises(kith.Error) as caught:
            kith.study("quick", self.folder / "run", progress=False, seed=99, **SMALL)
        self.assertIn("replace=True", str(caught.exception))

    def test_a_dictionary_and_a_robot_of_ones_own(self):
        told = []
        run = kith.study({"domain": lake_domain(kith), "replicates": 2, "seed": 3,
                          "design": {"strategies": ["joint"], "compositions": ["NP"]},
                          "learner": {letter: {"ability": {"mean": mean, "sd": 0.03}, "confirm_gain": {"half_normal": 0.03},
                                               "correct_gain": {"half_normal": 0.05}} for letter, mean in (("N", 0.7), ("P", 0.8))},
                          "teacher": {"particles": 200}, "stop": {"max_periods": 4}},
                         progress=lambda *where: told.append(where))
        self.assertEqual(list(run.tables["teams"]["strategy"]), ["joint", "joint"])
        self.assertTrue(all(total == 2 for _, total, _ in told))
        folder = run.folder
        del run
        import gc
        gc.collect()
        self.assertFalse(folder.exists())

    def test_power_counts_teams(self):
        curves = kith.power("paper", "periods: strategy", teams=[2, 4], pool=8, draws=20, progress=False, teacher={"particles": 100},
                            stop={"max_periods": 4}, strategies=["joint", "common"])
        self.assertEqual([one["teams"] for one in curves["effects"][0]["points"]], [2, 4])

    def test_learners_are_fitted(self):
        found = kith.fit(self.run_, folds=0, replicates=1, progress=False)
        self.assertEqual([one["name"] for one in found["types"]], ["N", "P"])
        with self.assertRaises(kith.Error):
            kith.fit(self.folder / "nothing")

    def test_a_study_is_written_out(self):
        text = kith.resolve("quick", **SMALL)
        self.assertRegex(text, r"particles *= *200")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "all.toml"
            file.write_text(text)
            self.assertEqual(kith.resolve(file, domain=kith.Domain("item-delivery")).split("[design]")[1], text.split("[design]")[1])

    def test_what_is_wrong_is_refused(self):
        for wrong in (dict(study="nothing"), dict(study="quick", teacher={"partikel": 3}), dict(study={"domain": 3})):
            with self.assertRaises(kith.Error, msg=str(wrong)) as caught:
                kith.study(**wrong, out=self.folder / "wrong", progress=False)
            self.assertTrue(caught.exception.diagnostics)
        self.assertFalse((self.folder / "wrong").exists())
        for wrong in (dict(resume="maybe"), dict(threads=-1), dict(progress=3)):
            with self.assertRaises((ValueError, TypeError)):
                kith.study("quick", self.folder / "wrong", **wrong)


class Interruption(unittest.TestCase):
    def test_ctrl_c_ends_it_and_the_same_call_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            script = textwrap.dedent(f"""
                import kith, sys
                def told(done, total, failed):
                    print(done, flush=True)
                kith.study("paper", {folder + "/run"!r}, progress=told, threads=1, replicates=20)
            """)
            process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            process.stdout.readline()
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
            self.assertIn("KeyboardInterrupt", errors)
            self.assertGreater(kith.Run(folder + "/run").status["done"], 0)

    def test_what_on_progress_raises_is_raised(self):
        class Enough(Exception):
            pass

        def told(done, total, failed):
            raise Enough

        with tempfile.TemporaryDirectory() as folder, self.assertRaises(Enough):
            kith.study("quick", folder + "/run", progress=told, replicates=20)


if __name__ == "__main__":
    unittest.main()
