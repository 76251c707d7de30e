"""Builds the wheel by scikit-build where there is no scikit-build-core (Debian 12); pyproject.toml has the metadata."""

from skbuild import setup

setup(
    packages=["slipfit"],
    package_dir={"": "python"},
    package_data={"slipfit": ["*.pyi", "py.typed"]},
    license_files=["LICENSE"],
    include_package_data=False,
    cmake_install_dir="python",
    cmake_args=[
        "-DCMAKE_BUILD_TYPE=Release",
        "-DSLIPFIT_PYTHON=ON",
        "-DSLIPFIT_UNITY_BUILD=ON",
        "-DSLIPFIT_BUILD_TESTS=OFF",
        "-DSLIPFIT_INSTALL=OFF",
    ],
)
