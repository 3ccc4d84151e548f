#!/usr/bin/env bash
# Tests that a study survives the death of a worker: cluster/test-hyperqueue.sh [STUDY.yaml]
#
# Starts a HyperQueue server and three workers on this machine, all on the loopback address, submits the study in 12 shards, kills a
# worker in the middle with SIGKILL, and compares every table, byte by byte, with those of one process. Ends what it started.
# HQ and BRYANT name the programs (defaults: hq on the path, target/release/bryant). Without STUDY it uses a study of sled-pendulum. If there is no hq,
# test-hyperqueue.py does the same with HyperQueue's package from PyPI.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
hq=${HQ:-hq}
export HQ=$hq BRYANT=${BRYANT:-$here/../target/release/bryant}
for program in "$hq" "$BRYANT"; do
    command -v "$program" >/dev/null || { echo "there is no program $program (HQ, BRYANT)" >&2; exit 2; }
done
shards=12

scratch=$(mktemp -d)
server="" workers=()
finish() {
    for process in "${workers[@]}" $server; do kill "$process" 2>/dev/null || true; done
    wait
    rm -rf "$scratch"
}
trap finish EXIT
export HQ_SERVER_DIR=$scratch/server

study=${1:-$scratch/study.yaml}
if [ $# -eq 0 ]; then
    cat >"$study" <<'STUDY'
model: sled-pendulum
design: monte carlo
runs: 49152
seed: 1
parameters:
  belt_stiffness: { from: 20 kN, to: 100 kN }
responses:
  - { of: chest belt force, what: peak }
tables: [parquet, csv]
STUDY
fi

# Waits until a command succeeds, for a minute at most.
until_true() {
    for _ in $(seq 600); do
        if "$@" 2>/dev/null; then return; fi
        sleep 0.1
    done
    echo "waited in vain for: $*" >&2
    exit 1
}
workers_are() { [ "$("$hq" --output-mode json worker list | python3 -c 'import json, sys; print(len(json.load(sys.stdin)))')" = "$1" ]; }
is_busy() { [ -n "$(ps -o pid= --ppid "$1")" ]; }
blocks_are_at_least() { [ "$(find "$scratch/sharded/blocks" -name '*.part' | wc -l)" -ge "$1" ]; }

"$hq" server start --host 127.0.0.1 >"$scratch/server.log" 2>&1 &
server=$!
until_true "$hq" server info >/dev/null
for k in 1 2 3; do
    "$hq" worker start --cpus 1 --detect-resources none --hostname "127.0.0.1" >"$scratch/worker$k.log" 2>&1 &
    workers+=($!)
done
until_true workers_are 3

"$here/hyperqueue.sh" "$study" "$scratch/sharded" "$shards" >"$scratch/submit.log" 2>&1 &
submission=$!
until_true blocks_are_at_least 3
until_true is_busy "${workers[0]}"
# Were it done already, nobody would have died in the middle.
if ! kill -0 "$submission" 2>/dev/null; then
    echo "the study was over before a worker could die: take a longer one" >&2
    exit 1
fi
# so that the shell says nothing of its own
disown "${workers[0]}"
kill -KILL "${workers[0]}"
echo "killed a worker when $(find "$scratch/sharded/blocks" -name '*.part' | wc -l) blocks were there"
if ! wait "$submission"; then
    cat "$scratch/submit.log" "$scratch"/sharded.logs/* >&2
    exit 1
fi
if ! compgen -G "$scratch/sharded.logs/*-1" >/dev/null; then
    echo "no shard was started a second time: the worker had none when it died" >&2
    exit 1
fi
"$hq" task list last

# whatever variables of a job array are set here
"$BRYANT" sweep "$study" --out "$scratch/single" --shard 0/1 >/dev/null
compared=0
for table in "$scratch"/single/results.*; do
    cmp "$table" "$scratch/sharded/$(basename "$table")"
    compared=$((compared + 1))
done
[ "$compared" -gt 0 ] || { echo "the merge wrote no table" >&2; exit 1; }
echo "$compared tables are the same, byte by byte"
