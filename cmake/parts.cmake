# The parts we take from the distribution; docs/dependencies.md says why each. Installed with the library:
# find_package(Continuo) reads this file too.
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(Ceres REQUIRED)
find_package(xsimd REQUIRED)
find_package(TBB REQUIRED)
if(NOT TARGET xtl)
  # The distribution's xsimd names xtl (for complex numbers, which we do not use) without requiring it.
  add_library(xtl INTERFACE IMPORTED)
endif()

# continuo_part(NAME HEADER [FILE]): a library that brings no description of itself; FILE is looked for first.
macro(continuo_part name header)
  if(NOT TARGET ${name})
    find_library(CONTINUO_LIBRARY_${name} NAMES ${ARGN} ${name} REQUIRED)
    find_path(CONTINUO_HEADERS_${name} ${header} REQUIRED)
    add_library(${name} INTERFACE IMPORTED)
    target_link_libraries(${name} INTERFACE ${CONTINUO_LIBRARY_${name}})
    target_include_directories(${name} INTERFACE ${CONTINUO_HEADERS_${name}})
  endif()
endmacro()
continuo_part(udunits2 udunits2.h)
continuo_part(klu suitesparse/klu.h)
continuo_part(netcdf netcdf.h)
continuo_part(z zlib.h libz.a)  # the static one, where there is one: no call of the command has to load it

find_package(Threads REQUIRED)
if(NOT TARGET boost_headers)
  find_path(BOOST_INCLUDE_DIR boost/beast.hpp REQUIRED)  # Beast and Asio are all headers
  add_library(boost_headers INTERFACE IMPORTED)
  target_include_directories(boost_headers INTERFACE ${BOOST_INCLUDE_DIR})
  target_compile_definitions(boost_headers INTERFACE BOOST_ERROR_CODE_HEADER_ONLY BOOST_ASIO_NO_DEPRECATED)
endif()
