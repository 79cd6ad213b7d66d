// The kernels of manifolds and of point joints for registers of 32 bytes, of floats; nothing where the compiler may not
// use them.
#ifdef __AVX2__
#include <continuo/bodies/manifold_kernels/manifold_kernel.hpp>
#include <continuo/bodies/manifold_kernels/motion_kernel.hpp>
#include <continuo/bodies/manifold_kernels/point_joint_kernel.hpp>

namespace continuo {

template <class Real, int Dim>
ManifoldKernels<Real, Dim> kernels_of_32_bytes() {
  using L = xsimd::batch<Real, xsimd::avx2>;
  return {L::size, &solve_manifolds<L, Dim>, &solve_point_joints<L, Dim>, &move_bodies<L, Dim>};
}

template ManifoldKernels<float, 2> kernels_of_32_bytes();
template ManifoldKernels<float, 3> kernels_of_32_bytes();

}  // namespace continuo
#endif
