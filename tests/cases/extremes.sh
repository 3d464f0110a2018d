#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The quick ones of validation/extremes: scenes at the ends of what the program takes.
source "$(dirname "$0")/shell.sh"
FLANK=$flank "$root/validation/extremes/run" --quick >screen 2>&1 || { cat screen; fail "extreme scenes"; }
[[ $(grep -c " s  holds$" screen) -ge 10 ]] || { cat screen; fail "number of scenes"; }
echo "1 passed, 0 failed"
