"""pip install . builds the extension by CMake; pyproject.toml says the rest."""

import os
import pathlib
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HELPERS = ("slipfit-hdf5", "slipfit-image")  # programs that read what may crash a reader: .mat, HDF5; images


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        source, build = pathlib.Path(__file__).resolve().parent, pathlib.Path(self.build_temp).resolve() / "cmake"
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(
            ["cmake", "-S", source, "-B", build, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DSLIPFIT_PYTHON=ON",
             "-DSLIPFIT_UNITY_BUILD=ON", "-DSLIPFIT_BUILD_TESTS=OFF", "-DSLIPFIT_INSTALL=OFF",
             f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
        jobs = str(self.parallel or len(os.sched_getaffinity(0)))
        targets = ["slipfit_python", *(name.replace("-", "_") for name in HELPERS)]
        known = subprocess.run(["cmake", "--build", build, "--target", "help"], capture_output=True, text=True, check=True).stdout
        targets = [name for name in targets if name in known]
        subprocess.run(["cmake", "--build", build, "--parallel", jobs, "--target", *targets], check=True)
        place = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(next((build / "python" / "slipfit").glob("_slipfit.*.so")), place)
        for helper in HELPERS:
            if (build / "apps" / helper).exists():
                shutil.copy2(build / "apps" / helper, place.parent / helper)


setup(ext_modules=[Extension("slipfit._slipfit", [])], cmdclass={"build_ext": CMakeBuild})
