// Instantiates the runs of foreign systems by the multistep, stabilized and implicit extrapolation methods.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/explicit_rk/rkc2.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Adams, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Bdf, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rkc2, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Seulex, ForeignSystem>();

}  // namespace continuo
