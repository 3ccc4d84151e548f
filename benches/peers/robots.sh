#!/usr/bin/env bash
# Compares this project with Pinocchio and MuJoCo on robots of example-robot-data: ./robots.sh [FOLDER [OPTION...]], options as of robots.py.
#
# FOLDER and what it needs are those of run.sh; the table is robots.md there.
set -euo pipefail
. "$(dirname "$0")/prepare.sh"
export PYTHONDONTWRITEBYTECODE=1
"$folder/venv/bin/python" "$here/robots.py" prepare "$folder/robots"

host=$(rustc -vV | sed -n 's/^host: //p')
(cd "$here/ours" && ROBOTS=$folder/robots CARGO_TARGET_DIR=$folder/target cargo build --locked --release --quiet --target "$host")
cp "$folder/target/$host/release/ours" "$folder/ours-robots"

exec "$folder/venv/bin/python" "$here/robots.py" --work "$folder/programs" --robots "$folder/robots" --markdown "$folder/robots.md" \
    --ours "$folder/ours-robots" "$@"
