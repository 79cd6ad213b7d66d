// Instantiates the runs of foreign systems by the methods for x'' = a(t, x).
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/structural/generalized_alpha.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<McLachlanAtela4, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Yoshida6, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<KahanLi8, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrinceNystrom6, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrinceNystrom8, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<DormandPrinceNystrom12, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Newmark, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<GeneralizedAlpha, ForeignSystem>();

}  // namespace continuo
