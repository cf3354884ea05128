# Compiler settings that every target of Concord shares, as the interface target concord_settings,
# and the third-party packages that more than one room uses.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

add_library(concord_settings INTERFACE)
target_compile_options(concord_settings INTERFACE -Wall -Wextra -Wno-psabi -fno-math-errno)
if(CONCORD_WERROR)
  target_compile_options(concord_settings INTERFACE -Werror)
endif()
if(CONCORD_SANITIZE)
  # target_clones needs ifunc resolvers, which run before the sanitizers are ready: kernels are compiled once instead.
  target_compile_options(concord_settings INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_compile_definitions(concord_settings INTERFACE CONCORD_NO_CLONES _GLIBCXX_ASSERTIONS)
  target_link_options(concord_settings INTERFACE -fsanitize=address,undefined)
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(PkgConfig REQUIRED)
# The HDF5 that deal.II links: two HDF5 libraries in one process do not mix.
pkg_check_modules(HDF5_MPI REQUIRED IMPORTED_TARGET hdf5-openmpi)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)

# concord_room(NAME sources...): a library target of one room, alias concord::NAME.
# Headers are included by their path from the top: #include "scene/problem.hpp".
function(concord_room name kind)
  add_library(concord_${name} ${kind} ${ARGN})
  add_library(concord::${name} ALIAS concord_${name})
  set_target_properties(concord_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(concord_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/concord>)
  target_link_libraries(concord_${name} PRIVATE $<BUILD_INTERFACE:concord_settings>)
  target_compile_features(concord_${name} PUBLIC cxx_std_20)
endfunction()

# concord_unity(TARGET [BATCH]): BATCH sources (4) of the target in one compilation where CONCORD_UNITY is on. Most of
# compiling here is the same headers and templates again for every file. Not for kernels: what is inlined where could
# change their bits.
function(concord_unity target)
  set(batch 4)
  if(ARGC GREATER 1)
    set(batch ${ARGV1})
  endif()
  if(CONCORD_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()
