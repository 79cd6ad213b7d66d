// Parts of the command in files of their own, opened when they are asked for: cmake/modules.cmake makes them, modules/
// says what is in them. modules.cpp has the functions of the library that are there; the linker takes these before it
// looks into the library, so that whoever calls them need not know.
#pragma once

namespace continuo::app {

inline constexpr const char* netcdf_module = "netcdf";
inline constexpr const char* least_squares_module = "least_squares";

/// Whether the part is there with all that it needs; says what is missing where not: told before a long run, not after.
bool loadable(const char* module);

}  // namespace continuo::app
