// Parts of the command in files of their own, opened when they are asked for: cmake/modules.cmake makes them, modules/
// says what is in them. The functions of the library that are there are defined in the command too, and call those of
// the module (modules.cpp, studies/least_squares_module.cpp); the linker takes these before it looks into the library,
// so that whoever calls them need not know.
#pragma once

namespace continuo::app {

inline constexpr const char* least_squares_module = "least_squares";

/// Whether the part is there with all that it needs; says what is missing where not: told before a long run, not after.
bool loadable(const char* module);

/// The address of the module's `continuo_module`. Throws where it cannot be loaded.
const void* content_of(const char* module);

/// What the module has, a pointer to a function.
template <class Function>
Function entry_of(const char* module) {
  return *static_cast<const Function*>(content_of(module));
}

}  // namespace continuo::app
