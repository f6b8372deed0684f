"""Holds the files that frame_test.cpp wrote against VTK's description of VTKHDF 1.0, UnstructuredGrid."""

import pathlib
import sys

import h5py
import numpy

folder = pathlib.Path(sys.argv[1])
INTEGERS = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Connectivity", "Offsets")


def check(path, count):
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert list(root.attrs["Version"]) == [1, 0]
        assert root.attrs["Type"] == b"UnstructuredGrid", root.attrs["Type"]
        assert root.attrs.get_id("Type").get_type().is_variable_str() == 0
        for name in INTEGERS:
            assert root[name].dtype == numpy.int64, name
        for name in INTEGERS[:3]:
            assert list(root[name]) == [count], name
        assert root["Points"].shape == (count, 3)
        assert root["Types"].dtype == numpy.uint8 and (root["Types"][:] == 1).all()
        assert (root["Offsets"][:] == numpy.arange(count + 1)).all()
        assert (root["Connectivity"][:] == numpy.arange(count)).all()
        assert root["PointData/velocity"].shape == (count, 3)
        assert root["PointData/pressure"].shape == root["PointData/id"].shape == (count,)
        return root["Points"][:]


points = check(folder / "frame-000012.hdf", 100000)
thirds = (numpy.arange(100000, dtype=numpy.float32) / numpy.float32(3)).astype(float)
assert (points[:, 0] == 1e5 + thirds).all()
assert (points[:, 1] == -thirds).all() and (points[:, 2] == 0).all()
check(folder / "empty.hdf", 0)
