// The kernels for a width of registers that the caller chooses.
#pragma once
#include <cstddef>
#include <string>

#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// Those for registers of so many bytes, 0 for the widest. Fails for other numbers than 0, 16, 32 and 64, and where
/// this machine has no such registers or the library was compiled without them.
template <class Real, int Dim>
[[nodiscard]] Result<ManifoldKernels<Real, Dim>> chosen_kernels(int bytes) {
  const auto all = manifold_kernels<Real, Dim>();
  if (bytes == 0) return all.back();
  std::string widths;
  for (const auto& kernels : all) {
    const std::size_t width = kernels.lanes * sizeof(Real);
    if (static_cast<int>(width) == bytes) return kernels;
    widths += (widths.empty() ? "" : ", ") + std::to_string(width);
  }
  if (bytes != 16 && bytes != 32 && bytes != 64)
    return invalid_input("registers must be 16, 32 or 64 bytes, or 0 for the widest, not " + std::to_string(bytes));
  return invalid_input("registers of " + std::to_string(bytes) + " bytes cannot be used here, only those of " + widths +
                       "; 0 takes the widest");
}

}  // namespace continuo
