# libcontinuo.so: the functions of continuo.h, for C and for all that can call C. Nothing else of it can be seen.
add_library(continuo_c SHARED $<TARGET_OBJECTS:continuo_c_interface>)
set(symbols ${PROJECT_SOURCE_DIR}/continuo/c_interface/symbols.map)
target_link_libraries(continuo_c PRIVATE continuo_c_interface)
target_link_options(continuo_c PRIVATE LINKER:--as-needed LINKER:-Bsymbolic LINKER:--version-script=${symbols})
set_target_properties(continuo_c PROPERTIES OUTPUT_NAME continuo CONTINUO_WITHOUT_APART ON
                                            LINKER_LANGUAGE CXX LINK_DEPENDS ${symbols}
                                            VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION}
                                            LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
