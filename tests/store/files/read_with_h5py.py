"""Reads the files that h5py_test.cpp writes, and runs the example of schemas/checkpoint.md on them."""

import contextlib
import io
import math
import os
import pathlib
import re
import sys

import h5py
import numpy

folder, document = map(pathlib.Path, sys.argv[1:])


def check_texts(name, thing):
    """Every data set tells its unit and description, as str."""
    for key, value in thing.attrs.items():
        if isinstance(value, numpy.ndarray):
            assert all(type(item) is str for item in value), (name, key)
        else:
            assert not isinstance(value, bytes), (name, key)
    if isinstance(thing, h5py.Dataset):
        assert type(thing.attrs["unit"]) is str and thing.attrs["unit"], name
        assert type(thing.attrs["description"]) is str and thing.attrs["description"], name


for path in sorted(folder.glob("*.h5")):
    with h5py.File(path) as file:
        assert type(file.attrs["format"]) is str
        check_texts("/", file)
        file.visititems(check_texts)

with h5py.File(folder / "checkpoint-000000000123.h5") as file:
    assert file.attrs["format"] == "sluice-checkpoint"
    assert file.attrs["step"] == 123
    assert file["particles/x"].shape == (50,)
    assert file["particles/x"].fletcher32
    assert math.copysign(1.0, file["particles/x"][0]) == -1.0 and file["particles/x"][0] == 0.0
    assert list(file["retired/cause"]) == [0, 1, 5]
    assert list(file["series/0000"].attrs["names"]) == ["P1", "P2"]
    assert list(file["series/0002"].attrs["names"]) == ["späte Ankunft / 1"]
    assert list(file["series/0001"].attrs["columns"]) == ["kinetic", "potential", "internal"]
    assert file["series/0000/values"].shape == (3, 2, 1)
    assert file["series/0001/values"].shape == (2, 1, 3)
    assert numpy.isnan(file["series/0000/values"][0, 0, 0])

with h5py.File(folder / "frame.h5") as file:
    assert file["particles/pressure"].dtype == numpy.float32

examples = re.findall(r"```python\n(.*?)```", document.read_text(encoding="utf-8"), re.DOTALL)
assert examples, "no example in the document"
os.chdir(folder)
for example in examples:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(example, str(document), "exec"), {"__name__": "__main__"})
    assert "P2 pressure 3 samples, last [9.] ['Pa']" in printed.getvalue(), printed.getvalue()
