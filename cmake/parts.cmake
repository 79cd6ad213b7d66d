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

if(NOT TARGET udunits2)
  find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
  find_path(UDUNITS2_INCLUDE_DIR udunits2.h REQUIRED)
  add_library(udunits2 INTERFACE IMPORTED)
  target_link_libraries(udunits2 INTERFACE ${UDUNITS2_LIBRARY})
  target_include_directories(udunits2 INTERFACE ${UDUNITS2_INCLUDE_DIR})
endif()

find_package(Threads REQUIRED)
if(NOT TARGET boost_headers)
  find_path(BOOST_INCLUDE_DIR boost/beast.hpp REQUIRED)  # Beast and Asio are all headers
  add_library(boost_headers INTERFACE IMPORTED)
  target_include_directories(boost_headers INTERFACE ${BOOST_INCLUDE_DIR})
  target_compile_definitions(boost_headers INTERFACE BOOST_ERROR_CODE_HEADER_ONLY BOOST_ASIO_NO_DEPRECATED)
endif()

if(NOT TARGET klu)
  find_library(KLU_LIBRARY klu REQUIRED)
  find_path(KLU_INCLUDE_DIR suitesparse/klu.h REQUIRED)
  add_library(klu INTERFACE IMPORTED)
  target_link_libraries(klu INTERFACE ${KLU_LIBRARY})
  target_include_directories(klu INTERFACE ${KLU_INCLUDE_DIR})
endif()

if(NOT TARGET netcdf)
  find_library(NETCDF_LIBRARY netcdf REQUIRED)
  find_path(NETCDF_INCLUDE_DIR netcdf.h REQUIRED)
  add_library(netcdf INTERFACE IMPORTED)
  target_link_libraries(netcdf INTERFACE ${NETCDF_LIBRARY})
  target_include_directories(netcdf INTERFACE ${NETCDF_INCLUDE_DIR})
endif()
