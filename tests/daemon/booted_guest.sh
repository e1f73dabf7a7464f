# Runs in the machine that tests/daemon/booted boots, as root, and says "ok" or "not ok" of each
# thing that the unit promises.
exec >/dev/console 2>&1
stty -onlcr </dev/console
ask() { # REQUEST [PORT]: what lilod answers
    exec 3<>"/dev/udp/127.0.0.1/${2:-9871}"
    printf '%s' "$1" >&3
    timeout 3 dd bs=2048 count=1 <&3 2>/dev/null
    exec 3>&-
}
session() { ask '{"query":"hello"}' | sed -n 's/.*"session":"\([0-9a-f]*\)".*/\1/p'; }
property() { systemctl show -P "$1" "${2:-lilod}"; }
now_ms() { date +%s%3N; }
check() { # WHAT CONDITION...
    local what=$1
    shift
    if "$@"; then echo "ok - $what"; else echo "not ok - $what"; fi
}
within() { # SECONDS COMMAND...: until it succeeds
    local end=$(($(now_ms) + $1 * 1000))
    shift
    until "$@"; do
        (($(now_ms) < end)) || return 1
        sleep 0.05
    done
}
status_has() { [[ $(property StatusText) == *"$1"* ]]; }
new_session() { local s; s=$(session); [[ -n $s && $s != "$old_session" ]]; }
both_active() { systemctl is-active -q lilod && systemctl is-active -q lilod@front; }
front_answers() { [[ $(ask '{"query":"hello"}' 9971) == *hello* ]]; }
thread_field() { # NAME FIELD of proc(5)'s stat
    local task stat fields
    for task in /proc/"$(property MainPID)"/task/*; do
        [[ $(<"$task/comm") == "$1" ]] || continue
        stat=$(<"$task/stat")
        read -ra fields <<<"${stat##*) }"
        echo "${fields[$(($2 - 3))]}"
    done
}
journal_has() { journalctl -q -u lilod "${@:2}" | grep -q -- "$1"; }
status_field() { sed -n "s/^$1:\s*//p" "/proc/$(property MainPID)/status"; }

echo "systemd $(systemctl --version | sed -n '1s/systemd \([0-9]*\).*/\1/p'), kernel $(uname -r)"
began=$(now_ms)
check "start returns when it is ready" systemctl start lilod
echo "# ready after $(($(now_ms) - began)) ms"
check "it is active" systemctl is-active -q lilod
check "it says in words what it waits for" status_has "waiting for the sensor"
uid=$(status_field Uid | cut -f1)
check "its user is a dynamic one ($uid)" test "$uid" -ge 61184 -a "$uid" -le 65519
check "it has no capability" test "$(status_field CapEff)$(status_field CapBnd)" = 00000000000000000000000000000000
check "the worker is SCHED_FIFO" test "$(thread_field lilo-worker 41)" = 1
check "at priority 40" test "$(thread_field lilo-worker 40)" = 40
check "the receiver one above" test "$(thread_field lilo-receiver 40)" = 41
check "memory is locked ($(status_field VmLck))" test "$(status_field VmLck | tr -dc 0-9)" -gt 10000
check "health says: real time as configured" grep -q '"as_configured":true' <(ask '{"query":"health"}')
check "no warning in the journal" test -z "$(journalctl -q -u lilod -p warning)"
check "metrics are there for all to read" test "$(stat -c %a /run/lilod/lilo.prom)" = 644

# Slowly: the processor is an emulated one.
lilo replay /drive.pcap --loop --speed 0.1 >/dev/null 2>&1 &
check "it tracks, and says so" within 60 status_has "tracking"
check "a trajectory can be saved" grep -q '"done"' <(ask '{"save":"trajectory"}')
check "where systemd made room for it" test -s /var/lib/lilod/trajectory.tum

pid=$(property MainPID)
sed -i 's/level: info/level: debug/' /etc/lilod/lilod.yaml
check "reload succeeds" systemctl reload lilod
check "in the same process" test "$(property MainPID)" = "$pid"
check "what changed is in the journal" within 10 journal_has 'log.level is now'
cp /etc/lilod/lilod.yaml /good.yaml
echo 'colour: green' >>/etc/lilod/lilod.yaml
systemctl reload lilod
check "a bad file is an error in the journal" within 10 journal_has 'lilod.yaml:.*colour' -p err
check "and leaves it active" systemctl is-active -q lilod
cp /good.yaml /etc/lilod/lilod.yaml

old_session=$(session)
began=$(now_ms)
kill -9 "$(property MainPID)"
check "killed, it is back in a new session" within 20 new_session
echo "# after $(($(now_ms) - began)) ms"

within 60 status_has "tracking"
old_session=$(session)
restarts=$(property NRestarts)
began=$(now_ms)
stall_thread "$(property MainPID)" lilo-worker &
check "a stalled worker is found by the watchdog" within 20 journal_has 'Watchdog timeout'
echo "# after $(($(now_ms) - began)) ms"
check "and lilod is back in a new session" within 20 new_session
check "which counts as a restart" test "$(property NRestarts)" -eq $((restarts + 1))
check "and tracks again" within 60 status_has "tracking"

check "another instance starts beside it" systemctl start lilod@front
check "and both run" both_active
check "on a port of its own" within 20 front_answers
systemctl stop lilod@front

began=$(now_ms)
check "stop succeeds" systemctl stop lilod
echo "# after $(($(now_ms) - began)) ms"
check "by its own exit" test "$(property Result) $(property ExecMainStatus)" = "success 0"
check "and leaves no runtime directory" test ! -e /run/lilod
journalctl -q -u 'lilod*' -o short-monotonic --no-hostname # for --console
echo "the end"
systemctl reboot --force --force
