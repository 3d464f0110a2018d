#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# flank-contact as an engineer meets it: answers worked out by hand, exit codes, messages.
set -u
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAILED: $1"; exit 1; }
solve() { "$program" - 2>message; }

# Two independent springs of 1 mm/N, the second 1 mm away:
# T = 3 N mm, theta = (3 + 1) / 2 = 2, forces 2 and 1.
answer=$(solve <<<'LCP1 two springs
n 2  T 3  sym 1
l 1 1  g 0 1
C 1 0  0 1'); [[ $? -eq 0 ]] || fail "exit code of a solution"
[[ $answer == *"status OK"* && $answer == *"theta 2"* && $answer == *$'\np 2 1'* ]] ||
  fail "forces of two springs: $answer"
grep -q "^certificate 0" <<<"$answer" && grep -q "^pivots [0-9]" <<<"$answer" || fail "certificate and pivots"

# The other flank: levers negative, torque negative.
answer=$(solve <<<'LCP1 other n 2 T -3 sym 0 l -1 -1 g 0 1 C 1 0 0 1')
[[ $? -eq 0 && $answer == *"theta -2"* && $answer == *$'\np 2 1'* ]] || fail "negative torque: $answer"
answer=$(solve <<<$'LCP1 no lever\nn 1 T 1 sym 1 l -1 g 0 C 1')
[[ $? -eq 3 && $answer == *"status INFEASIBLE"* ]] || fail "no positive lever: $answer"
solve <<<$'LCP1 bad\nn 2 T 1 sym 1 l 1 nan' >/dev/null
[[ $? -eq 2 ]] && grep -q "l, number 2" message || fail "a nan is named"
"$program" nowhere.lcp 2>message; [[ $? -eq 2 ]] && grep -q nowhere.lcp message || fail "missing file"
"$program" 2>/dev/null; [[ $? -eq 2 ]] || fail "no argument"
"$program" --help | grep -q LCP1 || fail "--help"
echo "1 passed, 0 failed"
