# For scripts that run under tools/rig/run: a plant at one end of vcan0 and of a TCP port, the controller at the other.
# shellcheck shell=bash
# $RIG_ROBOT: another file of tools/rig/drive than robot.toml; $RIG_GOAL: another goal than the usual one;
# $RIG_HALL: another world of the far end;
# $RIG_SLOW: leave out what takes long on an emulated machine;
# $RIG_CAN and $RIG_FAR_CAN name other interfaces than vcan0: two controllers on one bus; an empty RIG_CAN: no bus, any kernel does.
# usage: source rig_session.sh JAYWALK PLANT ROOT
set -uo pipefail
jaywalk=$1 plant=$2 root=$3
talk=$(dirname "$plant")/jaywalk_talk
# In memory: a file of this machine's would hold up the guest, whose time is real.
out=$(mktemp -d -p /dev/shm) || exit 1
can=${RIG_CAN-vcan0} far_can=${RIG_FAR_CAN:-vcan0}
[ -z "$can" ] || [ -e "/sys/class/net/$can" ] || { rm -r "$out"; echo "skipped: no interface $can"; exit 77; }
sed "s/vcan0/$can/; s#/tmp/jaywalk_#$out/#; s#\"\.\./#\"$root/tools/rig/drive/../#" "$root/tools/rig/drive/${RIG_ROBOT:-robot}.toml" >"$out/robot.toml"
export JAYWALK_SOCKET=$out/control XDG_RUNTIME_DIR=$out/own
mkdir -m 700 "$out/own"
failed=0
run_pid='' plant_pid=''
mkfifo "$out/orders"
exec 3<>"$out/orders"

fail() {
  echo "FAILED: $*"
  failed=1
}
order() { echo "$*" >&3; }
status() { "$talk" status 2>/dev/null; }
# field NAME: its value in the status, empty where nobody answers.
field() {
  local said
  said=$'\n'$(status)
  [[ $said == *$'\n'"$1: "* ]] || return
  said=${said#*$'\n'"$1: "}
  echo "${said%%$'\n'*}"
}

# start_plant [OPTIONS...]
start_plant() {
  late_lines >"$out/late_before"
  mv "$out/late_before" "$out/late"
  rm -f "$out/plant.log"
  "$plant" "${RIG_HALL:-$root/tools/rig/drive/hall.toml}" --seed 3 --robot "$out/robot.toml" --can "$far_can" --log "$out/plant.log" "$@" <&3 &
  plant_pid=$!
  until [ -s "$out/plant.log" ]; do
    kill -0 "$plant_pid" 2>/dev/null || { fail "the plant did not start"; return 1; }
    sleep 0.1
  done
}
end_plant() {
  kill "$plant_pid" && wait "$plant_pid"
  plant_pid=''
}

# start_run [OPTIONS...]: until it takes goals. An emulated machine may refuse real-time priority or locked memory: what is tried here
# are the wires.
start_run() {
  : >"$out/run.log"
  rm -rf "$out/run"  # a run would set it aside, and the guest's memory is small
  "$jaywalk" run "$out/robot.toml" --backend cpu --allow-no-realtime --uncommissioned --out "$out/run" "$@" >"$out/run.log" 2>&1 &
  run_pid=$!
  until [[ $(<"$out/run.log") == *"ready for"* ]]; do
    kill -0 "$run_pid" 2>/dev/null || { fail "the run did not start: $(cat "$out/run.log")"; return 1; }
    sleep 0.2
  done
}
# end_run EXIT_CODE [SIGNAL]
end_run() {
  local code=0
  kill "-${2:-TERM}" "$run_pid"
  wait "$run_pid" || code=$?
  run_pid=''
  [ "$code" = "$1" ] || fail "the run's exit code is $code, not $1: $(cat "$out/run.log")"
}

# await_said SECONDS PATTERN: the run says so. Looks seldom: new processes take the guest's one processor.
await_said() {
  local end=$((SECONDS + $1))
  while [ "$SECONDS" -le "$end" ]; do
    [[ ! $(<"$out/run.log") =~ $2 ]] || return 0
    sleep 0.5
  done
  fail "the run did not say '$2' within $1 s: $(<"$out/run.log")"
  return 1
}
# await SECONDS FIELD PATTERN
await() {
  local end=$((SECONDS + $1))
  while [ "$SECONDS" -le "$end" ]; do
    [[ $(field "$2") != $3 ]] || return 0
    sleep 0.3
  done
  fail "$2 is not $3 after $1 s: $(status | tr '\n' ' ')"
  return 1
}
# logged PATTERN: the plant saw it.
logged() { grep -qE -- "$1" "$out/plant.log" || fail "the plant saw no '$1': $(cat "$out/plant.log")"; }
# number FILE KEY: from a JSON file of ours.
number() { sed -nE "s/^ *\"$2\": ([-0-9.]+),?$/\1/p" "$1" | head -1; }

# late_lines: where the far end says that it was held up itself. It goes before everything else on the guest's
# processor: what held it up was the machine that the guest runs on.
late_lines() { cat "$out/late" "$out/plant.log" 2>/dev/null | grep ' late by '; }
# missed_ticks_alone: whether that is all that stopped the robot.
missed_ticks_alone() { grep -q 'stopped by' "$out/run.log" && ! grep 'stopped by' "$out/run.log" | grep -qv missed_ticks; }

end_session() {
  # Whoever runs this may try again where time was not kept.
  if [ "$failed" = 1 ] && { missed_ticks_alone || [ -n "$(late_lines)" ]; }; then
    echo "held up: this machine did not keep time: $(late_lines | sort -k4nr | head -3 | tr '\n' ' ')"
  fi
  [ -z "$run_pid" ] || kill -9 "$run_pid"
  [ -z "$plant_pid" ] || kill -9 "$plant_pid"
  rm -rf "$out"
  exit "$failed"
}
