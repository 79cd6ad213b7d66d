// continuo/solve/catalogue.hpp
// The methods by name, as models and the command line speak of them.
//
//   with_method("dop853", [&](auto method) { solution = solve(f, x0, {0, 1}, method, options); });
#pragma once
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/methods/all.hpp>

namespace continuo {

/// What there is to say of a method before using it.
struct MethodInfo {
  std::string_view name;
  int order;
  int error_order;  // 0: no error estimate, needs a step
  int dense_order;
  bool second_order;  // only for x'' = a(t, x)
};

/// Other names of a method: `euler` for explicit_euler.
inline std::string_view canonical_name(std::string_view name) {
  return name == "euler" ? std::string_view("explicit_euler") : name;
}

/// Calls use(method) with the method of that name. False where there is none.
template <class Use>
bool with_method(std::string_view name, Use&& use) {
  bool found = false;
  for_each_method([&]<class M>() {
    if (M::name != canonical_name(name)) return;
    found = true;
    use(M{});
  });
  return found;
}

/// All methods, simplest first.
inline std::vector<MethodInfo> method_catalogue() {
  std::vector<MethodInfo> all;
  for_each_method(
      [&]<class M>() { all.push_back({M::name, M::order, M::error_order, M::dense_order, M::second_order}); });
  return all;
}

}  // namespace continuo
