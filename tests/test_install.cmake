# SPDX-License-Identifier: GPL-3.0-or-later
# Installs into a folder of its own, moves it, and builds a user's program against it twice: by
# pkg-config and by find_package.
# cmake -DBUILD= -DWORK= -DCC= -DFLAGS= -DBINDIR= -DLIBDIR= -DDATADIR= -P tests/test_install.cmake
cmake_minimum_required(VERSION 3.25)
set(prefix ${WORK}/moved)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed
                  OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed (${failed}):\n${said}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

function(expect text)
  if(NOT said MATCHES "${text}")
    message(FATAL_ERROR "expected '${text}', was told '${said}'")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${prefix})

file(WRITE ${WORK}/user.c [[
#include <stdio.h>
#include <viscera.h>

int main(void)
{
  const double nodes[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 6};
  const uint32_t tet[4] = {0, 1, 2, 3};
  vsc_mesh *mesh = NULL;
  vsc_error error;
  if (vsc_mesh_from_arrays(4, nodes, 1, tet, &mesh, &error) != VSC_OK) return puts(error.text), 1;
  printf("volume %g\n", vsc_mesh_element_volume(mesh, 0));
  vsc_mesh_free(mesh);
  return 0;
}
]])

# By pkg-config.
set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
run(pkg-config --cflags --libs viscera)
separate_arguments(flags UNIX_COMMAND "${said} ${FLAGS}")
run(${CC} -std=gnu17 -Wall -Wextra -Werror user.c -o user ${flags} -Wl,-rpath,${prefix}/${LIBDIR})
run(./user)
expect("volume 1\n")

# By find_package.
file(WRITE ${WORK}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(user C)
find_package(viscera 0.1 REQUIRED CONFIG)
add_executable(user user.c)
target_link_libraries(user PRIVATE viscera::viscera)
")
run(${CMAKE_COMMAND} -S . -B build -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_C_COMPILER=${CC}
    "-DCMAKE_C_FLAGS=-std=gnu17 -Wall -Wextra -Werror ${FLAGS}")
run(${CMAKE_COMMAND} --build build)
run(build/user)
expect("volume 1\n")

# The installed programs find their library, each other and the data.
run(${prefix}/${BINDIR}/viscera --version)
expect("^viscera [0-9]+\\.[0-9]+")
if(EXISTS ${prefix}/${BINDIR}/viscera-plot)
  run(${prefix}/${BINDIR}/viscera plot --help)
  expect("Usage: viscera plot")
endif()
run(${prefix}/${BINDIR}/viscera info ${prefix}/${DATADIR}/viscera/lv.vtu)
expect("tetrahedra")

run(${prefix}/${BINDIR}/viscera bench start --times 1 -t 1 -o start)
expect("share/viscera/beat.yaml, 1 starts")
run(${prefix}/${BINDIR}/viscera bench accuracy --only beam-0.3-quadratic-1 --no-pictures -o accuracy)
expect("accuracy/accuracy.csv")

# They load their modules when these are needed, and name one that is not there.
set(scene ${prefix}/${DATADIR}/viscera/block.yaml)
set(beginning ${prefix}/${BINDIR}/viscera run -q ${scene} -o block --set keep_volume=total --stop)
run(${beginning} "0.1 ms")
run(${prefix}/${BINDIR}/viscera info block/checkpoint.h5)
expect("position +[0-9]+ x 4")
function(run_without module)
  set(file ${prefix}/${LIBDIR}/viscera/${module}.so)
  file(RENAME ${file} ${file}.away)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed ERROR_VARIABLE said)
  file(RENAME ${file}.away ${file})
  if(NOT failed EQUAL 4)
    message(FATAL_ERROR "without ${module} the exit code is ${failed}")
  endif()
  expect("the module ${module} cannot be loaded .*: install the package lib")
endfunction()

# Before the first step, and before anything of an older run is touched where that is possible.
file(READ ${WORK}/block/summary.json before)
run_without(cholmod ${beginning} "0.2 ms")
run_without(cholmod ${beginning} "0.2 ms" --resume)
file(READ ${WORK}/block/summary.json after)
if(NOT after STREQUAL before)
  message(FATAL_ERROR "without cholmod a run has been begun")
endif()
run_without(hdf5 ${beginning} "0.2 ms")
file(READ ${WORK}/block/summary.json said)
expect("\"steps\": 0,")
file(REMOVE_RECURSE ${WORK})
