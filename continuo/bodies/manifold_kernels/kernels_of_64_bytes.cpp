// The kernels of manifolds and of point joints for registers of 64 bytes, of doubles; nothing where the compiler may
// not use them.
#ifdef __AVX512DQ__
#include <continuo/bodies/manifold_kernels/manifold_kernel.hpp>
#include <continuo/bodies/manifold_kernels/motion_kernel.hpp>
#include <continuo/bodies/manifold_kernels/point_joint_kernel.hpp>

namespace continuo {

template <class Real, int Dim>
ManifoldKernels<Real, Dim> kernels_of_64_bytes() {
  using L = xsimd::batch<Real, xsimd::avx512dq>;
  return {L::size, &solve_manifolds<L, Dim>, &solve_point_joints<L, Dim>, &move_bodies<L, Dim>};
}

template ManifoldKernels<double, 2> kernels_of_64_bytes();
template ManifoldKernels<double, 3> kernels_of_64_bytes();

}  // namespace continuo
#endif
