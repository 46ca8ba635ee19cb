"""MATLAB files of version 7.3 as MATLAB lays them out: a block of 512 bytes, then HDF5 with its attributes."""

import numpy as np
import scipy.sparse

CLASSES = {"f8": "double", "f4": "single", "b1": "logical"}


def write_matlab_73(path, *, objects=None, **variables):
    """Write variables: arrays, texts, object arrays (cells, arrays of structures) and dictionaries (structures)."""
    import h5py  # noqa: PLC0415 - an optional package

    with h5py.File(path, "w", userblock_size=512) as file:
        references = file.create_group("#refs#")
        for name, value in variables.items():
            _put(file, references, name, value)
        for name, kind in (objects or {}).items():
            file[name].attrs["MATLAB_class"] = np.bytes_(kind)
            file[name].attrs["MATLAB_object_decode"] = np.int32(3)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Tue Dec  1 10:00:00 2026 HDF5 schema 1.00 ."
    with path.open("r+b") as file:
        file.write(head.ljust(116) + bytes(8) + b"\0\x02IM")


def _put(parent, references, name, value):
    """Write one variable into a group."""
    if isinstance(value, dict):
        group = parent.create_group(name)
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        _put_fields(group, list(value))
        for key, one in value.items():
            _put(group, references, key, one)
        return
    if scipy.sparse.issparse(value):
        group = parent.create_group(name)
        group.attrs["MATLAB_class"] = np.bytes_("double")
        group.attrs["MATLAB_sparse"] = np.uint64(value.shape[0])
        group["data"], group["ir"], group["jc"] = value.data, value.indices.astype("u8"), value.indptr.astype("u8")
        return
    if isinstance(value, str):
        data = np.array([ord(c) for c in value], np.uint16)[:, None]
        kind = "char"
    elif isinstance(value, np.ndarray) and value.dtype.kind == "U":  # rows of characters
        data, kind = np.array([[ord(c) for c in row.ljust(value.itemsize // 4)] for row in value], np.uint16).T, "char"
    elif isinstance(value, np.ndarray) and value.dtype == object and all(isinstance(v, dict) for v in value):
        group = parent.create_group(name)
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        _put_fields(group, list(value[0]))
        for key in value[0]:
            group.create_dataset(key, data=_refer(references, [v[key] for v in value]))
        return
    elif isinstance(value, np.ndarray) and value.dtype == object:
        data, kind = _refer(references, list(value)), "cell"
    else:
        array = np.asarray(value)
        array = array[:, None] if array.ndim == 1 else array
        kind = CLASSES.get(array.dtype.str[1:], array.dtype.name)
        if np.iscomplexobj(array):
            data = np.zeros(array.T.shape, [("real", "f8"), ("imag", "f8")])
            data["real"], data["imag"], kind = array.T.real, array.T.imag, "double"
        else:
            data = array.T.astype(np.uint8) if array.dtype == bool else array.T
    parent.create_dataset(name, data=data).attrs["MATLAB_class"] = np.bytes_(kind)


def _put_fields(group, names):
    """Names of fields in their order, each an array of characters."""
    import h5py  # noqa: PLC0415 - an optional package

    letters = np.empty(len(names), object)
    letters[:] = [np.array(list(name), "S1") for name in names]
    group.attrs.create("MATLAB_fields", letters, dtype=h5py.vlen_dtype(np.dtype("S1")))


def _refer(references, values):
    """References (n, 1) to values that are written beside all others."""
    import h5py  # noqa: PLC0415 - an optional package

    made = []
    for value in values:
        name = f"r{len(references)}"
        while name in references:
            name += "a"
        _put(references, references, name, value)
        made.append(references[name].ref)
    return np.array(made, h5py.ref_dtype)[:, None]
