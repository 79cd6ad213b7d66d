// Instantiates the drive of vehicles for double precision.
#include <continuo/bodies/queries/vehicle_members.hpp>

namespace continuo {

template Status drive(World<double, 2>&, const Queries<double, 2>&, Vehicle<double, 2>&, const VehicleControls<double>&,
                      const double&);
template Status drive(World<double, 3>&, const Queries<double, 3>&, Vehicle<double, 3>&, const VehicleControls<double>&,
                      const double&);
template void release(World<double, 2>&, Vehicle<double, 2>&);
template void release(World<double, 3>&, Vehicle<double, 3>&);

}  // namespace continuo
