"""pip install . builds the extension by CMake; pyproject.toml says the rest."""

import os
import pathlib
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

# Targets and the programs that they make: the command line, and what reads files that may crash a reader (.mat, HDF5; images).
PROGRAMS = {"slipfit_cli": "slipfit", "slipfit_hdf5": "slipfit-hdf5", "slipfit_image": "slipfit-image"}


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        source, build = pathlib.Path(__file__).resolve().parent, pathlib.Path(self.build_temp).resolve() / "cmake"
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(
            ["cmake", "-S", source, "-B", build, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DSLIPFIT_PYTHON=ON",
             "-DSLIPFIT_UNITY_BUILD=ON", "-DSLIPFIT_BUILD_TESTS=OFF", "-DSLIPFIT_INSTALL=OFF",
             f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
        jobs = str(self.parallel or len(os.sched_getaffinity(0)))
        targets = ["slipfit_python", *PROGRAMS]
        known = subprocess.run(["cmake", "--build", build, "--target", "help"], capture_output=True, text=True, check=True).stdout
        targets = [name for name in targets if name in known]
        subprocess.run(["cmake", "--build", build, "--parallel", jobs, "--target", *targets], check=True)
        place = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(next((build / "python" / "slipfit").glob("_slipfit.*.so")), place)
        for program in PROGRAMS.values():
            if (build / "apps" / program).exists():
                shutil.copy2(build / "apps" / program, place.parent / program)


setup(ext_modules=[Extension("slipfit._slipfit", [])], cmdclass={"build_ext": CMakeBuild})
