# Digests of the rooms that decide a number: every source in them.
#
# By itself it prints the digest, and under it the sources:
#   cmake -DROOT=<folder> -DOF=numerics|measurements -P cmake/source_digest.cmake

cmake_policy(VERSION 3.20)

# Where the numbers come from: "numerics" of a case, "measurements" of a finding.
function(sources_of out root of)
  set(rooms solver mms studies/models studies/cases studies/running)
  if(of STREQUAL "measurements")
    list(APPEND rooms reports/judging studies/reading studies/claims studies/kinds)
  elseif(NOT of STREQUAL "numerics")
    message(FATAL_ERROR "OF=${of}; it must be numerics or measurements")
  endif()
  set(patterns "")
  foreach(room IN LISTS rooms)
    list(APPEND patterns ${root}/${room}/*.hpp ${root}/${room}/*.cpp)
  endforeach()
  file(GLOB_RECURSE sources RELATIVE ${root} ${patterns})
  list(SORT sources)
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# 16 hexadecimal digits that change with the content, the names and the number of the sources, and these sources.
function(source_digest digest_out sources_out root of)
  sources_of(sources ${root} ${of})
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
