"""Pictures of the pages, made small from those of the gallery.

Run ``pellucid demo --output out/demo`` and then ``python tools/make_docs_images.py out/demo``. It writes
docs/images/gallery/NAME.jpg (400 x 300) and docs/images/demo.jpg, the sheet of them all for the README; with
``--comparison out/povray`` also the pictures of ``tools/compare_povray.py`` that docs/truth.md shows, and with
``--light out/light`` those of ``tools/light_pictures.py`` that docs/light.md shows, with ``--relief out/relief`` those
of ``tools/relief_pictures.py``, with ``--sheet out/sheet`` those of ``tools/sheet_pictures.py``, with ``--mitsuba
out/mitsuba_relief`` those of ``tools/compare_mitsuba_relief.py``, with ``--pool out/mitsuba_pool`` those of
``tools/compare_mitsuba_pool.py``. Without a folder, only the latter.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import OpenImageIO

DOCS = Path(__file__).resolve().parents[1] / "docs" / "images"
THUMBNAIL = (400, 300)
SHEET_WIDTH = 800
LIGHT = {"fluence": (288, 384), "intensity": (288, 384), "caustic": (512, 384)}
RELIEF = {"example": (640, 480), "steps": (1280, 480)}
SHEET = {"example": (480, 360), "errors": (880, 300)}
POOL = ("mitsuba", "pellucid", "one_lamp", "pellucid_difference_x4", "one_lamp_difference_x4")
LAYERS = ("mitsuba", "pellucid", "pellucid_caustics", "pellucid_difference_x4", "pellucid_caustics_difference_x4")
COMPARED = ("povray", "sharp", "smooth", "sharp_difference_x4", "smooth_difference_x4")


def write_jpeg(source: Path, target: Path, size: tuple[int, int], quality: int) -> None:
    """A picture at another size, as JPEG of a quality of 1 to 100."""
    picture = OpenImageIO.ImageBuf(str(source))
    picture = OpenImageIO.ImageBufAlgo.channels(picture, (0, 1, 2))
    small = OpenImageIO.ImageBufAlgo.resize(picture, filtername="lanczos3", roi=OpenImageIO.ROI(0, size[0], 0, size[1]))
    small.specmod().attribute("Compression", f"jpeg:{quality}")
    target.parent.mkdir(parents=True, exist_ok=True)
    if not small.write(str(target)):
        sys.exit(f"{target}: {small.geterror() or OpenImageIO.geterror()}")


def write_gallery(demo: Path) -> None:
    """Every picture of the gallery, and the sheet of them all."""
    from pellucid.gallery import PICTURES

    for number, picture in enumerate(PICTURES, start=1):
        source = demo / f"{number:02d}_{picture.name}.png"
        write_jpeg(source, DOCS / "gallery" / f"{picture.name}.jpg", THUMBNAIL, 82)
    sheet = demo / "contact_sheet.png"
    spec = OpenImageIO.ImageBuf(str(sheet)).spec()
    write_jpeg(sheet, DOCS / "demo.jpg", (SHEET_WIDTH, round(SHEET_WIDTH * spec.height / spec.width)), 74)


def main() -> None:
    """Write every picture; stop at the first that is missing."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("demo", type=Path, nargs="?", help="folder that `pellucid demo` wrote")
    parser.add_argument("--comparison", type=Path, help="folder that tools/compare_povray.py wrote")
    parser.add_argument("--light", type=Path, help="folder that tools/light_pictures.py wrote")
    parser.add_argument("--relief", type=Path, help="folder that tools/relief_pictures.py wrote")
    parser.add_argument("--sheet", type=Path, help="folder that tools/sheet_pictures.py wrote")
    parser.add_argument("--mitsuba", type=Path, help="folder that tools/compare_mitsuba_relief.py wrote")
    parser.add_argument("--pool", type=Path, help="folder that tools/compare_mitsuba_pool.py wrote")
    options = parser.parse_args()
    if options.demo:
        write_gallery(options.demo)
    for name in COMPARED if options.comparison else ():
        write_jpeg(options.comparison / f"{name}.png", DOCS / "povray" / f"{name}.jpg", THUMBNAIL, 85)
    for name, size in LIGHT.items() if options.light else ():
        write_jpeg(options.light / f"{name}.png", DOCS / "light" / f"{name}.jpg", size, 85)
    for name, size in RELIEF.items() if options.relief else ():
        write_jpeg(options.relief / f"{name}.png", DOCS / "relief" / f"{name}.jpg", size, 85)
    for name, size in SHEET.items() if options.sheet else ():
        write_jpeg(options.sheet / f"{name}.png", DOCS / "sheet" / f"{name}.jpg", size, 82)
    for name in LAYERS if options.mitsuba else ():
        write_jpeg(options.mitsuba / f"{name}.png", DOCS / "relief" / f"{name}.jpg", (320, 240), 85)
    for name in POOL if options.pool else ():
        write_jpeg(options.pool / f"{name}.png", DOCS / "water" / f"{name}.jpg", (288, 216), 85)


if __name__ == "__main__":
    main()
