#!/usr/bin/env bash
# Prints the first Python of version 3.11 or newer; says what to install when there is none.
# Each candidate is run, not only looked up: version managers leave commands on the path that do not start.
set -euo pipefail

for candidate in ${PYTHON:-} python3 python3.11 python3.12 python3.13; do
    if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then
        command -v "$candidate"
        exit 0
    fi
done

{
    echo "Pellucid needs Python 3.11 or newer; none of python3, python3.11, python3.12, python3.13 is one."
    case "$(uname -s)" in
        Darwin) echo "Install it with: brew install python@3.12" ;;
        *) echo "Install it with your package manager, for example: apt-get install python3.11 python3.11-venv" ;;
    esac
    echo "Or name one: make PYTHON=/path/to/python3 ..."
} >&2
exit 1
