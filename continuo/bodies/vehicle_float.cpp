// Instantiates the drive of vehicles for single precision.
#include <continuo/bodies/queries/vehicle_members.hpp>

namespace continuo {

template Status drive(World<float, 2>&, const Queries<float, 2>&, Vehicle<float, 2>&, const VehicleControls<float>&,
                      const float&);
template Status drive(World<float, 3>&, const Queries<float, 3>&, Vehicle<float, 3>&, const VehicleControls<float>&,
                      const float&);
template void release(World<float, 2>&, Vehicle<float, 2>&);
template void release(World<float, 3>&, Vehicle<float, 3>&);

}  // namespace continuo
