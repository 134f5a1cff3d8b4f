"""Builds the module with CMake: KITH_BUILD_DIR names a build tree that has it already, which is then only brought up to
date."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        build = pathlib.Path(os.environ.get("KITH_BUILD_DIR") or pathlib.Path(self.build_temp).resolve() / "kith")
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DKITH_PYTHON=ON",
                            "-DKITH_BUILD_TESTS=OFF", "-DKITH_INSTALL=OFF", f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "kith_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        built = build / "python" / "kith" / target.name
        shutil.copyfile(built, target)


version = re.search(r"project\(kith VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
setup(version=version, ext_modules=[Extension("kith._core", [])], cmdclass={"build_ext": CMakeBuild})
