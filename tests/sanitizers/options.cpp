// SPDX-License-Identifier: GPL-2.0-or-later
// Part of every program of a build with FLANK_SANITIZE: what it tells the sanitizers at its start.
// ASAN_OPTIONS, UBSAN_OPTIONS and LSAN_OPTIONS add to it.

#define FLANK_SEEN_BY_LIBRARIES extern "C" __attribute__((visibility("default"), used))

FLANK_SEEN_BY_LIBRARIES const char *__asan_default_options()
{
  return "detect_stack_use_after_return=1:strict_init_order=1:check_initialization_order=1:print_"
         "suppressions=0";
}

FLANK_SEEN_BY_LIBRARIES const char *__ubsan_default_options()
{
  return "print_stacktrace=1";
}

FLANK_SEEN_BY_LIBRARIES const char *__lsan_default_suppressions()
{
  return "leak:/openmpi3/mca_\n"
         "leak:libgmsh.so\n"
         "leak:libmpi.so\n"
         "leak:libopen-pal.so\n"
         "leak:libopen-rte.so\n"
         "leak:libpmix.so\n"
         "leak:libhwloc.so\n"
         "leak:vasprintf\n";
}

/// Nothing is unloaded: the leaks of a library can be told from ours as long as it is there.
FLANK_SEEN_BY_LIBRARIES int dlclose(void *)
{
  return 0;
}
