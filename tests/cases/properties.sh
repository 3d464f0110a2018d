#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Twenty (or FLANK_RANDOM_CASES) random cases of validation/properties: what must hold of every result,
# and between cases that say the same.
source "$(dirname "$0")/shell.sh"
cases=${FLANK_RANDOM_CASES:-20}
FLANK=$flank "$root/validation/properties/run" "$cases" --seed 1 --folder "$work/properties" >screen 2>&1 ||
  { cat screen; fail "properties of random cases"; }
grep -q "^$cases cases, .* 0 failed$" screen || { cat screen; fail "summary"; }
FLANK=$flank "$root/validation/properties/run" "$cases" --seed 1 --folder "$work/properties" >again 2>&1
cmp <(tail -1 screen) again || fail "a second run goes on from the first"
# A tip beyond the line to its axis, with a lever below nothing and no flank before it, must not count as the
# first to touch (89, 174); places beyond the base circle must not count as its own (981, 1777); springs that
# tilt past the backlash under one torque of three cost that torque alone (746).
for seed in 89 174 746 981 1777; do
  FLANK=$flank "$root/validation/properties/run" --seed $seed --folder "$work/found" >screen 2>&1 ||
    { cat screen; fail "seed $seed"; }
done
echo "1 passed, 0 failed"
