// Instantiates the runs of foreign systems whose mass is a full matrix.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>

namespace continuo {

template AnyMethod<ForeignSystemWithMatrix, std::vector<double>> foreign_method<Radau5, ForeignSystemWithMatrix>();
template AnyMethod<ForeignSystemWithMatrix, std::vector<double>> foreign_method<Radau, ForeignSystemWithMatrix>();
template AnyMethod<ForeignSystemWithMatrix, std::vector<double>> foreign_method<Bdf, ForeignSystemWithMatrix>();
template AnyMethod<ForeignSystemWithMatrix, std::vector<double>> foreign_method<Rodas5P, ForeignSystemWithMatrix>();

}  // namespace continuo
