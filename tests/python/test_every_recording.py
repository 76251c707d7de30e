"""The module says what the command line says of every recording beside the checkout, byte for byte: one by one, and in threads in any order."""

import concurrent.futures
import functools
import random
import subprocess

import pytest
from conftest import PROGRAM
from recordings import ALL, MEASURED, SIMULATED, measured_files, said_of

import slipfit as sf


@functools.lru_cache(maxsize=None)
def said_by_program(number):
    """The document, or the message of the refusal."""
    said = ALL[number]
    run = subprocess.run([PROGRAM, "fit", str(said.file), *said.words, "--json", "--quiet"], capture_output=True, text=True, check=False)
    return run.stdout if run.returncode == 0 else run.stderr


def said_by_module(number):
    said = ALL[number]
    return sf.fit(sf.read_recording(said.file, **said.arguments)).to_json() + "\n"


def case(number):
    return pytest.param(number, id=ALL[number].id, marks=[] if ALL[number].is_quick else pytest.mark.long)


@pytest.mark.parametrize("number", [case(number) for number in range(len(ALL))])
def test_one_by_one(number):
    assert said_by_module(number) == said_by_program(number)


@pytest.mark.long
def test_in_threads_in_any_order():
    order = list(range(len(ALL)))
    random.Random(23).shuffle(order)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        documents = dict(zip(order, pool.map(said_by_module, order)))
    assert [ALL[number].id for number in order if documents[number] != said_by_program(number)] == []


@pytest.mark.parametrize("folder", [SIMULATED, MEASURED], ids=["simulated", "measured"])
def test_none_is_left_out(folder):
    if not folder.exists():
        pytest.skip(f"{folder} is absent")
    assert [said for said in ALL if said.file.is_relative_to(folder)]
    assert [file.name for file in measured_files() if not any(said_of(file))] == []
