#!/usr/bin/env bash
# create_venv.sh PYTHON FOLDER: makes a virtual environment with pip in it; a working one is kept as it is.
set -euo pipefail
python="$1"
folder="$2"

works() {
    "$folder/bin/python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1 &&
        "$folder/bin/python" -m pip --version >/dev/null 2>&1
}

works && exit 0
echo "creating $folder with $python"
if log="$("$python" -m venv --clear "$folder" 2>&1)" && works; then
    exit 0
fi

rm -rf "$folder"
version="$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')"
{
    echo "$log" | tail -n 3
    echo "$python could not make a virtual environment."
    echo "On Debian and Ubuntu its venv module is a package of its own: apt-get install python$version-venv"
} >&2
exit 1
