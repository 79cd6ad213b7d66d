// Which kernels of manifolds of floats this machine can run.
#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>

namespace continuo {

template <class Real, int Dim>
std::vector<ManifoldKernels<Real, Dim>> manifold_kernels() {
  std::vector<ManifoldKernels<Real, Dim>> all{kernels_of_16_bytes<Real, Dim>()};
#ifdef CONTINUO_WIDE_REGISTERS
  if (__builtin_cpu_supports("avx2")) all.push_back(kernels_of_32_bytes<Real, Dim>());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    all.push_back(kernels_of_64_bytes<Real, Dim>());
#endif
  return all;
}

template std::vector<ManifoldKernels<float, 2>> manifold_kernels();
template std::vector<ManifoldKernels<float, 3>> manifold_kernels();

}  // namespace continuo
