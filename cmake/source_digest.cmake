# Digests of the sources that decide a number. They are found, not listed: whatever the entry points include, the .cpp file
# beside each header, and what that includes in turn.
#
# By itself it prints the digest, and under it the sources:
#   cmake -DROOT=<folder> -DOF=numerics|measurements -P cmake/source_digest.cmake

cmake_policy(VERSION 3.20)

# Where the numbers come from: "numerics" of a case, "measurements" of a finding.
function(entry_points out root of)
  # No header leads to what is compiled once per instruction set.
  set(entries studies/run_case.cpp solver/vector/sweeps_isa.cpp solver/far/far_sweeps_isa.cpp)
  if(of STREQUAL "measurements")
    file(GLOB measuring RELATIVE ${root} ${root}/studies/kinds/*.cpp ${root}/studies/claims/*.cpp)
    list(APPEND entries ${measuring})
  elseif(NOT of STREQUAL "numerics")
    message(FATAL_ERROR "OF=${of}; it must be numerics or measurements")
  endif()
  set(${out} ${entries} PARENT_SCOPE)
endfunction()

# Project sources that `entries` rest on, relative to `root` and sorted. Headers that CMake writes are not under `root`.
function(sources_behind out root)
  set(open ${ARGN})
  set(found "")
  while(open)
    list(POP_FRONT open source)
    if(source IN_LIST found)
      continue()
    endif()
    list(APPEND found ${source})
    file(STRINGS ${root}/${source} includes REGEX "^[ \t]*#[ \t]*include[ \t]*\"")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^[^\"]*\"([^\"]*)\".*" "\\1" header "${line}")
      string(REGEX REPLACE "\\.hpp$" ".cpp" implementation "${header}")
      foreach(file IN ITEMS ${header} ${implementation})
        if(EXISTS ${root}/${file})
          list(APPEND open ${file})
        endif()
      endforeach()
    endforeach()
  endwhile()
  list(SORT found)
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# 16 hexadecimal digits that change with the content, the names and the number of the sources, and these sources.
function(source_digest digest_out sources_out root of)
  entry_points(entries ${root} ${of})
  sources_behind(sources ${root} ${entries})
  set(digests "")
  foreach(source IN LISTS sources)
    file(SHA256 ${root}/${source} digest)
    string(APPEND digests "${source} ${digest}\n")
  endforeach()
  string(SHA256 digest "${digests}")
  string(SUBSTRING ${digest} 0 16 digest)
  set(${digest_out} ${digest} PARENT_SCOPE)
  set(${sources_out} ${sources} PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  source_digest(digest sources ${ROOT} ${OF})
  list(JOIN sources "\n" lines)
  execute_process(COMMAND ${CMAKE_COMMAND} -E echo "${digest}\n${lines}")  # message() would write to stderr
endif()
