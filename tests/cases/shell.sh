# SPDX-License-Identifier: GPL-2.0-or-later
# Sourced by the tests of the program: SCRIPT FLANK ROOT. A working folder of its own, which goes at the end,
# with its own operator cache.
set -u
flank=$1 root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export FLANK_CACHE=$work/cache OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Whether the program can be given less of the system: the sanitizers' shadow of the memory does not fit in
# there, nor do they work with few files and stack.
takes_limits() { (ulimit -v 6000000; ASAN_OPTIONS= UBSAN_OPTIONS= "$flank" schema >/dev/null 2>&1); }
fail() { echo "FAILED: $1"; exit 1; }
