// continuo/solve/catalogue.cpp
// The list of methods with their properties, and the search in it by name and alias.
#include <algorithm>

#include <continuo/methods/all.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo {

std::string_view canonical_name(std::string_view name) {
  if (name == "euler") return "explicit_euler";
  if (name == "crank_nicolson") return "trapezoidal";
  return name;
}

const std::vector<MethodInfo>& method_catalogue() {
  static const std::vector<MethodInfo> all = [] {
    std::vector<MethodInfo> list;
    for_each_method([&]<class M>() {
      constexpr bool needs_series = requires { M::needs_series; };
      list.push_back({M::name, M::order, detail::order_of_fixed_steps<M>(), M::error_order, M::dense_order,
                      M::second_order, detail::is_implicit<M>(), detail::is_automatic<M>(), needs_series});
    });
    return list;
  }();
  return all;
}

const MethodInfo* find_method(std::string_view name) {
  const auto found = std::ranges::find(method_catalogue(), canonical_name(name), &MethodInfo::name);
  return found == method_catalogue().end() ? nullptr : &*found;
}

}  // namespace continuo
