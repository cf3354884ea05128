"""A folder of finished drawings and pictures, named by the content that they were made from."""

import hashlib
import json
import os
import time
from pathlib import Path

KEEP_DAYS = 30


def digest(*parts):
    """SHA-256 of texts, bytes and JSON-able values."""
    sha = hashlib.sha256()
    for part in parts:
        if not isinstance(part, (bytes, str)):
            part = json.dumps(part, sort_keys=True, allow_nan=True)
        sha.update(part.encode() if isinstance(part, str) else part)
        sha.update(b"\0")
    return sha.hexdigest()


def file_digest(path):
    """SHA-256 of a file's bytes."""
    sha = hashlib.sha256()
    with open(path, "rb") as stream:
        while block := stream.read(1 << 20):
            sha.update(block)
    return sha.hexdigest()


def source_digest(*names):
    """SHA-256 of modules of this package: a drawing is made again when its code changes."""
    here = Path(__file__).parent
    return digest(*[(here / f"{name}.py").read_bytes() for name in names])


class Cache:
    """Bytes by key. A key is `digest(...)` of everything that the content depends on."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def path(self, key, ending):
        return self.folder / f"{key[:40]}{ending}"

    def get(self, key, ending):
        """The bytes, or None."""
        path = self.path(key, ending)
        try:
            data = path.read_bytes()
            os.utime(path)
        except OSError:
            return None
        return data

    def put(self, key, ending, data):
        path = self.path(key, ending)
        part = path.with_name(f"{path.name}.{os.getpid()}.part")
        part.write_bytes(data)
        part.replace(path)

    def prune(self):
        """Drops what no report has used for KEEP_DAYS days."""
        limit = time.time() - KEEP_DAYS * 86400
        for path in self.folder.iterdir():
            if path.is_file() and path.stat().st_mtime < limit:
                path.unlink()
