"""What a picture of the gallery is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pellucid.scene import Scene


@dataclass(frozen=True)
class Picture:
    """A scene that shows something, with the words that belong to it.

    Parameters
    ----------
    name : short, for files: lower case and hyphens.
    title : for people.
    you_should_see : what a true picture of it shows.
    build : makes the scene; may take seconds, since bodies are put on voxels there.
    samples : jittered pictures that are averaged, enough for smooth edges.
    time_s : when it is drawn, and where an animation of it begins: rings on water need time to spread.
    """

    name: str
    title: str
    you_should_see: str
    build: Callable[[], Scene]
    samples: int = 4
    time_s: float = 0.0
