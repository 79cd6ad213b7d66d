// Instantiates the runs of foreign systems by the diagonally implicit methods.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/multistep/bdf2.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<ImplicitEuler, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Trapezoidal, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<ImplicitMidpoint, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Bdf2, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<TrBdf2, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<KenCarp4, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Kvaerno5, ForeignSystem>();

}  // namespace continuo
