"""Errors that a user can cause, each written to be read: what was wrong, where, what to do."""

from __future__ import annotations

from os import PathLike


class PellucidError(Exception):
    """Base of every error that Pellucid raises on purpose."""


class NoAdapterError(PellucidError):
    """No WebGPU adapter was found; the message says what to install on this operating system."""


class AssetError(PellucidError):
    """A file cannot be used.

    Parameters
    ----------
    path : the file.
    reason : what is wrong with it.
    remedy : what the reader can do about it.
    """

    def __init__(self, path: str | PathLike[str], reason: str, remedy: str = "") -> None:
        self.path = str(path)
        self.reason = reason
        self.remedy = remedy
        super().__init__(_sentence(self.path, reason, remedy))


class AssetWarning(UserWarning):
    """A file can be used, but not all that it names; the message says what is missing and what stands for it."""

    def __init__(self, path: str | PathLike[str], reason: str, remedy: str = "") -> None:
        super().__init__(_sentence(str(path), reason, remedy))


class SceneError(PellucidError):
    """A value in a scene or a call is out of its range.

    Parameters
    ----------
    field : path of the field, such as ``camera.fov_deg``.
    reason : what is wrong with the value.
    remedy : what the reader can do about it.
    """

    def __init__(self, field: str, reason: str, remedy: str = "") -> None:
        self.field = field
        self.reason = reason
        self.remedy = remedy
        super().__init__(_sentence(field, reason, remedy))


class ShaderError(PellucidError):
    """A WGSL file does not compile; names our file and line, not the line of the assembled text."""

    def __init__(self, path: str, line: int, message: str) -> None:
        self.path = path
        self.line = line
        self.message = message
        super().__init__(f"{path}:{line}: {message}")


def _sentence(where: str, reason: str, remedy: str) -> str:
    text = f"{where}: {reason}"
    return f"{text} ({remedy})" if remedy else text
