// Instantiates the runs of foreign systems by the collocation and Rosenbrock methods.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rosenbrock23, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rodas4, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rodas5P, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Gauss4, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Radau5, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Radau, ForeignSystem>();

}  // namespace continuo
