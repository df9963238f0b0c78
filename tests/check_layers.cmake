# SPDX-License-Identifier: GPL-3.0-or-later
# Holds the order of the tree: cmake -DROOT=<source folder> -P tests/check_layers.cmake
#   a room includes itself and the rooms before it in the list
#   outside libraries are seen by the rooms that wrap them only
#   every source file begins with its licence and has at most 500 lines
#   the top level holds nothing but what is listed here
cmake_minimum_required(VERSION 3.25)
set(rooms base mesh model mech solve io fibers run viscera.h tools)
set(top_level lib tools data fibers tests CMakeLists.txt CMakePresets.json LICENSE README.md)
set(longest 500)
# <header that begins so>=<files that may include it>
set(wrapped "vtk=^lib/io/vtk[^/]*$" "hdf5=^lib/io/hdf5_module" "suitesparse=^lib/solve/cholmod" "cyaml=^lib/io/"
    "udunits=^lib/io/" "expat=^lib/io/(pvd|vtk_xml)" "plplot=^tools/plot/" "cairo=^tools/plot/")

set(faults "")
macro(fault text)
  list(APPEND faults "${text}")
endmacro()

# The files of the project, relative to ROOT: what git knows or would take, else all of them.
if(EXISTS ${ROOT}/.git)
  execute_process(COMMAND git -C ${ROOT} ls-files --cached --others --exclude-standard
                  OUTPUT_VARIABLE files RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "git can't list the files of ${ROOT}")
  endif()
  string(REGEX REPLACE "\n" ";" files "${files}")
else()
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/*)
endif()

# The place of a file or of an included name in the list of rooms; -1 where it has none.
function(place_of path place)
  string(REGEX REPLACE "^lib/" "" path "${path}")
  string(REGEX REPLACE "/.*" "" room "${path}")
  list(FIND rooms "${room}" found)
  set(${place} ${found} PARENT_SCOPE)
endfunction()

function(check_includes file)
  place_of(${file} own)
  if(own EQUAL -1)
    return() # tests may include anything
  endif()
  file(STRINGS ${ROOT}/${file} lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[^<\"]*([<\"])([^>\"]*).*" "\\1;\\2" parts "${line}")
    list(GET parts 0 quote)
    list(GET parts 1 name)
    foreach(rule IN LISTS wrapped)
      string(REGEX REPLACE "=.*" "" begin "${rule}")
      string(REGEX REPLACE "^[^=]*=" "" may "${rule}")
      if(name MATCHES "^${begin}" AND NOT file MATCHES "${may}")
        fault("${file} includes ${name}: only ${may} may")
      endif()
    endforeach()
    if(quote STREQUAL "\"")
      place_of(${name} other)
      if(other EQUAL -1)
        fault("${file} includes \"${name}\": write room/file.h, or <${name}> if it isn't ours")
      elseif(other GREATER own)
        fault("${file} includes \"${name}\": includes go downwards only (${rooms})")
      endif()
    endif()
  endforeach()
  set(faults "${faults}" PARENT_SCOPE)
endfunction()

function(check_text file)
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "[^\n]" "" ends "${text}")
  string(LENGTH "${ends}" count)
  if(count GREATER longest)
    fault("${file} has ${count} lines, ${longest} are the most")
  endif()
  string(REGEX REPLACE "^#![^\n]*\n" "" text "${text}")
  if(NOT text MATCHES "^(//|#) SPDX-License-Identifier: GPL-3\\.0-or-later\n")
    fault("${file} doesn't begin with its SPDX line")
  endif()
  set(faults "${faults}" PARENT_SCOPE)
endfunction()

foreach(file IN LISTS files)
  if(NOT file OR NOT EXISTS ${ROOT}/${file})
    continue() # the end of the list, or removed and not yet committed
  endif()
  string(REGEX REPLACE "/.*" "" top "${file}")
  if(NOT top MATCHES "^\\." AND NOT top IN_LIST top_level)
    fault("${top} lies at the top level, which holds only: ${top_level}")
  endif()
  if(file MATCHES "\\.(c|h|cc|hh)$")
    check_includes(${file})
  endif()
  if(file MATCHES "\\.(c|h|cc|hh|cmake|in|sh|py)$|CMakeLists\\.txt$"
     OR file MATCHES "^(tools|tests|\\.ci)/([^/]*/)*[^./]+$") # scripts
    check_text(${file})
  endif()
endforeach()

if(faults)
  list(JOIN faults "\n  " text)
  message(FATAL_ERROR "the order of the tree is broken:\n  ${text}")
endif()
