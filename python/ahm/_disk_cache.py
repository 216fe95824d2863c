"""Arrays in a folder, under a key of what they were computed from."""

from __future__ import annotations

import hashlib
import io
import os
import sys
import uuid
from pathlib import Path
from typing import Dict, Mapping, Optional, Union

import numpy as np

DIGEST = hashlib.sha256().digest_size


def key_of(text: str, *arrays: Optional[np.ndarray]) -> str:
    """The SHA-256 of a text, of arrays with their types and shapes, and of the version of the package. None and an empty array differ."""
    found = hashlib.sha256(f"{sys.modules[__package__].__version__} {text}".encode())  # type: ignore[index]
    for array in arrays:
        found.update(b" none" if array is None else f" {array.dtype.str} {array.shape} ".encode() + array.tobytes())
    return found.hexdigest()


class DiskCache:
    """A folder with one file per key: a digest of the key and the data, then the data as .npz.

    Any number of processes may read and write at once: a file appears whole, by renaming. A process that is killed while it writes
    leaves a file that ends in .tmp.
    """

    def __init__(self, folder: Union[str, "os.PathLike[str]"]) -> None:
        self.folder = Path(folder)

    def get(self, key: str) -> Optional[Dict[str, np.ndarray]]:
        """The arrays that `put` stored; None if there is no file, or if it is damaged or not that of this key.

        Raises OSError (a file that cannot be read).
        """
        try:
            content = self._file(key).read_bytes()
        except FileNotFoundError:
            return None
        data = content[DIGEST:]
        if content[:DIGEST] != _digest(key, data):
            return None
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            return dict(arrays)

    def put(self, key: str, arrays: Mapping[str, np.ndarray]) -> None:
        """Stores the arrays, in place of a file that is there. Creates the folder.

        Raises OSError (a file that cannot be written).
        """
        made = io.BytesIO()
        np.savez(made, **arrays)
        data = made.getvalue()
        self.folder.mkdir(parents=True, exist_ok=True)
        temporary = self.folder / f"{uuid.uuid4().hex}.tmp"
        try:
            with open(temporary, "xb") as file:
                file.write(_digest(key, data))
                file.write(data)
            os.replace(temporary, self._file(key))
        finally:
            temporary.unlink(missing_ok=True)

    def _file(self, key: str) -> Path:
        return self.folder / f"{key}.maps"


def _digest(key: str, data: bytes) -> bytes:
    found = hashlib.sha256(key.encode())
    found.update(data)
    return found.digest()
