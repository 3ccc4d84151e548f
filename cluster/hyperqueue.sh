#!/usr/bin/env bash
# A study in shards on the workers of a HyperQueue server that is running: cluster/hyperqueue.sh STUDY.yaml FOLDER [SHARDS]
#
# Submits an array with a task for each shard, waits for it and merges. A shard whose worker dies is started again elsewhere, up to
# 20 times. All workers must be able to read FOLDER and the program. FOLDER.logs gets the messages of each shard in a file
# SHARD-ATTEMPT.
#
# HQ             the program hq (default: hq on the path)
# BRYANT         the program bryant (default: target/release/bryant of the repository, else bryant on the path)
# CPUS           processors of a shard (default 1)
# HQ_SERVER_DIR  which server, if not the default one
set -euo pipefail

if [ $# -lt 2 ]; then
    echo "usage: cluster/hyperqueue.sh STUDY.yaml FOLDER [SHARDS]" >&2
    exit 2
fi
study=$(realpath "$1") folder=$(realpath -m "$2") shards=${3:-12}
hq=${HQ:-hq}
if ! command -v "$hq" >/dev/null; then
    echo "there is no program $hq: take it from HyperQueue's releases (one file), put it on the path or name it by HQ." >&2
    echo "The Python package hyperqueue has no hq: it holds the interface for Python alone." >&2
    exit 2
fi
if [ -z "${BRYANT:-}" ]; then
    BRYANT=$(realpath -m "$(dirname "$0")/../target/release/bryant")
    [ -x "$BRYANT" ] || BRYANT=bryant
fi
bryant=$(command -v "$BRYANT") || { echo "there is no program $BRYANT: name it by BRYANT" >&2; exit 2; }
bryant=$(realpath "$bryant")

mkdir -p "$folder.logs"
# A shard is pinned to its processors, so it has as many threads as processors.
if ! "$hq" submit --wait --name bryant --array "0-$((shards - 1))" --crash-limit 20 --cpus "${CPUS:-1}" --pin taskset \
    --stdout none --stderr "$folder.logs/%{TASK_ID}-%{INSTANCE_ID}" -- \
    bash -c 'exec "$0" sweep "$1" --out "$2" --shard "$HQ_TASK_ID/$3"' "$bryant" "$study" "$folder" "$shards"; then
    echo "not every shard is done, see $folder.logs; the same command goes on from there" >&2
    exit 1
fi
"$bryant" merge "$folder"
