# SPDX-License-Identifier: GPL-3.0-or-later
# The README keeps its word: its C program compiles and runs against the built library, and every source
# file is in its tour.
# cmake -DROOT= -DLIBRARY= -DWORK= -DCC= -DFLAGS= -P tests/test_readme.cmake
cmake_minimum_required(VERSION 3.25)
file(READ ${ROOT}/README.md readme)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

string(REGEX MATCH "```c\n([^`]*)```" found "${readme}")
if(NOT found)
  message(FATAL_ERROR "README.md holds no C program")
endif()
file(WRITE ${WORK}/readme.c "${CMAKE_MATCH_1}")
get_filename_component(folder ${LIBRARY} DIRECTORY)
execute_process(COMMAND ${CC} -std=gnu17 -Wall -Wextra ${FLAGS} -I${ROOT}/lib -I${ROOT} readme.c -o readme
                        ${LIBRARY} -Wl,-rpath,${folder}
                WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed ERROR_VARIABLE said)
if(failed OR said)
  message(FATAL_ERROR "the README's program does not compile cleanly:\n${said}")
endif()
execute_process(COMMAND ./readme ${ROOT}/data/block.vtu WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed
                OUTPUT_VARIABLE said ERROR_VARIABLE error)
if(failed)
  message(FATAL_ERROR "the README's program failed (${failed}): ${said}${error}")
endif()
# half way through its half sine the muscle is short, at the end it is long again
string(REGEX MATCH "150 ms: fibre stretch 0\\.([0-9]+)" half "${said}")
if(NOT half OR CMAKE_MATCH_1 LESS 5000 OR CMAKE_MATCH_1 GREATER 9000)
  message(FATAL_ERROR "the README's muscle does not contract:\n${said}")
endif()

file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/lib/*.[ch] ${ROOT}/lib/*.cc ${ROOT}/lib/*.hh ${ROOT}/fibers/*.[ch]
     ${ROOT}/tools/*.[ch])
foreach(source ${sources})
  string(REGEX REPLACE "\\.(c|h|cc|hh)$" "" name ${source})
  string(FIND "${readme}" "`${name}." place)
  if(place EQUAL -1)
    message(FATAL_ERROR "README.md: the tour of the source leaves out ${source}")
  endif()
endforeach()
