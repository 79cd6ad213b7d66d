// Contacts of bodies that joints connect: the joints answer every impulse of a contact at once, so that the contacts
// can be solved as if there were no joints.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/bodies/exact_rigid/constraint_equations.hpp>
#include <continuo/bodies/exact_rigid/motion_row.hpp>

namespace continuo {

/// With B the rows of joints and G those of contacts, and A_xy = J_x M^-1 J_y^T: the Schur complement
/// A_GG - A_GB A_BB^-1 A_BG.
template <class Real, int Dim>
class ReducedContacts {
 public:
  using Row = MotionRow<Real, Dim>;

  ReducedContacts(const ExactBody<Real, Dim>* bodies, std::span<const Row> joints, std::span<const Row> contacts)
      : joints_(joints.size()), contacts_(contacts.size()) {
    std::vector<Real> held(joints_ * joints_);
    for (std::size_t c = 0; c < joints_; ++c)
      for (std::size_t r = 0; r < joints_; ++r) held[c * joints_ + r] = response(joints[r], joints[c], bodies);
    of_joints_.factor(joints_, held);
    coupling_.resize(joints_ * contacts_), answer_.resize(joints_ * contacts_), matrix_.resize(contacts_ * contacts_);
    for (std::size_t c = 0; c < contacts_; ++c) {
      for (std::size_t r = 0; r < joints_; ++r) answer_[c * joints_ + r] = response(joints[r], contacts[c], bodies);
      for (std::size_t r = 0; r < joints_; ++r) coupling_[c * joints_ + r] = response(contacts[c], joints[r], bodies);
      of_joints_.solve(std::span(answer_).subspan(c * joints_, joints_));
    }
    for (std::size_t c = 0; c < contacts_; ++c)
      for (std::size_t r = 0; r < contacts_; ++r)
        matrix_[c * contacts_ + r] = response(contacts[r], contacts[c], bodies) - coupled(r, column(answer_, c));
  }

  /// Column by column.
  [[nodiscard]] std::span<const Real> matrix() const { return matrix_; }
  /// The rates of contacts once the joints have answered theirs, `of_joints`.
  [[nodiscard]] std::vector<Real> rates(std::vector<Real> of_joints, std::vector<Real> of_contacts) {
    of_joints_.solve(of_joints);
    for (std::size_t k = 0; k < contacts_; ++k) of_contacts[k] -= coupled(k, of_joints);
    return of_contacts;
  }
  /// The impulses of the joints with these rates and with these impulses of the contacts.
  [[nodiscard]] std::vector<Real> answers(std::vector<Real> rates_of_joints, std::span<const Real> impulses) {
    of_joints_.solve(rates_of_joints);
    for (Real& value : rates_of_joints) value = -value;
    for (std::size_t c = 0; c < contacts_; ++c)
      for (std::size_t r = 0; r < joints_; ++r) rates_of_joints[r] -= answer_[c * joints_ + r] * impulses[c];
    return rates_of_joints;
  }

 private:
  [[nodiscard]] std::span<const Real> column(const std::vector<Real>& of, std::size_t c) const {
    return std::span(of).subspan(c * joints_, joints_);
  }
  [[nodiscard]] Real coupled(std::size_t contact, std::span<const Real> with) const {
    Real sum(0);
    for (std::size_t r = 0; r < joints_; ++r) sum += coupling_[contact * joints_ + r] * with[r];
    return sum;
  }

  std::size_t joints_, contacts_;
  ConstraintEquations<Real> of_joints_;
  std::vector<Real> coupling_, answer_, matrix_;
};

}  // namespace continuo
