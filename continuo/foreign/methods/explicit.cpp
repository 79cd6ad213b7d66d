// Instantiates the runs of foreign systems by the simple explicit methods.
#include <vector>

#include <continuo/foreign/methods/foreign_method_body.hpp>
#include <continuo/methods/explicit_rk/explicit_euler.hpp>
#include <continuo/methods/explicit_rk/heun.hpp>
#include <continuo/methods/explicit_rk/midpoint.hpp>
#include <continuo/methods/explicit_rk/rk38.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/structural/central_difference.hpp>
#include <continuo/methods/symplectic/semi_implicit_euler.hpp>
#include <continuo/methods/symplectic/symplectic_euler_position_first.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>

namespace continuo {

template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<ExplicitEuler, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<SemiImplicitEuler, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<SymplecticEulerPositionFirst, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<CentralDifference, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<VelocityVerlet, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Midpoint, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Heun, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rk4, ForeignSystem>();
template AnyMethod<ForeignSystem, std::vector<double>> foreign_method<Rk38, ForeignSystem>();

}  // namespace continuo
