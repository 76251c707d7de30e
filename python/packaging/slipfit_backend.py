"""Makes the sdist and the wheel: by scikit-build-core, which Debian 13 has, else by scikit-build, which Debian 12 has.

Both take metadata from pyproject.toml and run the same CMakeLists.txt, whose rules for a wheel are in python/CMakeLists.txt.
Where neither is there, a frontend that isolates builds (pip) installs scikit-build-core first.
"""

import importlib.util

_HAS_CORE = importlib.util.find_spec("scikit_build_core") is not None
_HAS_CLASSIC = importlib.util.find_spec("skbuild") is not None and importlib.util.find_spec("setuptools") is not None

_REQUIRES = [] if _HAS_CORE or _HAS_CLASSIC else ["scikit-build-core>=0.10"]


def _backend():
    """Returns the module with the hooks of PEP 517, and prints its name, so that a log shows which one made the wheel."""
    if _HAS_CORE:
        from scikit_build_core import build
    elif _HAS_CLASSIC:
        from setuptools import build_meta as build  # runs setup.py, which is scikit-build's
    else:
        raise ImportError("slipfit is built by scikit-build-core or scikit-build; on Debian: scripts/install_dependencies.sh build python")
    print(f"slipfit: built by {'scikit-build-core' if _HAS_CORE else 'scikit-build'}")
    return build


def get_requires_for_build_sdist(config_settings=None):
    return _REQUIRES


def get_requires_for_build_wheel(config_settings=None):
    return _REQUIRES


def build_sdist(sdist_directory, config_settings=None):
    return _backend().build_sdist(sdist_directory, config_settings)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return _backend().build_wheel(wheel_directory, config_settings, metadata_directory)
