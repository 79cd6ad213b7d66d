// Instantiates the snapshots of worlds in single precision.
#include <continuo/bodies/snapshots/snapshot_members.hpp>

namespace continuo {

template Bytes snapshot(const World<float, 2>&);
template Bytes snapshot(const World<float, 3>&);
template Bytes snapshot(const World<float, 2>&, const ExactMotion<float, 2>&);
template Bytes snapshot(const World<float, 3>&, const ExactMotion<float, 3>&);
template Bytes snapshot(const World<float, 2>&, const FastMotion<float, 2>&);
template Bytes snapshot(const World<float, 3>&, const FastMotion<float, 3>&);
template Status restore(std::span<const std::byte>, World<float, 2>&);
template Status restore(std::span<const std::byte>, World<float, 3>&);
template Status restore(std::span<const std::byte>, World<float, 2>&, ExactMotion<float, 2>&);
template Status restore(std::span<const std::byte>, World<float, 3>&, ExactMotion<float, 3>&);
template Status restore(std::span<const std::byte>, World<float, 2>&, FastMotion<float, 2>&);
template Status restore(std::span<const std::byte>, World<float, 3>&, FastMotion<float, 3>&);

}  // namespace continuo
