# SPDX-License-Identifier: BSD-3-Clause
# Sourced by scripts that count their steps and end with "N passed, N failed".
passed=0 failed=0

# step NAME COMMAND...: passes or fails as a whole.
step() {
  local name=$1
  shift
  echo "== $name"
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $name"; return 1; fi
}
