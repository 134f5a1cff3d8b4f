"""The notebooks run, and the last expression of every cell can be shown."""

import ast
import contextlib
import importlib.util
import io
import json
import unittest

from support import SOURCE


def run(path):
    scope = {"__name__": "__main__"}
    shown = []
    for cell in json.loads(path.read_text())["cells"]:
        if cell["cell_type"] != "code":
            continue
        tree = ast.parse("".join(cell["source"]), path.name)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(tree, path.name, "exec"), scope)
            if last is not None:
                value = eval(compile(ast.Expression(last.value), path.name, "eval"), scope)
                page = value._repr_html_() if hasattr(value, "_repr_html_") else ""
                shown.append(page or repr(value))
    return shown


def missing(path):
    """What a notebook imports that is not installed."""
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    nodes = [node for cell in cells for node in ast.walk(ast.parse("".join(cell["source"])))]
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom)}
    return sorted(name for name in {name.split(".")[0] for name in names} if importlib.util.find_spec(name) is None)


class Notebooks(unittest.TestCase):
    def test_all_run_and_show_something(self):
        paths = sorted((SOURCE / "examples" / "notebooks").glob("*.ipynb"))
        self.assertTrue(paths)
        for path in paths:
            with self.subTest(path.name):
                if missing(path):
                    self.skipTest(f"not installed: {', '.join(missing(path))}")
                shown = run(path)
                self.assertTrue(shown and all(shown), path.name)

    def test_they_hold_no_outputs(self):
        for path in (SOURCE / "examples" / "notebooks").glob("*.ipynb"):
            for cell in json.loads(path.read_text())["cells"]:
                self.assertFalse(cell.get("outputs"), path.name)


if __name__ == "__main__":
    unittest.main()
