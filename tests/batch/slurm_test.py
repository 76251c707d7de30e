#!/usr/bin/env python3
"""slurm_test.py SLIPFIT SBATCH_SCRIPT [MODULE]: the array script on a real Slurm of one node, started and stopped here.

Submits the array, kills one task's slipfit on the way, submits again, merges by a dependent job, and compares with a run
on a single machine; and with the table of examples/dask_batch.py, where the folder MODULE of the Python module is given and
Dask is installed. Exit code 77, saying why, where Slurm cannot run.
"""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

FILES = ("results.jsonl", "summary.csv", "failures.csv")
MODEL = "--stiffness 1000 --natural-frequency 200 --damping-ratio 0.05 --static-friction 6 --kinetic-friction 4".split()
SHARDS = 3
RECORDINGS = 200
PROGRAMS = ("munged", "mungekey", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol")
PATH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Cluster:
    """munged, slurmctld and slurmd of one node on 127.0.0.1, with everything they write in one folder."""

    def __init__(self, folder):
        self.folder = folder
        self.processes = []
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": str(folder / "slurm.conf")}
        for name in list(self.environment):  # the test itself may run in a Slurm job
            if name.startswith(("SLURM_", "SBATCH_")) and name != "SLURM_CONF":
                del self.environment[name]

    def write_configuration(self):
        host = socket.gethostname().split(".")[0]
        user = getpass.getuser()
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(f"""
ClusterName=slipfittest
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
AuthType=auth/munge
AuthInfo=socket={self.folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=1
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=test Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")

    def launch(self, *command):
        with (self.folder / f"{command[0]}.out").open("w") as output:
            self.processes.append(subprocess.Popen(command, env=self.environment, stdout=output, stderr=output))

    def start(self):
        self.write_configuration()
        key = self.folder / "munge.key"
        self.run("mungekey", "--create", f"--keyfile={key}")
        self.launch("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                    f"--seed-file={self.folder}/munge.seed")
        for _ in range(50):
            if (self.folder / "munge.socket").exists():
                break
            time.sleep(0.1)
        self.launch("slurmctld", "-D", "-i")
        self.launch("slurmd", "-D")
        for _ in range(150):
            if "idle" in self.run("sinfo", "-h", "-o", "%T", check=False):
                return
            if any(process.poll() is not None for process in self.processes):
                break
            time.sleep(0.2)
        logs = "\n".join(f"--- {log.name}\n{log.read_text()[-600:]}" for log in sorted(self.folder.glob("*.log")))
        skip(f"the daemons of Slurm do not start here\n{logs}")

    def stop(self):
        """The node first, then who commands it; only processes that were started here."""
        for process in reversed(self.processes):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def run(self, *command, check=True):
        result = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        if check and result.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))} ended with {result.returncode}: {result.stderr}")
        return result.stdout

    def wait_for(self, job):
        for _ in range(1200):
            if not self.run("squeue", "-h", "-j", job, check=False).strip():
                return
            time.sleep(0.1)
        sys.exit(f"job {job} does not end:\n{self.run('squeue')}")


def write_recordings(slipfit, folder):
    for i in range(RECORDINGS):
        options = f"--speed 20mm/s --duration {2 + i % 3} --sample-rate 1000 --noise 0.02 --jitter 0.05 --seed {i + 1}"
        subprocess.run([slipfit, "simulate", *MODEL, *options.split(), "--out", folder / f"r{i}.csv", "--quiet"],
                       check=True)
    rows = [f"x{i},{'none' if i % 100 == 99 else f'r{i}'}.csv,0.02" for i in range(RECORDINGS)]
    (folder / "runs.csv").write_text("\n".join(["id,file,speed_m_per_s", *rows]) + "\n")


def kill_one_task(folder):
    """SIGKILL to the first slipfit that has written something, by the process id in its lock."""
    for _ in range(600):
        for lock in folder.glob(f"results/shard-*-of-{SHARDS}/lock"):
            words = lock.read_text().split() if lock.exists() else []
            journal = lock.parent / "journal"
            if len(words) > 3 and journal.exists() and journal.stat().st_size > 0:
                try:
                    os.kill(int(words[3]), signal.SIGKILL)
                except ProcessLookupError:
                    continue
                return lock.parent.name
        time.sleep(0.01)
    sys.exit("no task of the array began its work")


def use(cluster, slipfit, script, folder):
    cluster.environment["SLIPFIT"] = slipfit
    submit = ("sbatch", "--parsable", f"--array=1-{SHARDS}", "--cpus-per-task=1", "--mem-per-cpu=0",
              f"--chdir={folder}", f"--output={folder}/task-%a.log", script, "runs.csv", "results")
    first = cluster.run(*submit).strip()
    print(f"array {first}: {SHARDS} tasks for {RECORDINGS} recordings; killed slipfit of {kill_one_task(folder)}")
    cluster.wait_for(first)
    finished = [run.parent.name for run in sorted(folder.glob("results/*/run.json")) if '"finished": true' in run.read_text()]
    print(f"array {first} ended; finished: {', '.join(finished)}")
    second = cluster.run(*submit).strip()
    merge = cluster.run("sbatch", "--parsable", f"--dependency=afterok:{second}", "--mem-per-cpu=0", f"--chdir={folder}",
                        f"--output={folder}/merge.log",
                        f"--wrap={slipfit} merge results/shard-*-of-{SHARDS} --out results/all || [ $? -eq 1 ]").strip()
    cluster.wait_for(merge)
    for log in (*sorted(folder.glob("task-*.log")), folder / "merge.log"):
        print(f"{log.name}: {' | '.join(log.read_text().split(chr(10))).strip(' |')}")


def compare(slipfit, folder):
    begin = time.monotonic()
    subprocess.run([slipfit, "batch", "runs.csv", "--out", "single", "--quiet"], cwd=folder, stderr=subprocess.DEVNULL)
    print(f"single machine: {time.monotonic() - begin:.2f} s")
    differing = [name for name in FILES
                 if (folder / "single" / name).read_bytes() != (folder / "results/all" / name).read_bytes()]
    if differing:
        sys.exit(f"merged and single run differ in {', '.join(differing)}")
    print(f"merged and single run are the same in {', '.join(FILES)}")


def compare_dask(folder, module):
    example = pathlib.Path(__file__).resolve().parents[2] / "examples" / "dask_batch.py"
    environment = {**os.environ, "PYTHONPATH": f"{module}:{example.parent}"}
    if subprocess.run([sys.executable, "-c", "import dask.distributed, slipfit"], env=environment, capture_output=True).returncode != 0:
        print("not compared with Dask, which is not installed (Debian: python3-dask, python3-distributed)")
        return
    begin = time.monotonic()
    run = subprocess.run([sys.executable, example, "runs.csv", "dask.csv"], cwd=folder, env=environment, capture_output=True, text=True)
    if run.returncode != 1 or (folder / "dask.csv").read_bytes() != (folder / "single" / "summary.csv").read_bytes():
        sys.exit(f"the table of Dask and that of the single run differ: {run.stdout} {run.stderr}")
    print(f"Dask: {time.monotonic() - begin:.2f} s; {run.stdout.strip()}, the same bytes as summary.csv")


def main():
    slipfit, script, *module = (str(pathlib.Path(argument).resolve()) for argument in sys.argv[1:4])
    missing = [program for program in PROGRAMS if not shutil.which(program, path=PATH)]
    if missing:
        skip(f"not installed: {', '.join(missing)} (Debian: slurm-wlm, munge)")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="slipfit-slurm-"))
    cluster = Cluster(folder)
    try:
        cluster.start()
        write_recordings(slipfit, folder)
        use(cluster, slipfit, script, folder)
        compare(slipfit, folder)
        if module:
            compare_dask(folder, module[0])
    finally:
        cluster.stop()
        shutil.rmtree(folder, ignore_errors=True)


main()
