#!/usr/bin/env bash
# Compares this project with Pinocchio and MuJoCo: ./run.sh [FOLDER [OPTION...]], options as of compare.py.
#
# FOLDER (default: target/peers of the repository) keeps the virtual environment, the programs and the tables, peers.md. It needs
# CPython 3.11, gcc and g++, a Rust toolchain, and PyPI the first time; the first run compiles for several minutes.
set -euo pipefail
. "$(dirname "$0")/prepare.sh"

# Builds twice: for any processor, as cargo does by default, and for this one. With an explicit target the flags do not apply to the
# build script, so that the generator is compiled once.
host=$(rustc -vV | sed -n 's/^host: //p')
build() {
    (cd "$here/ours" && CARGO_TARGET_DIR=$folder/target RUSTFLAGS=$2 cargo build --locked --release --quiet --target "$host")
    cp "$folder/target/$host/release/ours" "$folder/$1"
}
build ours ""
build ours-native "-C target-cpu=native"

export PYTHONDONTWRITEBYTECODE=1
exec "$folder/venv/bin/python" "$here/compare.py" --work "$folder/programs" --markdown "$folder/peers.md" \
    --ours "$folder/ours" --ours-native "$folder/ours-native" "$@"
