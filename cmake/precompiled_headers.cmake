# The standard library and fmt are read once, not once a file: a third of the time of a small source.
# Off, every file must name what it uses; clang-tidy reads the sources so.
option(CONTINUO_PRECOMPILED_HEADERS "Precompile the headers of the standard library" ON)

set(continuo_standard_headers
    <algorithm> <array> <charconv> <chrono> <cmath> <cstddef> <cstdint> <filesystem> <fstream> <functional> <iomanip>
    <iostream> <limits> <map> <memory> <numbers> <numeric> <optional> <random> <set> <span> <sstream> <string>
    <string_view> <tuple> <type_traits> <unordered_map> <unordered_set> <utility> <variant> <vector>)

# continuo_precompile(NAME HEADER...): an empty library called NAME that owns the precompiled headers.
function(continuo_precompile name)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp.in "// Owns the precompiled headers.\n")
  configure_file(${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp COPYONLY)
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE continuo_flags)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# continuo_reuse_headers(TARGET NAME): TARGET is compiled with the headers that NAME owns.
function(continuo_reuse_headers target name)
  if(CONTINUO_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

if(CONTINUO_PRECOMPILED_HEADERS)
  continuo_precompile(continuo_headers ${continuo_standard_headers} <fmt/format.h>)
  target_link_libraries(continuo_headers PRIVATE fmt::fmt)
  if(CONTINUO_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)  # a module that is fuzzed has a flag of its own
    continuo_precompile(continuo_fuzzed_headers ${continuo_standard_headers} <fmt/format.h>)
    target_link_libraries(continuo_fuzzed_headers PRIVATE fmt::fmt)
    target_compile_options(continuo_fuzzed_headers PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endif()
