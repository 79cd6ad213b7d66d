// Lets the driver pass the steps that it is given, and looks at what it would write to a checkpoint.
#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/simulation/together/seen_run.hpp>

namespace continuo::model {

namespace {

using X = ModelSystem::X;
using Logic = EventLogic<ModelSystem, X, ModelEvents>;

/// Goes through the state of a driver in the way of a checkpoint. Finds whether guards are at zero, and what the steps
/// do not have.
class Look {
 public:
  static constexpr bool reads = false;

  void bind(const ModelSystem&) {}
  template <class... Parts>
  void operator()(Parts&... parts) {
    (look(parts), ...);
  }
  template <class Value>
  void optional(Value&) {}
  void operator()(const bool&, const double&, const double& value) { constants_.push_back({0, value}); }
  /// First the number of the constants, then of each one its component.
  void index(const std::size_t& value, std::size_t) {
    if (!constants_.empty()) constants_.back().component = value;
  }
  [[nodiscard]] bool is_at_zero() const { return is_at_zero_; }
  [[nodiscard]] std::vector<SeenRun::Constant> take_constants() { return std::move(constants_); }

 private:
  template <class Part>
  void look(Part& part) {
    if constexpr (std::is_same_v<Part, Logic>) {
      part.transfer(*this);
    } else if constexpr (std::is_same_v<Part, GuardState<double>>) {
      is_at_zero_ = is_at_zero_ || (part.active && (part.side == 0 || part.at_zero));
    }
  }

  bool is_at_zero_ = false;
  std::vector<SeenRun::Constant> constants_;
};

/// Sets what a checkpoint at the end of steps in which nothing has happened has besides the steps: the place, and the
/// guards there.
class MovedOn {
 public:
  static constexpr bool reads = false;

  MovedOn(double t, const X& x) : t_(t), x_(x) {}

  void bind(ModelSystem& system) { system_ = &system; }
  template <class... Rest>
  void operator()(double& t, X& x, Rest&... rest) {
    t = t_;
    x = x_;
    (look(rest), ...);
  }
  template <class... Rest>
  void operator()(ModelEvents& events, AccumulationWatch<double>&, std::vector<double>& guards, Rest&...) {
    events.guards(*system_, t_, x_, guards);
  }
  template <class... Parts>
  void operator()(Parts&...) {}
  template <class Value>
  void optional(Value&) {}
  void index(std::size_t, std::size_t) {}

 private:
  template <class Part>
  void look(Part& part) {
    if constexpr (std::is_same_v<Part, Logic>) part.transfer(*this);
  }

  double t_;
  const X& x_;
  ModelSystem* system_ = nullptr;
};

}  // namespace

SeenRun::SeenRun(std::unique_ptr<Steps<ModelSystem, X>> steps, X x0, Interval<double> interval, Options<X> options,
                 ModelEvents events)
    : Base(std::move(steps), nullptr, std::move(x0), interval, std::move(options), std::move(events)) {}

void SeenRun::pass(SeenRuns& seen, std::size_t run) {
  struct Forward {
    SeenRuns& seen;
    std::size_t run;
    void on_segment(Base& driver, double, double to) {
      if (seen.wants(run, to)) seen.on_piece(run, to, [&driver](double t, X& x) { driver.at(t, x); });
    }
    void on_event(Base& driver, const EventOccurrence<X>& now) { seen.on_event(run, driver.events(), now); }
  } forward{seen, run};
  while (advance(forward)) {
  }
  look();
}

void SeenRun::look() {
  Look found;
  transfer(found, [](auto&, auto&) {});
  is_at_zero_ = false;  // where there is no guard, nothing has been given a side
  constants_ = found.take_constants();
  next_scheduled_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < events().size(); ++i) {
    if (events().is_guard(i)) {
      is_at_zero_ = found.is_at_zero();
    } else {
      next_scheduled_ = std::min(next_scheduled_, events().next_time(i, t(), false));
    }
  }
}

void SeenRun::move_on(double t, X x) {
  for (const Constant& one : constants_) x[one.component] = one.value;
  MovedOn there(t, x);
  transfer(there, [](auto&, auto&) {});
}

}  // namespace continuo::model
