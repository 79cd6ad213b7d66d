// continuo/solve/with_method.hpp
// A method by name, where the program does not know it when compiled. Brings every method with it.
//
//   with_method("dop853", [&](auto method) { solution = solve(f, x0, {0, 1}, method, options); });
//
// `with_method<AllMethods>` also knows `taylor`: f is then compiled for Taylor series, whatever the name is.
#pragma once
#include <string_view>

#include <continuo/methods/all.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo {

/// Calls use(method) with the method of that name, of those listed. False where there is none.
template <class Methods = PlainMethods, class Use>
bool with_method(std::string_view name, Use&& use) {
  bool found = false;
  for_each_method<Methods>([&]<class M>() {
    if (M::name != canonical_name(name)) return;
    found = true;
    use(M{});
  });
  return found;
}

}  // namespace continuo
