// Sources of events that `check_event_source` must refuse. This file does not compile: the test compares the errors of
// the compiler with the comments `refused:`, one for each error (refusals.sh).
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <continuo/solve/check_event_source.hpp>

namespace continuo::refusals {

using X = std::array<double, 2>;
struct Flow {
  void operator()(double, const X&, X&);
};

struct Right {
  std::size_t size() const;
  std::string_view name(std::size_t) const;
  Direction direction(std::size_t) const;
  bool is_guard(std::size_t) const;
  bool active(const Flow&, std::size_t) const;
  double next_time(std::size_t, double, bool) const;
  void guards(Flow&, double, const X&, std::span<double>);
  EventResponse fire(Flow&, std::size_t, double, const X&, X&);
};
static_assert(check_event_source<Right, Flow, X>());
static_assert(check_event_source<EventList<X>, Flow, X>());
template <class S>
inline constexpr bool checked = check_event_source<S, Flow, X>();

// ---- members that are missing or nearly right

struct CannotBeCopied : Right {
  std::unique_ptr<int> data;
};
// refused: the source of events must be copyable
template bool const checked<CannotBeCopied>;

struct SizeChangesSource : Right {
  std::size_t size();
};
// refused: the source of events lacks a public member: std::size_t size() const
template bool const checked<SizeChangesSource>;

struct PrivateName : Right {
 private:
  std::string_view name(std::size_t) const;
};
// refused: the source of events lacks a public member: std::string_view name(std::size_t i) const
template bool const checked<PrivateName>;

struct DirectionIsANumber : Right {
  int direction(std::size_t) const;
};
// refused: the source of events lacks a public member: Direction direction(std::size_t i) const
template bool const checked<DirectionIsANumber>;

struct IsGuardOfNone : Right {
  bool is_guard() const;
};
// refused: the source of events lacks a public member: bool is_guard(std::size_t i) const
template bool const checked<IsGuardOfNone>;

struct ActiveWithoutSystem : Right {
  bool active(std::size_t) const;
};
// refused: the source of events lacks a public member: bool active(const System& system, std::size_t i) const
template bool const checked<ActiveWithoutSystem>;

struct NextTimeIsOptional : Right {
  std::optional<double> next_time(std::size_t, double, bool) const;
};
// refused: the source of events lacks a public member, which returns infinity if there is no time
template bool const checked<NextTimeIsOptional>;

struct GuardsInAnArray : Right {
  void guards(Flow&, double, const X&, std::array<double, 1>&);
};
// refused: the source of events lacks a public member: void guards(
template bool const checked<GuardsInAnArray>;

struct FireWithoutResponse : Right {
  void fire(Flow&, std::size_t, double, const X&, X&);
};
// refused: the source of events lacks a public member: EventResponse fire(
template bool const checked<FireWithoutResponse>;

struct FireCopiesState : Right {
  EventResponse fire(Flow&, std::size_t, double, const X&, X);
};
// refused: `fire` gets x by value, so that its changes of the state are lost: declare X& x
template bool const checked<FireCopiesState>;

// ---- optional members that would be ignored

struct CanRestartChangesSource : Right {
  bool can_restart(std::size_t);
};
// refused: the member `can_restart` of the source of events would be ignored
template bool const checked<CanRestartChangesSource>;

struct CanAssignOfNone : Right {
  bool can_assign() const;
};
// refused: the member `can_assign` of the source of events would be ignored
template bool const checked<CanAssignOfNone>;

struct PrivateIsCondition : Right {
 private:
  bool is_condition(std::size_t) const;
};
// refused: the member `is_condition` of the source of events would be ignored
template bool const checked<PrivateIsCondition>;

struct RenewsGuardIsAText : Right {
  std::string renews_guard(std::size_t) const;
};
// refused: the member `renews_guard` of the source of events would be ignored
template bool const checked<RenewsGuardIsAText>;

struct PrivateWatchedBy : Right {
 private:
  bool watched_by(const Flow&) const;
};
// refused: the member `watched_by` of the source of events would be ignored
template bool const checked<PrivateWatchedBy>;

struct LimitWithoutAction : Right {
  bool has_limit_action(std::size_t) const;
};
// refused: the action at a limit would be ignored: it has two public members
template bool const checked<LimitWithoutAction>;

struct ActionWithoutLimit : Right {
  EventResponse at_limit(Flow&, std::size_t, double, const X&, X&);
};
// refused: the action at a limit would be ignored: it has two public members
template bool const checked<ActionWithoutLimit>;

struct CarriedIsASide : Right {
  std::string carried(const Flow&, std::size_t, double, const X&, double);
};
// refused: the member `carried` of the source of events would be ignored
template bool const checked<CarriedIsASide>;

struct OneEnclosureOfSix : Right {
  bool is_enclosed(std::size_t) const;
};
// refused: the enclosures of guards would be ignored: they have six public members
template bool const checked<OneEnclosureOfSix>;

struct ProblemOfNone : Right {
  std::string problem() const;
};
// refused: the member `problem` of the source of events would be ignored
template bool const checked<ProblemOfNone>;

struct FinalSource final : Right {};
// refused: the source of events is final: remove `final`, so that its optional members can be checked
template bool const checked<FinalSource>;

}  // namespace continuo::refusals
