# Many small files that read the same headers: compiled a dozen at once they take a third of the time (CMake joins them,
# CMAKE_UNITY_BUILD). continuo.sh and test.sh build so. One by one is better where one file changes at a time, and is how
# a file proves that it includes what it uses.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)

# continuo_library(NAME [FUZZED] [USES ...] [PARTS ...] [INNER_PARTS ...] [OPTIONAL_PARTS ...] [FOLDERS ...] [BRIEF ...]
#                  [ALONE ...] [LOADED ...] [APART ...] [APART_USES ...] [COMMON ...]):
# the library of a module, which is a folder of continuo/; static when it has sources. The target is continuo_NAME,
# Continuo::NAME to those who find the package.
#   FUZZED   it reads what others wrote, and counts its branches for the fuzzer where the sanitizers are on.
#   USES     modules below it; those that they use come with them.
#   PARTS    of the distribution (parts.cmake) that whoever uses the module needs too. INNER_PARTS: headers that only its
#            sources read. OPTIONAL_PARTS: libraries that a program needs only where it uses a part of the module.
#   FOLDERS  of the module, lowest first: each may use those before it (tests/architecture holds it to that). What lies in
#            them is the module's own; its public headers lie in the module itself.
#   BRIEF    its sources (without .cpp, as patterns, wherever they lie) that run for milliseconds: compiled in half the
#            time, with -O1.
#   ALONE    those that compute, or are large: never joined, so that what is inlined in them depends on themselves alone.
#   LOADED   those that the command loads when they are asked for (modules.cmake): alone, and fit for a shared library.
#   APART    those that the command does not use: a library of their own, NAME_apart, which everybody else links with the
#            module's, so that the command is built without them. A module that needs them has NAME_apart among its USES.
#            APART_USES: modules that these alone use.
#   COMMON   headers that most of its sources read: precompiled, as those of the standard library.
function(continuo_library name)
  cmake_parse_arguments(module "FUZZED" "" "USES;PARTS;INNER_PARTS;OPTIONAL_PARTS;FOLDERS;BRIEF;ALONE;LOADED;APART;APART_USES;COMMON"
                        ${ARGN})
  set(folders ${PROJECT_SOURCE_DIR}/continuo/${name})
  foreach(folder IN LISTS module_FOLDERS)
    list(APPEND folders ${PROJECT_SOURCE_DIR}/continuo/${name}/${folder})
  endforeach()
  continuo_sources(sources "${folders}" *)
  set_property(GLOBAL PROPERTY CONTINUO_USES_${name} ${module_USES})
  set_property(GLOBAL PROPERTY CONTINUO_PARTS_${name} ${module_PARTS})
  set_property(GLOBAL PROPERTY CONTINUO_OPTIONAL_PARTS_${name} ${module_OPTIONAL_PARTS})
  foreach(part IN LISTS module_PARTS module_INNER_PARTS module_OPTIONAL_PARTS)
    continuo_find_part(${part} missing)
    if(missing)
      message(SEND_ERROR "continuo_${name} needs the package ${missing}")
    endif()
  endforeach()
  list(TRANSFORM module_USES PREPEND continuo_)
  if(sources)
    continuo_sources(brief "${folders}" ${module_BRIEF})
    continuo_sources(alone "${folders}" ${module_ALONE})
    continuo_sources(loaded "${folders}" ${module_LOADED})
    continuo_sources(apart "${folders}" ${module_APART})
    list(REMOVE_ITEM sources ${brief} ${loaded} ${apart})
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    add_library(continuo_${name} STATIC ${sources})
    set(scope PUBLIC)
    continuo_library_flags(continuo_${name})
    if(brief)
      continuo_library_objects(continuo_${name}_brief ${brief})
      if(NOT CONTINUO_SANITIZE)
        target_compile_options(continuo_${name}_brief PRIVATE -O1)
      endif()
    endif()
    foreach(source IN LISTS loaded)
      cmake_path(GET source STEM stem)
      continuo_library_objects(continuo_${name}_${stem} ${source})
      # Other code than what the precompiled headers were made for.
      set_target_properties(continuo_${name}_${stem} PROPERTIES POSITION_INDEPENDENT_CODE ON
                                                                DISABLE_PRECOMPILE_HEADERS ON)
    endforeach()
  else()
    add_library(continuo_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_compile_features(continuo_${name} ${scope} cxx_std_20)
  target_include_directories(continuo_${name} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                       $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(continuo_${name} ${scope} ${module_USES} ${module_PARTS} ${module_OPTIONAL_PARTS})
  set_target_properties(continuo_${name} PROPERTIES EXPORT_NAME ${name} CONTINUO_WITHOUT_APART ON)
  if(apart)
    add_library(continuo_${name}_apart STATIC ${apart})
    continuo_library_flags(continuo_${name}_apart)
    list(TRANSFORM module_APART_USES PREPEND continuo_ OUTPUT_VARIABLE apart_uses)
    target_link_libraries(continuo_${name}_apart PUBLIC continuo_${name} ${apart_uses})
    set_target_properties(continuo_${name}_apart PROPERTIES EXPORT_NAME ${name}_apart CONTINUO_WITHOUT_APART ON)
    set(is_wanted $<NOT:$<BOOL:$<TARGET_PROPERTY:CONTINUO_WITHOUT_APART>>>)  # by the target that links the module
    target_link_libraries(continuo_${name} INTERFACE $<${is_wanted}:$<TARGET_NAME:continuo_${name}_apart>>)
    set_property(GLOBAL APPEND PROPERTY CONTINUO_MODULES ${name}_apart)
    set_property(GLOBAL PROPERTY CONTINUO_USES_${name}_apart ${name} ${module_APART_USES})
  endif()
  if(module_INNER_PARTS)
    foreach(library IN ITEMS continuo_${name} continuo_${name}_apart)
      if(TARGET ${library})
        target_link_libraries(${library} PRIVATE $<BUILD_INTERFACE:${module_INNER_PARTS}>)
      endif()
    endforeach()
  endif()
  add_library(Continuo::${name} ALIAS continuo_${name})
  set_property(GLOBAL APPEND PROPERTY CONTINUO_MODULES ${name})
endfunction()

# The sources of folders that match any of the patterns.
function(continuo_sources result folders)
  set(found "")
  foreach(folder IN LISTS folders)
    if(ARGN)
      list(TRANSFORM ARGN REPLACE "(.+)" "${folder}/\\1.cpp" OUTPUT_VARIABLE paths)
      file(GLOB some CONFIGURE_DEPENDS ${paths})
      list(APPEND found ${some})
    endif()
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

# Sources of the module that are compiled in their own way. With the arguments of continuo_library that it is called from.
macro(continuo_library_objects target)
  add_library(${target} OBJECT ${ARGN})
  continuo_library_flags(${target})
  set_target_properties(${target} PROPERTIES CONTINUO_WITHOUT_APART ON)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${module_USES} ${module_PARTS})
  target_sources(continuo_${name} PRIVATE $<TARGET_OBJECTS:${target}>)
endmacro()

# With the arguments of continuo_library that it is called from.
macro(continuo_library_flags target)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:continuo_flags>)
  set(headers continuo_headers)
  if(module_FUZZED AND CONTINUO_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    set(headers continuo_fuzzed_headers)
  endif()
  if(module_COMMON AND CONTINUO_PRECOMPILED_HEADERS AND NOT CONTINUO_SANITIZE AND NOT "${target}" MATCHES "_brief$")
    if("${target}" STREQUAL "continuo_${name}")
      target_precompile_headers(${target} PRIVATE ${continuo_standard_headers} ${module_COMMON})
    else()
      continuo_reuse_headers(${target} continuo_${name})
    endif()
  elseif(fmt::fmt IN_LIST module_PARTS)  # as the precompiled headers have
    continuo_reuse_headers(${target} ${headers})
  endif()
endmacro()
