#!/usr/bin/env python3
"""Tests that a study survives the death of a worker, with HyperQueue's package from PyPI alone: cluster/test-hyperqueue.py [STUDY.yaml]

Starts a HyperQueue server and three workers on this machine, submits the study in 12 shards, kills a worker in the middle with
SIGKILL, and compares every table, byte by byte, with those of one process. Ends what it started. BRYANT names the program
(default: target/release/bryant). Without STUDY it uses a study of sled-pendulum.

    python3 -m pip install -r cluster/requirements.txt

The package has the server, the workers and the client of the program `hq`, but not `hq` itself. It starts its workers as threads of the server's process,
where no single worker can be killed. So each worker here is a process of its own. It starts a server that nobody uses, and then lets
its folder point to the access file of the real server. After that it adds its worker, which therefore belongs to the real server. Processes,
sockets, heartbeats and the treatment of a lost worker are those of `hq worker start`.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SHARDS = 12
WORKERS = 3
# A shard whose worker dies is started again so many times.
CRASHES = 20
STUDY = """\
model: sled-pendulum
design: monte carlo
runs: 49152
seed: 1
parameters:
  belt_stiffness: { from: 20 kN, to: 100 kN }
responses:
  - { of: chest belt force, what: peak }
tables: [parquet, csv]
"""
# The link in the folder of a server by which workers and clients find its access file.
CURRENT = "hq-current"


def worker(server: str, own: str) -> None:
    """A process that is a worker of another process's server, until it is killed."""
    from hyperqueue.ffi.cluster import Cluster

    cluster = Cluster(own)
    link = pathlib.Path(own, CURRENT)
    link.unlink()
    link.symlink_to(pathlib.Path(server, CURRENT).resolve())
    cluster.add_worker(1)
    # ends with the test, whatever becomes of it
    sys.stdin.read()
    os._exit(0)


def serve(server: str) -> None:
    """A process that is the server, until its input ends."""
    from hyperqueue.ffi.cluster import Cluster

    cluster = Cluster(server)
    print("ready", flush=True)
    sys.stdin.read()
    cluster.stop()


def submit(server: str, bryant: str, study: str, folder: str) -> None:
    """A process that submits the shards and waits for them."""
    from hyperqueue import Client, Job

    logs = pathlib.Path(folder + ".logs")
    logs.mkdir(parents=True, exist_ok=True)
    job = Job(max_fails=None, name="bryant")
    for shard in range(SHARDS):
        # a line for each start of a shard
        told = f'echo started >>"{logs}/{shard}"; exec "$@" 2>>"{logs}/{shard}"'
        command = [bryant, "sweep", study, "--out", folder, "--threads", "1", "--shard", f"{shard}/{SHARDS}"]
        job.program(["bash", "-c", told, "bash", *command], stdout=None, stderr=None, crash_limit=CRASHES)
    client = Client(server)
    client.wait_for_jobs([client.submit(job)])


class Children:
    """Processes of this script, each with a role as its first argument."""

    def __init__(self, scratch: pathlib.Path):
        self.scratch = scratch
        self.all = []

    def start(self, name: str, role: str, *arguments, **options) -> subprocess.Popen:
        log = open(self.scratch / f"{name}.log", "wb")
        command = [sys.executable, __file__, role, *map(str, arguments)]
        # a group of its own, which holds what a worker runs, too
        child = subprocess.Popen(
            command, stdin=subprocess.PIPE, stderr=log, start_new_session=True, **{"stdout": log, **options}
        )
        self.all.append(child)
        return child

    def end(self) -> None:
        for child in self.all:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
        for child in self.all:
            child.wait()


def blocks(folder: pathlib.Path) -> int:
    return len(list(folder.glob("blocks/*.part")))


def runs_something(process: subprocess.Popen) -> bool:
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True, text=True)
    return bool(found.stdout.strip())


def until(what: str, true, submission: subprocess.Popen) -> None:
    """Waits, for a minute at most, and not beyond the end of the study."""
    for _ in range(1200):
        if true():
            return
        if submission.poll() is not None:
            raise SystemExit(f"error: the study was over before {what}: take a longer one, or see why it failed")
        time.sleep(0.05)
    raise SystemExit(f"error: waited a minute in vain: {what}")


def run(*command) -> None:
    """Runs the command, and shows what it says where it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit(f"error: {' '.join(map(str, command))}\n{done.stdout}")


def program() -> str:
    here = pathlib.Path(__file__).resolve().parent
    wanted = os.environ.get("BRYANT", str(here.parent / "target/release/bryant"))
    found = shutil.which(wanted)
    if found is None:
        raise SystemExit(f"error: there is no program {wanted}\n  help: name it by BRYANT")
    return os.path.abspath(found)


def test(scratch: pathlib.Path, children: Children, study: pathlib.Path) -> None:
    bryant = program()
    server = scratch / "server"
    serving = children.start("server", "serve", server, stdout=subprocess.PIPE)
    # what the server itself prints comes before
    if not any(line == b"ready\n" for line in serving.stdout):
        raise SystemExit("error: the server did not start:\n" + (scratch / "server.log").read_text())
    workers = [children.start(f"worker{k}", "worker", server, scratch / f"worker{k}") for k in range(WORKERS)]

    sharded = scratch / "sharded"
    submission = children.start("submission", "submit", server, bryant, study, sharded)
    try:
        until("there were three blocks", lambda: blocks(sharded) >= 3, submission)
        until("the first worker had a shard", lambda: runs_something(workers[0]), submission)
        os.killpg(workers[0].pid, signal.SIGKILL)
        print(f"killed a worker with SIGKILL when {blocks(sharded)} blocks were there", flush=True)
        if submission.wait(timeout=600) != 0:
            raise SystemExit("error: not every shard is done")
    except SystemExit:
        for log in sorted(scratch.glob("*.log")) + sorted(scratch.glob("sharded.logs/*")):
            print(f"-- {log.name}\n{log.read_text()}", file=sys.stderr)
        raise
    starts = {log.name: log.read_text().split("\n").count("started") for log in scratch.glob("sharded.logs/*")}
    again = [shard for shard, count in starts.items() if count > 1]
    if len(starts) != SHARDS or not again:
        raise SystemExit(f"error: no shard was started a second time: {starts}")
    print(f"{SHARDS} shards are done; started a second time: {', '.join(again)}", flush=True)

    single = scratch / "single"
    run(bryant, "merge", sharded)
    # 0/1 is all of it, whatever variables of a job array are set here
    run(bryant, "sweep", study, "--out", single, "--shard", "0/1")
    tables = sorted(single.glob("results.*")) + [single / "summary.json"]
    for table in tables:
        if table.read_bytes() != (sharded / table.name).read_bytes():
            raise SystemExit(f"error: {table.name} is not that of one process")
    print("the same, byte by byte, as of one process:", ", ".join(table.name for table in tables))


def main() -> None:
    roles = {"serve": serve, "worker": worker, "submit": submit}
    if len(sys.argv) > 1 and sys.argv[1] in roles:
        roles[sys.argv[1]](*sys.argv[2:])
        return
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        if len(sys.argv) > 1:
            study = pathlib.Path(sys.argv[1]).resolve()
        else:
            study = scratch / "study.yaml"
            study.write_text(STUDY)
        children = Children(scratch)
        try:
            test(scratch, children, study)
        finally:
            children.end()


if __name__ == "__main__":
    main()
