# SPDX-License-Identifier: GPL-2.0-or-later
# Writes OUT with the revision of the checkout ROOT and two fingerprints: of all sources of the program,
# on which every result depends, and of those that a cached operator comes from. Leaves it alone where nothing
# changed. The latter are found, not listed: what makes bodies (mesh, solver), and from the file that packs
# and stores operators on, every file that is included, with the source file of each header.
cmake_policy(VERSION 3.20)
execute_process(COMMAND git -C ${ROOT} describe --always --dirty OUTPUT_VARIABLE revision
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)

# Fingerprint of files, by their paths from ROOT and their contents.
function(fingerprint_of result)
  set(files ${ARGN})
  list(SORT files)
  list(REMOVE_DUPLICATES files)
  set(all "")
  foreach(file ${files})
    file(SHA256 ${ROOT}/${file} one)
    string(APPEND all "${file} ${one}\n")
  endforeach()
  string(SHA256 fingerprint "${all}")
  set(${result} ${fingerprint} PARENT_SCOPE)
endfunction()

# All files that one includes, and so on; of each header the source file beside it too.
function(included_from result)
  set(found "")
  set(left ${ARGN})
  while(left)
    list(POP_FRONT left file)
    if(file IN_LIST found OR NOT EXISTS ${ROOT}/${file})
      continue()
    endif()
    list(APPEND found ${file})
    string(REGEX REPLACE "[.]hpp$" ".cpp" source ${file})
    file(STRINGS ${ROOT}/${file} lines REGEX "^#include \"[^\"]+\"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${line}")
      list(APPEND left ${include})
    endforeach()
    list(APPEND left ${source})
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE bodies RELATIVE ${ROOT} ${ROOT}/mesh/*.?pp ${ROOT}/solver/*.?pp)
included_from(stored cases/work/body_store.cpp)
file(GLOB_RECURSE program RELATIVE ${ROOT} ${ROOT}/mesh/*.?pp ${ROOT}/solver/*.?pp ${ROOT}/contact/*.?pp
  ${ROOT}/cases/*.?pp ${ROOT}/cases/*.in)
fingerprint_of(operator_sources ${bodies} ${stored} CMakeLists.txt)
fingerprint_of(program_sources ${program} CMakeLists.txt)
set(content "inline constexpr const char *flank_revision = \"${revision}\";\n")
string(APPEND content "inline constexpr const char *flank_operator_sources = \"${operator_sources}\";\n")
string(APPEND content "inline constexpr const char *flank_program_sources = \"${program_sources}\";\n")
if(EXISTS ${OUT})
  file(READ ${OUT} present)
endif()
if(NOT "${content}" STREQUAL "${present}")
  file(WRITE ${OUT} "${content}")
endif()
if(LIST_OPERATOR_SOURCES) # for the test
  message("${bodies};${stored}")
endif()
