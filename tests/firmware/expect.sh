# What the tests of whole programs share; sourced by them. $out is a folder of the test's own.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
failed=0

# expect CODE PATTERN COMMAND...: exit code and one line of output that matches.
expect() {
  local code=$1 pattern=$2 got=0
  shift 2
  "$@" >"$out/said" 2>&1 || got=$?
  if [[ $got != "$code" ]] || ! grep -qE -- "$pattern" "$out/said"; then
    echo "FAILED: $*: exit $got (wanted $code), wanted a line like '$pattern', got:"
    cat "$out/said"
    failed=1
  fi
  if [[ $code == 2 ]] && grep -qE ':0: |line 0\b' "$out/said"; then
    echo "FAILED: $*: files begin with line 1: $(cat "$out/said")"
    failed=1
  fi
}

# refused PATTERN COMMAND...: exit code 2 and a single line that matches.
refused() {
  expect 2 "$@"
  if (($(wc -l <"$out/said") != 1)); then
    shift
    echo "FAILED: $*: more than one line:"
    cat "$out/said"
    failed=1
  fi
}
