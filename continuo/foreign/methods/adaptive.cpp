// Instantiates the runs of foreign systems by the explicit methods with error control.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/methods/extrapolation/odex.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<BogackiShampine3, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrince5, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Tsitouras5, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Dop853, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Verner7, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Verner9, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Odex, ForeignSystem>();

}  // namespace continuo
