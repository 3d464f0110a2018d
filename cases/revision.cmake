# SPDX-License-Identifier: GPL-2.0-or-later
# Writes OUT with the revision of the checkout ROOT; leaves it alone where nothing changed.
execute_process(COMMAND git -C ${ROOT} describe --always --dirty OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(content "inline constexpr const char *flank_revision = \"${revision}\";\n")
if(EXISTS ${OUT})
  file(READ ${OUT} present)
endif()
if(NOT "${content}" STREQUAL "${present}")
  file(WRITE ${OUT} "${content}")
endif()
