// continuo/bodies/solver_body.hpp
// A body as the fast motion holds it while it steps: what a contact touches side by side.
#pragma once
#include <cstdint>

#include <continuo/bodies/vector.hpp>

namespace continuo {

template <class Real, int Dim>
struct SolverBody {
  Vector<Real, Dim> x{}, v{};
  Spin<Real, Dim> spin{};
  Real radius{}, inverse_mass{}, inverse_inertia{};
  Vector<Real, Dim> acceleration{};
  Vector<Real, Dim> x_of_list{};  // where it was when the pairs were listed
  std::uint32_t impacts = 0;      // of this substep
  bool in_contact = false;        // in this substep
};

}  // namespace continuo
