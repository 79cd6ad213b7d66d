# Flags of every target of the project; nothing here reaches those who link against it.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Sanitized runs want assertions, not speed; optimising sanitized templates takes minutes.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
option(CONTINUO_LINE_NUMBERS "Line numbers in the reports of sanitizers; a fifth more time to build" ON)
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O0")
if(CONTINUO_LINE_NUMBERS)
  string(APPEND CMAKE_CXX_FLAGS_RELWITHDEBINFO " -g1")
endif()

# Where ccache is installed, what has been compiled once is not compiled again: after a change of branch, in a second
# checkout. Precompiled headers need its leave to trust them.
find_program(CONTINUO_CCACHE ccache)
if(CONTINUO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${CONTINUO_CCACHE})
endif()

add_library(continuo_flags INTERFACE)
target_compile_features(continuo_flags INTERFACE cxx_std_20)
target_compile_options(continuo_flags INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 sees an overlap or an overflow in every `"text" + std::string(...)` (gcc bugs 105651 and 105329).
  target_compile_options(continuo_flags INTERFACE -Wno-restrict -Wno-stringop-overflow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  if(CONTINUO_CCACHE)
    target_compile_options(continuo_flags INTERFACE -fpch-preprocess)
  endif()
  if(CMAKE_UNITY_BUILD)
    # What has a type of an unnamed namespace is unsafe in a header, and a joined source passes for one.
    target_compile_options(continuo_flags INTERFACE -Wno-subobject-linkage)
  endif()
  # g++ looks for memory to use again when it has taken 128 MB, for a tenth of its time; let it take more.
  target_compile_options(continuo_flags INTERFACE --param=ggc-min-heapsize=524288)
endif()
# Nobody reads errno or the exception flags after arithmetic; with them sqrt is a call and loops do not vectorize.
# No result changes.
target_compile_options(continuo_flags INTERFACE -fno-math-errno -fno-trapping-math)
if(CONTINUO_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # A precompiled header carries the time of its making, which would be another one each time.
  target_compile_options(continuo_flags INTERFACE "SHELL:-Xclang -fno-pch-timestamp")
endif()
if(NOT CONTINUO_SANITIZE)
  # The libraries are linked into the Python module, a shared one. Nobody replaces their functions when it is loaded.
  target_compile_options(continuo_flags INTERFACE -fPIC -fno-semantic-interposition)
endif()
if(CONTINUO_NATIVE)
  target_compile_options(continuo_flags INTERFACE -march=native)
endif()
# Where the processor may have fused operations, the compiler must not make one of a product and a sum: a step of a
# method gives the same bits as its machine code, which has none, and as that step in lanes.
if(CONTINUO_NATIVE OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(continuo_flags INTERFACE -ffp-contract=off)
endif()
if(CONTINUO_SANITIZE)
  # Left out of `undefined`: what the address sanitizer reports as a bad address anyway (null, object-size), and the
  # checks of every reference for its alignment and its class (alignment, vptr), which double the time of a build and
  # look for what only a reinterpret_cast can do wrong.
  target_compile_options(continuo_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize=null,object-size,alignment,vptr -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(continuo_flags INTERFACE -fsanitize=address,undefined)
endif()
