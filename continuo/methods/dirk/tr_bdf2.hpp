// continuo/methods/dirk/tr_bdf2.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// TR-BDF2: the trapezoidal rule to t + (2 - sqrt(2)) h, from there BDF2. L-stable, of order 2, with an embedded
/// solution of order 3. R. E. Bank and others, IEEE Trans. CAD 4 (1985) 436-451; M. E. Hosea, L. F. Shampine, "Analysis
/// and implementation of TR-BDF2", Appl. Numer. Math. 20 (1996) 21-37.
struct TrBdf2 : DiagonallyImplicitRungeKutta<TrBdf2> {
  static constexpr std::string_view name = "trbdf2";
  static constexpr int order = 2, error_order = 2, dense_degree = 3, dense_order = 2;

 private:
  static constexpr Coefficient root2 = 1.41421356237309504880168872420969807856967187537694807318_c;
  static constexpr Coefficient d = 1 - root2 / 2, w = root2 / 4;

 public:
  static constexpr DiagonalTableau<3, 3> tableau =
      DiagonalTableau<3, 3>{.gamma = d,
                            .c = {0, 2 * d, 1},
                            .a = {{}, {d, d}, {w, w, d}},
                            .b = {w, w, d},
                            .embedded = {(1 - w) / 3, (3 * w + 1) / 3, d / 3}}
          .with_hermite();
};

}  // namespace continuo
