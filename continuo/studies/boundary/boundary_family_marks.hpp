// The folds and crossings between two neighbouring places of a family of solutions. Internal to boundary_family.
#pragma once
#include <optional>

#include <continuo/studies/boundary/boundary_family.hpp>
#include <continuo/studies/boundary/boundary_family_steps.hpp>

namespace continuo::studies::detail {

/// Whether some measures of crossings have changed their signs and some have not, so that one of the two has leapt
/// through infinity. In shorter steps leaps and crossings part.
[[nodiscard]] bool is_ambiguous(const FamilyPlace& a, const FamilyPlace& b);

struct BetweenPlaces {
  FamilyEvent kind = FamilyEvent::fold;
  std::optional<FamilyPlace> place{};  // nothing where nothing happens, or
  bool doubtful = false;               // where it was not found
};
/// b is one step ahead of a, along a's tangent. Where the family crosses another one and turns round, it is a crossing.
[[nodiscard]] BetweenPlaces what_lies_between(FamilySteps& steps, const FamilyPlace& a, const FamilyPlace& b,
                                              double step);

}  // namespace continuo::studies::detail
