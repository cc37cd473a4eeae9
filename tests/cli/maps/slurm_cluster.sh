#!/bin/bash
# Runs COMMAND beside a real Slurm of one node, in FOLDER, which must be empty: munged, slurmctld and slurmd, without
# systemd. To be run as root, in a PID and UTS namespace of its own, so that nothing outlives it:
#   unshare -u -p -f --kill-child --mount-proc bash slurm_cluster.sh FOLDER COMMAND
set -euo pipefail
folder=$1
command=$2
chmod 755 "$folder"
hostname localhost
read -r controller_port daemon_port < <(python3 -c '
import socket
sockets = [socket.socket() for _ in range(2)]
for one in sockets: one.bind(("127.0.0.1", 0))
print(*[one.getsockname()[1] for one in sockets])')

export SLURM_CONF=$folder/slurm.conf
mkdir "$folder/state" "$folder/spool"
cat >"$SLURM_CONF" <<END
ClusterName=t
SlurmctldHost=localhost
SlurmUser=root
# A requeued job may start again once old credentials have expired: at once, not after two minutes.
AuthInfo=socket=$folder/munge.sock,cred_expire=5
SlurmctldPort=$controller_port
SlurmdPort=$daemon_port
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=1
MinJobAge=3600
MailProg=/bin/true
NodeName=localhost NodeAddr=127.0.0.1 CPUs=4 RealMemory=1000
PartitionName=p Nodes=localhost Default=YES MaxTime=10
END
echo CgroupPlugin=cgroup/v1 >"$folder/cgroup.conf"  # without it slurmd reads /sys/fs/cgroup, and may die of it

dd if=/dev/urandom of="$folder/munge.key" bs=1024 count=1 status=none
chmod 400 "$folder/munge.key"
munged -F -S "$folder/munge.sock" --key-file="$folder/munge.key" --pid-file="$folder/munged.pid" \
  --seed-file="$folder/munge.seed" --log-file="$folder/munged.log" >/dev/null 2>&1 &
munge=$!
# await SECONDS WHAT CONDITION: polls; gives up, with the daemons' last words.
await() {
  local until=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    if [ $SECONDS -ge $until ]; then
      echo "slurm_cluster.sh: gave up waiting for $what" >&2
      tail -n 20 "$folder"/*.log >&2
      exit 1
    fi
    sleep 0.1
  done
}
controller_answers() { scontrol ping 2>/dev/null | grep -q ' is UP'; }
node_is_idle() { [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; }
await 20 munged test -S "$folder/munge.sock"
slurmctld -D >/dev/null 2>&1 &
controller=$!
await 30 slurmctld controller_answers
slurmd -D -N localhost >/dev/null 2>&1 &
daemon=$!
await 30 slurmd node_is_idle

code=0
bash -c "$command" || code=$?
kill "$daemon" && wait "$daemon" || true
kill "$controller" && wait "$controller" || true
kill "$munge" && wait "$munge" || true
exit "$code"
