# cmake --install: headers, libraries and the package that find_package(Continuo) reads. Continuo::Continuo is all of
# it, Continuo::solve and its like are single modules with what they stand on: components, each with the parts of the
# distribution that it needs.
get_property(modules GLOBAL PROPERTY CONTINUO_MODULES)
add_library(continuo_all INTERFACE)
set_target_properties(continuo_all PROPERTIES EXPORT_NAME Continuo)
add_library(Continuo::Continuo ALIAS continuo_all)
foreach(module IN LISTS modules)
  target_link_libraries(continuo_all INTERFACE continuo_${module})
endforeach()
if(NOT PROJECT_IS_TOP_LEVEL)
  return()  # a project that contains Continuo installs itself
endif()

include(CMakePackageConfigHelpers)
list(TRANSFORM modules PREPEND continuo_ OUTPUT_VARIABLE libraries)
install(TARGETS ${libraries} continuo_all EXPORT ContinuoTargets)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Continuo)
install(CODE "set(sources \"${PROJECT_SOURCE_DIR}\")")
install(CODE "set(includes \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")")
install(SCRIPT cmake/public_headers.cmake)
install(EXPORT ContinuoTargets NAMESPACE Continuo:: DESTINATION ${package_folder})
install(FILES cmake/parts.cmake cmake/components.cmake DESTINATION ${package_folder})
write_basic_package_version_file(ContinuoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
set(config "set(continuo_components ${modules})\n")
foreach(module IN LISTS modules)
  foreach(list IN ITEMS uses parts optional_parts)
    string(TOUPPER ${list} property)
    get_property(names GLOBAL PROPERTY CONTINUO_${property}_${module})
    string(APPEND config "set(continuo_${list}_${module} ${names})\n")
  endforeach()
endforeach()
string(APPEND config "include(\${CMAKE_CURRENT_LIST_DIR}/components.cmake)\n")
file(CONFIGURE OUTPUT ContinuoConfig.cmake CONTENT "${config}" @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ContinuoConfig.cmake ${PROJECT_BINARY_DIR}/ContinuoConfigVersion.cmake
        DESTINATION ${package_folder})

if(TARGET continuo)
  get_property(loaded GLOBAL PROPERTY CONTINUO_MODULE_TARGETS)
  install(TARGETS continuo)
  install(TARGETS continuo-studies ${loaded} RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/continuo
                                             LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/continuo)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/manual/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(DIRECTORY apps/continuo/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/continuo)
  set(completions apps/continuo/completions)
  install(FILES ${completions}/continuo.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME continuo)
  install(FILES ${completions}/_continuo DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${completions}/continuo.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/continuo OPTIONAL)
