// Instantiates the runs of foreign systems by the methods that switch.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/automatic.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Tsitouras5Rodas5P, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Dop853Radau, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Tsitouras5Bdf, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrinceNystrom8Radau, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrinceNystrom12Radau, ForeignSystem>();

}  // namespace continuo
