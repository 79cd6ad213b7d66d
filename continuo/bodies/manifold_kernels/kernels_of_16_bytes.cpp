// The kernels of manifolds and of point joints for registers of 16 bytes, of doubles.
#include <continuo/bodies/manifold_kernels/manifold_kernel.hpp>
#include <continuo/bodies/manifold_kernels/motion_kernel.hpp>
#include <continuo/bodies/manifold_kernels/point_joint_kernel.hpp>

namespace continuo {

template <class Real, int Dim>
ManifoldKernels<Real, Dim> kernels_of_16_bytes() {
  using L = xsimd::make_sized_batch_t<Real, 16 / sizeof(Real)>;
  return {L::size, &solve_manifolds<L, Dim>, &solve_point_joints<L, Dim>, &move_bodies<L, Dim>};
}

template ManifoldKernels<double, 2> kernels_of_16_bytes();
template ManifoldKernels<double, 3> kernels_of_16_bytes();

}  // namespace continuo
