"""Writes the table of the lake into docs/speed.md, from a run of `pellucid bench water`.

    python tools/water_speed_table.py --write
    pellucid bench water --json > water.json; python tools/water_speed_table.py water.json --write

Other work on the machine spoils these numbers.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from marked_page import write_between

PAGE = Path(__file__).resolve().parents[1] / "docs" / "speed.md"
MARKS = "<!-- lake: written by tools/water_speed_table.py -->", "<!-- end of lake -->"
HEAD = "| row | median, ms | fastest | slowest | fps | processor, ms | ratio | error | largest passes |"
LARGEST = 3
NAMED_FROM = 0.05  # of a frame


def table(report: dict[str, Any]) -> str:
    """Lines of Markdown, one for each row of the suite."""
    lines = [HEAD, "|" + "---|" * HEAD.count(" | ") + "---|"]
    for row in report["rows"]:
        error = "" if row["error"] is None else f"{row['error']:.2g}"
        times = " | ".join(f"{row[key]:.0f}" for key in ("ms", "min_ms", "max_ms"))
        rate = f"{row['fps']:.2g} | {row['processor_ms']:.0f} | {row['ratio']:.2g}"
        lines.append(f"| `{row['name']}` | {times} | {rate} | {error} | {_passes(row['passes'])} |")
    return "\n".join(lines)


def _passes(passes: dict[str, float]) -> str:
    whole = sum(passes.values())
    largest = sorted(passes, key=passes.__getitem__, reverse=True)[:LARGEST]
    shares = {label: passes[label] / whole for label in largest}
    return ", ".join(f"{label} {100 * share:.0f} %" for label, share in shares.items() if share > NAMED_FROM)


def main() -> int:
    """Print the table, or write it into the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", nargs="?", type=Path, help="what the suite printed; it is run when not given")
    parser.add_argument("--write", action="store_true", help=f"put it into {PAGE.name}")
    asked = parser.parse_args()
    if asked.report is None:
        from pellucid.benchmarks import SUITES

        report = SUITES["water"]()
    else:
        report = json.loads(asked.report.read_text(encoding="utf-8"))
    lines = table(report)
    if not asked.write:
        print(lines)
        return 0
    write_between(PAGE, MARKS, lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
