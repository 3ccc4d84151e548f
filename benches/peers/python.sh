#!/usr/bin/env bash
# Compares the Python package with Pinocchio and MuJoCo as a user of Python calls them: ./python.sh [FOLDER [OPTION...]],
# options as of python.py.
#
# FOLDER and what it needs are those of run.sh; the table is python.md there. The wheel is built as users get it, which
# takes ten minutes the first time.
set -euo pipefail
. "$(dirname "$0")/prepare.sh"
pip() { "$folder/venv/bin/pip" --quiet --disable-pip-version-check "$@"; }
pip install -r "$here/../../python/requirements.txt"
rm -rf "$folder/wheels"
(cd "$here/../../python" && PATH="$folder/venv/bin:$PATH" maturin build --quiet --locked --release --out "$folder/wheels")
pip install --no-deps --force-reinstall "$folder"/wheels/bryant-*.whl
# for their sizes; MuJoCo's library is in a package of its own
sed -nE 's/^pin==/pin==/p; s/^mujoco==/mujoco-core==/p' "$here/requirements.txt" >"$folder/others.txt"
pip download --no-deps --dest "$folder/wheels" -r "$folder/others.txt"

# not PYTHONDONTWRITEBYTECODE: the time of an import is that of a package whose modules are compiled already
export PYTHONPYCACHEPREFIX=$folder/compiled
"$folder/venv/bin/python" "$here/robots.py" prepare "$folder/robots"
exec "$folder/venv/bin/python" "$here/python.py" --robots "$folder/robots" --wheels "$folder/wheels" --markdown "$folder/python.md" "$@"
