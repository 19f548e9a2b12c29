"""Reading of a store's chunks, with their checksums verified."""

from __future__ import annotations

from typing import TYPE_CHECKING

from zarr.storage import LocalStore, WrapperStore

from stiction.storage.checksums import without_checksum
from stiction.study.store.seal import ROOT, damage

if TYPE_CHECKING:
    from zarr.abc.store import ByteRequest
    from zarr.core.buffer import Buffer, BufferPrototype


class WholeChunks(WrapperStore[LocalStore]):
    """A zarr folder in which each chunk has a checksum."""

    async def get(
        self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """Return the content of a file.

        Raises
        ------
        ResultError
            If it is a damaged chunk.
        """
        found = await super().get(key, prototype, byte_range)
        if found is None or byte_range is not None or key.endswith(ROOT):
            return found
        if without_checksum(found.to_bytes()) is None:
            raise damage(self._store.root, [key])
        return found
