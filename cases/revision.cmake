# SPDX-License-Identifier: GPL-2.0-or-later
# Writes OUT with the revision of the checkout ROOT and a fingerprint of the sources that a cached operator comes from; leaves
# it alone where nothing changed.
execute_process(COMMAND git -C ${ROOT} describe --always --dirty OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(GLOB_RECURSE sources ${ROOT}/mesh/*.?pp ${ROOT}/solver/*.?pp ${ROOT}/contact/half_space/*.?pp ${ROOT}/contact/grid/*.?pp
  ${ROOT}/cases/parallel_axis/body/*.?pp)
list(SORT sources)
set(all "")
foreach(source ${sources})
  file(SHA256 ${source} one)
  string(APPEND all ${one})
endforeach()
string(SHA256 fingerprint "${all}")
set(content "inline constexpr const char *flank_revision = \"${revision}\";\ninline constexpr const char *flank_operator_sources = \"${fingerprint}\";\n")
if(EXISTS ${OUT})
  file(READ ${OUT} present)
endif()
if(NOT "${content}" STREQUAL "${present}")
  file(WRITE ${OUT} "${content}")
endif()
