# Parts of the command in shared libraries of their own, opened when they are asked for: what they stand on would take
# longer to load than all else that a short run does. The library has the same code for those who link against them.

# continuo_module(NAME PROGRAMS OBJECTS PART...): continuo_NAME.so beside the PROGRAMS that load it, of modules/NAME.cpp
# and of OBJECTS, a source that its library has as LOADED, with what this stands on. Installed into a folder of the
# libraries, to which the command knows the way from its own, so that all can be moved together.
function(continuo_module name programs objects)
  set(module continuo_module_${name})
  add_library(${module} MODULE modules/${name}.cpp $<TARGET_OBJECTS:${objects}>)
  target_include_directories(${module} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${module} PRIVATE continuo_flags ${ARGN})
  # The programs have functions of the same names: those that open the module.
  target_link_options(${module} PRIVATE LINKER:--as-needed LINKER:-Bsymbolic)
  set_target_properties(${module} PROPERTIES OUTPUT_NAME continuo_${name} PREFIX "" UNITY_BUILD OFF
                                             LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  foreach(program IN LISTS programs)
    add_dependencies(${program} ${module})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY CONTINUO_MODULE_TARGETS ${module})
endfunction()
