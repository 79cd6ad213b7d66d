// Instantiates the snapshots of worlds in double precision.
#include <continuo/bodies/snapshots/snapshot_members.hpp>

namespace continuo {

template Bytes snapshot(const World<double, 2>&);
template Bytes snapshot(const World<double, 3>&);
template Bytes snapshot(const World<double, 2>&, const ExactMotion<double, 2>&);
template Bytes snapshot(const World<double, 3>&, const ExactMotion<double, 3>&);
template Bytes snapshot(const World<double, 2>&, const FastMotion<double, 2>&);
template Bytes snapshot(const World<double, 3>&, const FastMotion<double, 3>&);
template Status restore(std::span<const std::byte>, World<double, 2>&);
template Status restore(std::span<const std::byte>, World<double, 3>&);
template Status restore(std::span<const std::byte>, World<double, 2>&, ExactMotion<double, 2>&);
template Status restore(std::span<const std::byte>, World<double, 3>&, ExactMotion<double, 3>&);
template Status restore(std::span<const std::byte>, World<double, 2>&, FastMotion<double, 2>&);
template Status restore(std::span<const std::byte>, World<double, 3>&, FastMotion<double, 3>&);

}  // namespace continuo
