"""Arrays that can be computed again: read as they were written, or not at all."""

import numpy as np

from stiction.storage.arrays import read_arrays, write_arrays

# so long that a part of it can be read without the rest
ARRAYS = {"scores": np.arange(96.0).reshape(32, 3), "features": np.ones((32, 170))}


def test_each_damage_to_the_description_of_an_array_is_noticed(tmp_path):
    """With 22 rows for 32, scores and features of different rigs stood side by side.

    Other bits ended a fit by a traceback.
    """
    path = tmp_path / "00000.npz"
    write_arrays(path, **ARRAYS)
    content = path.read_bytes()
    known = read_arrays(path)
    assert known is not None
    assert all(np.array_equal(known[name], each) for name, each in ARRAYS.items())
    begin = content.index(b"features.npy")
    for place in range(begin, begin + 110):
        for bit in range(8):
            changed = bytearray(content)
            changed[place] ^= 1 << bit
            path.write_bytes(changed)
            assert read_arrays(path) is None, (place - begin, bit)


def test_what_is_cut_is_not_read(tmp_path):
    path = tmp_path / "00000.npz"
    write_arrays(path, **ARRAYS)
    content = path.read_bytes()
    for size in (0, 3, 4, 1000, len(content) - 4, len(content) - 1):
        path.write_bytes(content[:size])
        assert read_arrays(path) is None
